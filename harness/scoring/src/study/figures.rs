//! Figures of a study: scores of one kind, over the lights that a face was relit in.

use std::collections::BTreeSet;

use serde::Serialize;

use super::Observation;
use super::faces::{Cell, Face};
use crate::metrics::{Direction, Metric};

/// A kind of score, of one variant of the scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Figure {
    /// Name of the scene's variant; none of a suite without variants.
    pub variant: Option<String>,
    /// Subject of the scores.
    pub subject: String,
    /// `own` or `others`, of pictures that maps were relit to.
    pub relit_in: Option<&'static str>,
    /// Id of the metric.
    pub metric: String,
    /// The region of the comparison.
    pub region: String,
    /// Part of the face; none for all of it.
    pub label: Option<String>,
    /// The scaling of the prediction.
    pub scale: String,
}

/// Figures that decide: subject, lights, metric, scale, as a study shows and compares them.
const KEY: [(&str, Option<&str>, &str, &str); 14] = [
    ("diffuse_albedo", None, "psnr_srgb", "global"),
    ("diffuse_albedo", None, "chromaticity_deg", "none"),
    ("diffuse_albedo", None, "ita_error", "none"),
    ("diffuse_albedo", None, "hc", "none"),
    ("diffuse_albedo", None, "wcorr", "none"),
    ("relit", Some("own"), "psnr_srgb", "global"),
    ("relit", Some("others"), "psnr_srgb", "global"),
    ("relit", Some("others"), "psnr_lin_unbiased", "global"),
    ("specular_normal", None, "normal_mean_deg", "none"),
    ("diffuse_normal", None, "normal_mean_deg", "none"),
    ("specular_albedo", None, "rmse", "none"),
    ("roughness", None, "log_ratio_rms", "none"),
    ("light_peaks", None, "direction_mean_deg", "none"),
    ("light", None, "log_rmse", "global"),
];

/// The figures that decide of photographs, which have no others.
const OF_PHOTOGRAPHS: [(&str, Option<&str>, &str, &str); 2] =
    [("view", None, "psnr_srgb", "none"), ("relit", Some("own"), "psnr_srgb", "none")];

impl Figure {
    /// The figure of a score.
    pub(super) fn of(observation: &Observation) -> Self {
        let row = &observation.row;
        let own = row.light.as_ref().map(|light| *light == observation.light);
        Self {
            variant: observation.variant.clone(),
            subject: row.subject.clone(),
            relit_in: own.map(|own| if own { "own" } else { "others" }),
            metric: row.metric.clone(),
            region: row.region.clone(),
            label: row.label.clone(),
            scale: row.scale.clone(),
        }
    }

    /// The index among the figures that decide.
    pub(super) fn key(&self) -> Option<usize> {
        // The typology angle is that of skin, as the FAIR benchmark has it.
        let label = (self.metric == "ita_error").then_some("skin");
        if self.label.as_deref() != label || self.region.contains("views2") {
            return None;
        }
        self.place_in(&KEY)
    }

    /// The index among the figures that decide where there are photographs alone.
    pub(super) fn key_of_photographs(&self) -> Option<usize> {
        self.place_in(&OF_PHOTOGRAPHS).filter(|_| self.label.is_none())
    }

    fn place_in(&self, keys: &[(&str, Option<&str>, &str, &str)]) -> Option<usize> {
        keys.iter().position(|(subject, relit_in, metric, scale)| {
            (*subject, *relit_in, *metric, *scale)
                == (&*self.subject, self.relit_in, &*self.metric, &*self.scale)
        })
    }

    /// As row ids have it: `relit/others/psnr_srgb@mask-e5:global`.
    pub fn id(&self) -> String {
        let light = self.relit_in.map_or(String::new(), |lights| format!("/{lights}"));
        let label = self.label.as_ref().map_or(String::new(), |label| format!(".{label}"));
        let Self { subject, metric, region, scale, .. } = self;
        format!("{subject}{light}/{metric}@{region}{label}:{scale}")
    }

    /// The metric, if it is one of this version.
    pub(super) fn metric(&self) -> Option<&'static Metric> {
        Metric::find(&self.metric).ok()
    }

    /// The direction in which values improve.
    pub(super) fn direction(&self) -> Direction {
        self.metric().map_or(Direction::Lower, |metric| metric.direction)
    }
}

/// Key of a cell below a method: face, light of the capture, light that it is relit in,
/// seeds. Two methods are compared where both have it.
pub(super) type Place = (String, String, Option<String>, Option<u64>);

/// The place of a score.
pub(super) fn place(observation: &Observation) -> Place {
    let Observation { face, light, seed, row, .. } = observation;
    (face.clone(), light.clone(), row.light.clone(), *seed)
}

/// The faces of scores of one figure and method, at the places of `at` alone if given; those of no
/// value aside. Seeds of a method are cells, as lights are.
pub(super) fn faces(scores: &[&Observation], at: Option<&BTreeSet<Place>>) -> Vec<Face> {
    let mut faces: Vec<Face> = Vec::new();
    for score in scores {
        let Some(value) = score.row.value else { continue };
        if at.is_some_and(|at| !at.contains(&place(score))) {
            continue;
        }
        let cell = Cell { value, views: score.row.per_frame.values().copied().collect() };
        match faces.iter_mut().find(|face| face.name == score.face) {
            Some(face) => face.cells.push(cell),
            None => faces.push(Face { name: score.face.clone(), cells: vec![cell] }),
        }
    }
    faces.sort_by(|a, b| a.name.cmp(&b.name));
    faces
}
