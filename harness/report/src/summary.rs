//! The key figures: the few numbers of each case that decide.

use serde::Serialize;

use super::run::Case;
use super::table::{self, Column};
use super::{comparison_figures, metric};

/// The figures that decide, of one case.
#[derive(Serialize)]
pub(super) struct SummaryCase {
    pub id: String,
    anchor: String,
    pub rows: Vec<SummaryRow>,
}

#[derive(Serialize)]
pub(super) struct SummaryRow {
    pub title: String,
    kind: &'static str,
    /// Likely faults of the maps, in words.
    findings: Vec<String>,
    pub cells: Vec<String>,
}

/// One entry of the key figures: heading, subject, metric, scale, and whether the light is
/// absent, the capture's own or any other.
struct KeyFigure {
    subject: &'static str,
    metric: &'static str,
    scale: &'static str,
    light: KeyLight,
}

#[derive(Clone, Copy, PartialEq)]
enum KeyLight {
    None,
    Own,
    Other,
}

/// Headings of the key figures in files.
pub(super) const KEY_FIGURE_NAMES: [&str; 5] = [
    "diffuse albedo, PSNR of sRGB after one factor, dB",
    "specular normal, mean angle / plain mesh, °",
    "withheld view, PSNR of sRGB, dB",
    "relit, capture's light, PSNR of sRGB, dB",
    "relit, other lights, PSNR of sRGB, dB",
];

const KEY_FIGURES: [KeyFigure; 5] = [
    KeyFigure {
        subject: "diffuse_albedo",
        metric: "psnr_srgb",
        scale: "global",
        light: KeyLight::None,
    },
    KeyFigure {
        subject: "specular_normal",
        metric: "normal_mean_deg",
        scale: "none",
        light: KeyLight::None,
    },
    KeyFigure { subject: "view", metric: "psnr_srgb", scale: "none", light: KeyLight::None },
    KeyFigure { subject: "relit", metric: "psnr_srgb", scale: "global", light: KeyLight::Own },
    KeyFigure { subject: "relit", metric: "psnr_srgb", scale: "global", light: KeyLight::Other },
];

/// The key figures of one case.
pub(super) fn summary(case: &Case, columns: &[Column]) -> SummaryCase {
    let rows = columns.iter().map(|column| SummaryRow {
        title: column.method.title().to_owned(),
        kind: column.method.role(),
        findings: column.findings(),
        cells: match column.method.failed {
            Some(_) => vec![table::FAILED.to_owned(); KEY_FIGURES.len()],
            None => KEY_FIGURES.iter().map(|key| key_figure(key, column, &case.light)).collect(),
        },
    });
    SummaryCase {
        id: case.id.clone(),
        anchor: comparison_figures::file_name(&case.id),
        rows: rows.collect(),
    }
}

/// One value (for normals beside that of the plain mesh), or the range over the other lights.
fn key_figure(key: &KeyFigure, column: &Column, own: &str) -> String {
    let lights: Vec<Option<&str>> = match key.light {
        KeyLight::None => vec![None],
        KeyLight::Own => vec![Some(own)],
        KeyLight::Other => {
            let mut lights: Vec<Option<&str>> =
                column.rows().iter().map(|row| row.light.as_deref()).collect();
            lights.sort();
            lights.dedup();
            lights.retain(|light| light.is_some_and(|light| light != own));
            lights
        }
    };
    let find = |subject: &str, light: Option<&str>, scale: &str| {
        column.find(subject, light, key.metric, scale)?.value
    };
    // What is held against photographs has no factor.
    let value = |subject: &str, light| {
        find(subject, light, key.scale)
            .or_else(|| find(subject, light, "none").filter(|_| column.factor().is_none()))
    };
    let values: Vec<f64> =
        lights.into_iter().filter_map(|light| value(key.subject, light)).collect();
    let trivial = metric::trivial(key.subject).and_then(|trivial| value(trivial, None));
    let low = values.iter().copied().min_by(f64::total_cmp);
    let high = values.iter().copied().max_by(f64::total_cmp);
    match (low, high) {
        (Some(low), Some(high)) if low < high => format!("{low:.1} … {high:.1}"),
        (value, _) if trivial.is_some() => {
            format!("{} / {}", table::shown(value, 2), table::shown(trivial, 2))
        }
        (value, _) => table::shown(value, 1),
    }
}

#[cfg(test)]
mod tests {
    use scoring::metrics::Metric;

    use super::*;

    #[test]
    fn every_key_figure_is_a_metric_of_a_subject() {
        for key in KEY_FIGURES {
            assert!(Metric::find(key.metric).is_ok(), "{}", key.metric);
            assert_ne!(metric::subject(key.subject), key.subject);
        }
    }
}
