//! The words of the table: what a row's ids mean.

/// What is compared, in the order of the table.
pub(super) const SUBJECTS: [(&str, &str); 10] = [
    ("diffuse_albedo", "Diffuse albedo map"),
    ("specular_albedo", "Specular albedo map"),
    ("specular_normal", "Specular normal map"),
    ("diffuse_normal", "Diffuse normal map"),
    ("view", "Withheld view, by the method itself"),
    ("view_diffuse_layer", "Withheld view, diffuse layer"),
    ("view_specular_layer", "Withheld view, specular layer"),
    ("relit", "Withheld view, maps relit"),
    ("relit_diffuse_layer", "Relit, diffuse layer"),
    ("relit_specular_layer", "Relit, specular layer"),
];

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Direction { Higher, Lower, Zero }
impl Direction { pub fn name(self) -> &'static str { match self { Direction::Higher => "↑", Direction::Lower => "↓", Direction::Zero => "→0" } } }

pub(super) struct Info { pub id: &'static str, pub name: &'static str, pub unit: &'static str, pub direction: Direction, pub space: &'static str, pub definition: &'static str }

pub(super) const ALL: &[Info] = &[
  Info { id: "psnr_srgb", name: "PSNR", unit: "dB", direction: Direction::Higher, space: "sRGB, clipped to [0,1]", definition: "peak 1, mean over mask pixels x 3" },
  Info { id: "psnr_lin", name: "PSNR, linear", unit: "dB", direction: Direction::Higher, space: "linear", definition: "peak 1, mean over mask pixels x 3" },
  Info { id: "ssim", name: "SSIM", unit: "", direction: Direction::Higher, space: "sRGB", definition: "Wang" },
  Info { id: "normal_mean_deg", name: "Mean angle", unit: "°", direction: Direction::Lower, space: "object space", definition: "mean angle" },
  Info { id: "rmse", name: "RMSE", unit: "", direction: Direction::Lower, space: "linear", definition: "rmse" },
];
pub(super) fn info(id: &str) -> &'static Info { ALL.iter().find(|i| i.id == id).unwrap_or(&ALL[0]) }
pub(super) fn is_chosen(_subject: &str, _metric: &str) -> bool { true }

/// A subject's name.
pub(super) fn subject(id: &str) -> &str {
    SUBJECTS.iter().find(|(subject, _)| *subject == id).map_or(id, |(_, name)| name)
}

/// A region in words.
pub(super) fn region(id: &str, label: Option<&str>) -> String {
    let words = match id {
        "coverage-e5" => "seen texels, eroded 5×5",
        "mask-e5" => "face mask, eroded 5×5",
        other => other,
    };
    label.map_or(words.to_owned(), |label| format!("{words}, {label}"))
}

/// A scale mode in words.
pub(super) fn scale(id: &str) -> &str {
    match id {
        "none" => "as is",
        "global" => "after one factor",
        "channel" => "after one factor per channel",
        "median" => "after the median factor",
        other => other,
    }
}
