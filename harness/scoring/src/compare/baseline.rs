//! The scores of a run in one small file: what a later run is compared with.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use formats::atomic;
use formats::content_hash::hash_parts;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::CompareError;
use crate::run::RunFile;
use crate::score::Scores;

const FORMAT: u32 = 1;

fn one() -> u64 {
    1
}

/// Every score of a run under `<case>/<solver>/<row id>`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// Version of the file format.
    pub format: u32,
    /// Name of the suite.
    pub suite: String,
    /// Hash of the suite's text; none in files of earlier versions.
    #[serde(default)]
    pub suite_hash: Option<String>,
    /// Versions that made the run.
    pub versions: BTreeMap<String, Value>,
    /// Face, light and hash of the capture, by case.
    #[serde(default)]
    pub cases: BTreeMap<String, Captured>,
    /// Devices that the solver computed on.
    #[serde(default)]
    pub devices: BTreeSet<String>,
    /// The number of runs that the values are means of.
    #[serde(default = "one")]
    pub runs: u64,
    /// The scores.
    pub rows: BTreeMap<String, Entry>,
}

/// A case of the run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Captured {
    /// Name of the face.
    pub face: String,
    /// Name of the light of the capture.
    pub light: String,
    /// Hash of the capture; none where the values are means over captures.
    pub capture: Option<String>,
}

/// One score.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The value; none where the metric is not defined.
    pub value: Option<f64>,
    /// 95 % confidence interval.
    pub ci95: Option<[f64; 2]>,
    /// Pixels or texels.
    pub n: u64,
}

/// Everything of a baseline but its rows.
#[derive(Serialize)]
struct Head<'a> {
    format: u32,
    suite: &'a str,
    suite_hash: Option<&'a str>,
    versions: &'a BTreeMap<String, Value>,
    cases: &'a BTreeMap<String, Captured>,
    devices: &'a BTreeSet<String>,
    runs: u64,
}

/// The part of a maps folder's `solve.json` that says what computed.
#[derive(Deserialize)]
struct Solve {
    backend: Option<String>,
}

impl Baseline {
    /// A baseline without scores yet.
    pub fn new(suite: &str) -> Self {
        Self {
            format: FORMAT,
            suite: suite.to_owned(),
            suite_hash: None,
            versions: BTreeMap::new(),
            cases: BTreeMap::new(),
            devices: BTreeSet::new(),
            runs: 1,
            rows: BTreeMap::new(),
        }
    }

    /// Collects the scores of a finished run folder.
    pub fn of_run(run: &Path) -> Result<Self, CompareError> {
        let RunFile { suite, versions, suite_toml, cases, .. } = RunFile::open(run)?;
        let suite_hash = suite_toml.map(|text| hash_parts(&["suite", &text]));
        let mut baseline = Self { suite_hash, versions, ..Self::new(&suite) };
        for case in &cases {
            for method in &case.methods {
                let Some(scores) = &method.scores else { continue };
                let scores = Scores::of_run(run, scores)?;
                let Scores { face, light, .. } = scores.clone();
                let captured =
                    Captured { face, light, capture: Some(scores.inputs.capture.clone()) };
                baseline.cases.insert(case.id.clone(), captured);
                // Methods that leave no such file say nothing of what they computed on.
                let solve = method.maps.as_ref().map(|maps| run.join(maps).join("solve.json"));
                if let Some(solve) = solve.filter(|solve| solve.is_file()) {
                    baseline.devices.extend(parse::<Solve>(&solve)?.backend);
                }
                baseline.add(&format!("{}/{}", case.id, method.id), &scores);
            }
        }
        baseline.checked(&run.join("run.json"))
    }

    /// The means of runs that differ in their seeds alone, of the rows that have a value in each.
    ///
    /// Intervals are those of the first: they say what the choice of pixels does, not what seeds do.
    pub fn mean(runs: &[Self]) -> Option<Self> {
        let mut mean = runs.first()?.clone();
        let mut captures = Self::captures_in_all(runs);
        mean.cases.iter_mut().for_each(|(id, case)| case.capture = captures.remove(id));
        mean.runs = runs.len() as u64;
        for (id, entry) in &mut mean.rows {
            let values: Option<Vec<f64>> = runs.iter().map(|run| run.rows.get(id)?.value).collect();
            entry.value = values.map(|values| values.iter().sum::<f64>() / values.len() as f64);
        }
        Some(mean)
    }

    /// Hash of the capture, of the cases that have the same in every run.
    pub(super) fn captures_in_all(runs: &[Self]) -> BTreeMap<String, String> {
        let hash = |run: &Self, id: &str| run.cases.get(id)?.capture.clone();
        let first = runs.first().into_iter().flat_map(|run| run.cases.keys());
        first
            .filter_map(|id| Some((id.clone(), hash(&runs[0], id)?)))
            .filter(|(id, kept)| runs.iter().all(|run| hash(run, id).as_ref() == Some(kept)))
            .collect()
    }

    /// Adds the rows of one solver on one case, under `prefix`.
    pub fn add(&mut self, prefix: &str, scores: &Scores) {
        for row in &scores.rows {
            let entry = Entry { value: row.value, ci95: row.ci95, n: row.n };
            self.rows.insert(format!("{prefix}/{}", row.id()), entry);
        }
    }

    /// Reads a baseline file.
    pub fn read(path: &Path) -> Result<Self, CompareError> {
        let bytes = fs::read(path).map_err(|error| CompareError::io(path, error))?;
        Self::from_bytes(path, &bytes)
    }

    /// Reads a baseline file in memory; `path` is for messages.
    pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<Self, CompareError> {
        let baseline: Self = parsed(path, bytes)?;
        if baseline.format != FORMAT {
            let reason = format!("has format {}, this version reads {FORMAT}", baseline.format);
            return Err(CompareError::text(path, reason));
        }
        baseline.checked(path)
    }

    /// Writes a baseline file, one score per line, so that a change of it reads well as a diff.
    pub fn write(&self, path: &Path) -> Result<(), CompareError> {
        let text = self.to_json().map_err(|error| CompareError::text(path, error))?;
        atomic::write_file(path, text.as_bytes()).map_err(|error| CompareError::io(path, error))
    }

    fn to_json(&self) -> serde_json::Result<String> {
        let rows: Vec<String> = self
            .rows
            .iter()
            .map(|(id, entry)| {
                Ok(format!("  {}: {}", Value::from(id.as_str()), serde_json::to_string(entry)?))
            })
            .collect::<serde_json::Result<_>>()?;
        let head = Head {
            format: self.format,
            suite: &self.suite,
            suite_hash: self.suite_hash.as_deref(),
            versions: &self.versions,
            cases: &self.cases,
            devices: &self.devices,
            runs: self.runs,
        };
        let head = serde_json::to_value(head)?;
        let head: Vec<String> = head
            .as_object()
            .into_iter()
            .flatten()
            .map(|(key, value)| format!(" {key:?}: {value}"))
            .collect();
        Ok(format!("{{\n{},\n \"rows\": {{\n{}\n }}\n}}\n", head.join(",\n"), rows.join(",\n")))
    }

    fn checked(self, path: &Path) -> Result<Self, CompareError> {
        if self.rows.is_empty() { Err(CompareError::Empty(path.to_path_buf())) } else { Ok(self) }
    }
}

fn parse<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, CompareError> {
    parsed(path, &fs::read(path).map_err(|error| CompareError::io(path, error))?)
}

fn parsed<T: serde::de::DeserializeOwned>(path: &Path, bytes: &[u8]) -> Result<T, CompareError> {
    serde_json::from_slice(bytes).map_err(|error| CompareError::text(path, error))
}
