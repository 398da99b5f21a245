//! The scores of a run in one small file: what a later run is compared with.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use formats::atomic;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::CompareError;
use crate::score::Scores;

const FORMAT: u32 = 1;

/// Every score of a run under `<case>/<solver>/<row id>`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// Version of the file format.
    pub format: u32,
    /// Name of the suite.
    pub suite: String,
    /// Versions that made the run.
    pub versions: BTreeMap<String, Value>,
    /// The scores.
    pub rows: BTreeMap<String, Entry>,
}

/// One score.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// None where the metric is not defined.
    pub value: Option<f64>,
    /// 95 % confidence interval.
    pub ci95: Option<[f64; 2]>,
    /// Pixels or texels.
    pub n: u64,
}

/// The part of `run.json` that says where the scores are.
#[derive(Deserialize)]
struct Run {
    suite: String,
    #[serde(default)]
    versions: BTreeMap<String, Value>,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    id: String,
    #[serde(rename = "solvers")]
    methods: Vec<Method>,
}

#[derive(Deserialize)]
struct Method {
    id: String,
    /// None of a method that failed.
    scores: Option<String>,
}

impl Baseline {
    /// A baseline without scores yet.
    pub fn new(suite: &str) -> Self {
        Self {
            format: FORMAT,
            suite: suite.to_owned(),
            versions: BTreeMap::new(),
            rows: BTreeMap::new(),
        }
    }

    /// Collects the scores of a finished run folder.
    pub fn of_run(run: &Path) -> Result<Self, CompareError> {
        let path = run.join("run.json");
        let Run { suite, versions, cases } = parse(&path)?;
        let mut baseline = Self { versions, ..Self::new(&suite) };
        for case in &cases {
            for method in &case.methods {
                let Some(scores) = &method.scores else { continue };
                let scores = Scores::read(&run.join(scores))?;
                baseline.add(&format!("{}/{}", case.id, method.id), &scores);
            }
        }
        baseline.checked(&path)
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
        let suite = Value::from(self.suite.as_str());
        let versions = serde_json::to_string(&self.versions)?;
        let (format, rows) = (self.format, rows.join(",\n"));
        Ok(format!(
            "{{\n \"format\": {format},\n \"suite\": {suite},\n \"versions\": {versions},\n \"rows\": {{\n{rows}\n }}\n}}\n"
        ))
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
