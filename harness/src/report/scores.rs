//! `scores.json` as far as the report shows it.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::metrics::Scale;

/// The scores of one method in one case.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Scores {
    pub protocol: Protocol,
    pub inputs: Inputs,
    pub scale: Option<Scale>,
    pub regions: Vec<RegionSize>,
    pub rows: Vec<Row>,
}

/// How the numbers were made.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Protocol {
    pub id: String,
    pub statements: Vec<String>,
}

/// BLAKE3 of the folders that were scored.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Inputs {
    pub capture: String,
    pub maps: String,
    pub relit: Option<String>,
}

/// How much a region holds.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct RegionSize {
    pub region: String,
    pub pixels: usize,
    /// Of the mask before the erosion.
    pub share: f64,
    /// Share for which the method says that it had data.
    pub solved: Option<f64>,
}

/// One score.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Row {
    pub subject: String,
    pub metric: String,
    pub scale: String,
    pub region: String,
    pub label: Option<String>,
    pub light: Option<String>,
    /// `None` where the metric is not defined.
    pub value: Option<f64>,
    pub ci95: Option<[f64; 2]>,
    /// The value that rendering noise alone would allow.
    pub floor: Option<f64>,
    #[serde(default)]
    pub per_frame: BTreeMap<String, f64>,
}

impl Row {
    /// `<subject>[/light]/<metric>@<region>[.label]:<scale>`.
    pub fn id(&self) -> String {
        let light = self.light.as_ref().map_or(String::new(), |light| format!("/{light}"));
        let label = self.label.as_ref().map_or(String::new(), |label| format!(".{label}"));
        let Self { subject, metric, region, scale, .. } = self;
        format!("{subject}{light}/{metric}@{region}{label}:{scale}")
    }
}
