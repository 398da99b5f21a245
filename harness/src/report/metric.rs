//! The words of the table: what the ids of a row mean.

use crate::metrics::{Metric, Quantity};

/// What is compared, in the order of the table.
pub(super) const SUBJECTS: [(&str, &str); 10] = [
    ("diffuse_albedo", "Diffuse albedo map"),
    ("specular_albedo", "Specular albedo map"),
    ("specular_normal", "Specular normal map"),
    ("diffuse_normal", "Diffuse normal map"),
    ("view", "Withheld view, by the method itself"),
    ("view_diffuse_layer", "Withheld view, diffuse layer, by the method itself"),
    ("view_specular_layer", "Withheld view, specular layer, by the method itself"),
    ("relit", "Withheld view, maps relit"),
    ("relit_diffuse_layer", "Withheld view, diffuse layer, maps relit"),
    ("relit_specular_layer", "Withheld view, specular layer, maps relit"),
];

/// Metrics that only the full list shows: variants of one that the table has.
const VARIANTS: [&str; 7] = [
    "psnr_lin",
    "relmse",
    "flip_p95",
    "spearman",
    "normal_below_5",
    "normal_below_22_5",
    "normal_below_30",
];

/// Whether the table of a case shows a metric in a scale mode, or only the full list does.
pub(super) fn is_chosen(metric: &str, scale: &str) -> bool {
    !VARIANTS.contains(&metric) && matches!(scale, "none" | "global")
}

/// The values that are compared.
pub(super) fn space(metric: &Metric) -> &'static str {
    match metric.quantity {
        Quantity::SquaredErrorSrgb => "sRGB clipped to [0, 1]",
        Quantity::Ssim | Quantity::Flip => "sRGB clipped to [0, 1], black outside",
        Quantity::ColourDifference | Quantity::Typology => "L*a*b*, D65",
        Quantity::Angle => "object space",
        Quantity::HighPass
        | Quantity::WithinLabel
        | Quantity::LowPassError
        | Quantity::LogErrorAndCause => "log luminance",
        Quantity::Luminance | Quantity::ErrorAndCause => "linear luminance",
        _ => "linear",
    }
}

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
        "median" => "after the median ratio per channel",
        other => other,
    }
}
