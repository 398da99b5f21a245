//! The figures of the leaderboard, and the rows of scores that they are made of.

use scoring::score::FOUND_LIGHT;
use serde::Deserialize;

/// Which light a figure is of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum In {
    /// None: of a map, or of a view that the method made itself.
    No,
    /// The light of the capture.
    Own,
    /// The mean over all the others.
    Others,
}

/// A column of the leaderboard.
#[derive(Debug)]
pub(super) struct Figure {
    pub name: &'static str,
    pub unit: &'static str,
    /// Whether larger values are better.
    pub higher: bool,
    pub decimals: usize,
    subject: &'static str,
    metric: &'static str,
    scale: &'static str,
    relit: In,
}

const PLAIN: Figure = Figure {
    name: "albedo",
    unit: "dB",
    higher: true,
    decimals: 2,
    subject: "diffuse_albedo",
    metric: "psnr_srgb",
    scale: "global",
    relit: In::No,
};

/// In the order of the page.
pub(super) const FIGURES: [Figure; 8] = [
    Figure { name: "relit, other lights", subject: "relit", relit: In::Others, ..PLAIN },
    Figure { name: "relit, own light", subject: "relit", relit: In::Own, ..PLAIN },
    PLAIN,
    Figure { name: "albedo as is", scale: "none", ..PLAIN },
    normal("specular normal", "specular_normal"),
    normal("diffuse normal", "diffuse_normal"),
    Figure {
        name: "specular albedo",
        unit: "RMSE",
        higher: false,
        decimals: 5,
        subject: "specular_albedo",
        metric: "rmse",
        scale: "none",
        ..PLAIN
    },
    Figure { name: "own views", subject: "view", scale: "none", ..PLAIN },
];

const fn normal(name: &'static str, subject: &'static str) -> Figure {
    let metric = "normal_mean_deg";
    Figure { name, unit: "°", higher: false, decimals: 3, subject, metric, scale: "none", ..PLAIN }
}

/// Keys of a row of scores that say whose it is. The rest of it, most of a file, is not kept.
#[derive(Deserialize)]
pub(super) struct Row {
    subject: String,
    metric: String,
    scale: String,
    region: String,
    label: Option<String>,
    light: Option<String>,
    value: Option<f64>,
}

impl Figure {
    /// The figure of a capture in `light`; none where the scores do not have it.
    pub fn value(&self, rows: &[Row], light: &str) -> Option<f64> {
        // Scores against photographs have no factor.
        let scale = match light {
            FOUND_LIGHT if self.relit == In::Own => "none",
            _ => self.scale,
        };
        let wanted = |row: &&Row| {
            row.subject == self.subject
                && row.metric == self.metric
                && row.scale == scale
                && row.label.is_none()
                // The whole of a map or mask.
                && matches!(row.region.as_str(), "coverage-e5" | "mask-e5")
                && match self.relit {
                    In::No => true,
                    In::Own => row.light.as_deref() == Some(light),
                    In::Others => row.light.as_deref().is_some_and(|other| other != light),
                }
        };
        let values: Vec<f64> = rows.iter().filter(wanted).filter_map(|row| row.value).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        mean.is_finite().then_some(mean)
    }
}
