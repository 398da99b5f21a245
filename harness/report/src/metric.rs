//! The words of the table: what the ids of a row mean.

use scoring::metrics::ScaleMode;
use scoring::score::Row;

/// Subjects, with their words in the table, in its order.
pub(super) const SUBJECTS: [(&str, &str); 25] = [
    ("diffuse_albedo", "Diffuse albedo map"),
    ("confidence", "Confidence map, against the error of the diffuse albedo"),
    ("diffuse_albedo_std", "Diffuse albedo, stated deviations"),
    ("specular_albedo", "Specular albedo map"),
    ("specular_normal", "Specular normal map"),
    ("diffuse_normal", "Diffuse normal map"),
    ("roughness", "Roughness map"),
    ("light_peaks", "Light, its brightest directions"),
    ("light", "Light, over equal solid angles"),
    ("light_mirror_sphere", "Mirror sphere in the light"),
    ("light_glossy_sphere", "Glossy sphere in the light"),
    ("light_diffuse_sphere", "Diffuse sphere in the light"),
    ("usual_roughness", "Roughness, usual lobes"),
    ("constant_roughness", "Roughness, best constant"),
    ("constant_specular_albedo", "Specular albedo, best constant"),
    ("mesh_specular_normal", "Specular normal, plain mesh"),
    ("mesh_diffuse_normal", "Diffuse normal, plain mesh"),
    ("view", "Withheld view, by the method itself"),
    ("view_diffuse_layer", "Withheld view, diffuse layer, by the method itself"),
    ("view_specular_layer", "Withheld view, specular layer, by the method itself"),
    ("view_silhouette", "Withheld view, along its silhouette, by the method itself"),
    ("relit", "Withheld view, maps relit"),
    ("relit_diffuse_layer", "Withheld view, diffuse layer, maps relit"),
    ("relit_specular_layer", "Withheld view, specular layer, maps relit"),
    ("relit_silhouette", "Withheld view, along its silhouette, maps relit"),
];

/// Answers that need no pictures: their scores stand beside those of the map they answer for.
const TRIVIAL: [(&str, &str); 4] = [
    ("roughness", "usual_roughness"),
    ("specular_albedo", "constant_specular_albedo"),
    ("specular_normal", "mesh_specular_normal"),
    ("diffuse_normal", "mesh_diffuse_normal"),
];

/// The trivial answer for a map.
pub(super) fn trivial(subject: &str) -> Option<&'static str> {
    TRIVIAL.iter().find(|(map, _)| *map == subject).map(|(_, trivial)| *trivial)
}

/// Metrics that only the full list shows: variants of one that the table has.
const VARIANTS: [&str; 11] = [
    "orb_psnr_h",
    "orb_psnr_l",
    "orb_albedo_psnr",
    "psnr_lin_unbiased",
    "psnr_lin",
    "relmse",
    "flip_p95",
    "spearman",
    "normal_below_5",
    "normal_below_22_5",
    "normal_below_30",
];

/// Returns whether the table of a case has a line for a row, or only the full list has.
pub(super) fn is_chosen(row: &Row) -> bool {
    is_whole(row)
        && !VARIANTS.contains(&row.metric.as_str())
        && matches!(row.scale.as_str(), "none" | "global")
        && !TRIVIAL.iter().any(|(_, trivial)| *trivial == row.subject)
}

/// Returns whether a row covers its subject's whole region.
pub(super) fn is_whole(row: &Row) -> bool {
    row.label.is_none()
        && matches!(
            row.region.as_str(),
            "coverage-e5" | "mask-e5" | "mask-rim" | "whole" | "sphere"
        )
}

/// A subject's name.
pub(super) fn subject(id: &str) -> &str {
    SUBJECTS.iter().find(|(subject, _)| *subject == id).map_or(id, |(_, name)| name)
}

/// The subjects that scores may have.
pub fn subjects() -> impl Iterator<Item = &'static str> {
    SUBJECTS.into_iter().map(|(id, _)| id)
}

/// A region in words.
pub(super) fn region(id: &str, label: Option<&str>) -> String {
    if let Some(side) = id.strip_prefix("coverage-e5-").and_then(|id| id.strip_suffix("mm")) {
        return format!("seen texels, eroded 5×5, averaged over {side} mm");
    }
    let words = match id {
        "coverage-e5" => "seen texels, eroded 5×5",
        "coverage-e5-views2" => "texels seen by two views, eroded 5×5",
        "mask-e5" => "face mask, eroded 5×5",
        "mask-rim" => "face mask, what erosion takes away",
        "whole" => "all of it",
        "sphere" => "its disc",
        other => other,
    };
    label.map_or(words.to_owned(), |label| format!("{words}, {label}"))
}

/// A scale mode in words; one of another version of the scoring by its id.
pub(super) fn scale(id: &str) -> &str {
    ScaleMode::ALL.iter().find(|mode| mode.id() == id).map_or(id, |mode| mode.words())
}

#[cfg(test)]
mod tests {
    use scoring::metrics::Metric;

    use super::*;

    #[test]
    fn variants_are_metrics_and_trivial_answers_are_subjects() {
        for id in VARIANTS {
            assert!(Metric::find(id).is_ok(), "{id} is not a metric");
        }
        for (map, trivial) in TRIVIAL {
            assert!(subject(map) != map && subject(trivial) != trivial, "{map}, {trivial}");
        }
    }
}
