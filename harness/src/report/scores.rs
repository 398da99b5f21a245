//! The scores of one column.
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Scores {
    pub inputs: BTreeMap<String, Option<String>>,
    pub scale: Option<ScaleFit>,
    pub rows: Vec<Row>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct ScaleFit {
    pub global: Option<f64>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Row {
    pub subject: String,
    pub metric: String,
    pub scale: String,
    pub region: String,
    pub label: Option<String>,
    pub light: Option<String>,
    pub value: Option<f64>,
    pub ci95: Option<[f64; 2]>,
    pub n: u64,
    pub floor: Option<f64>,
    #[serde(default)]
    pub per_frame: Option<BTreeMap<String, f64>>,
}
