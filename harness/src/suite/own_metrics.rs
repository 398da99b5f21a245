//! Metrics that users write in Python, called by a child process.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use scoring::metrics::OwnMetric;
use scoring::score::{self, Scores, Shown};
use serde::Deserialize;

use super::error::RunError;
use crate::synth::Request;
use crate::synth::Tools;

/// Functions as a suite names them: `module:function`, `file.py` or `file.py:function`.
#[derive(Clone, Debug, Default)]
pub struct OwnMetrics {
    names: Vec<String>,
    /// Where modules and files are looked for.
    folder: PathBuf,
    found: Arc<OnceLock<Found>>,
}

/// Statements of the functions about themselves.
#[derive(Clone, Debug, Default, Deserialize)]
struct Found {
    metrics: Vec<OwnMetric>,
    /// Changes with their sources.
    key: String,
}

impl OwnMetrics {
    /// The functions `names`, relative to a folder.
    pub fn new(names: Vec<String>, folder: PathBuf) -> Self {
        Self { names, folder, found: Arc::default() }
    }

    /// Whether there is any.
    pub fn is_any(&self) -> bool {
        !self.names.is_empty()
    }

    /// Changes with the sources of the functions; none without functions.
    pub(super) fn key(&self, tools: &Tools) -> Result<Option<&str>, RunError> {
        Ok(if self.is_any() { Some(&self.find(tools)?.key) } else { None })
    }

    /// Adds the rows of the functions to scores, and what they state of themselves.
    pub fn add_rows(
        &self,
        scores: &mut Scores,
        [capture, maps]: [&Path; 2],
        relit: Option<&Path>,
        tools: &Tools,
    ) -> Result<(), RunError> {
        if !self.is_any() {
            return Ok(());
        }
        let metrics = self.find(tools)?.metrics.clone();
        let mut shown =
            score::shown_maps(capture, maps, scores.scale.as_ref().map(|scale| scale.global));
        shown.extend(score::shown(capture, maps, relit)?);
        #[derive(Deserialize)]
        struct Answer {
            values: Vec<Vec<Option<f64>>>,
        }
        let Answer { values } = self.ask(&shown, tools)?;
        for (metric, values) in metrics.into_iter().zip(values) {
            let wanted = |shown: &&Shown| metric.of.contains(&shown.subject);
            let shown: Vec<Shown> = shown.iter().filter(wanted).cloned().collect();
            scores.rows.extend(score::judged_rows(capture, &shown, &metric.id, &values)?);
            scores.metrics.push(metric);
        }
        Ok(())
    }

    fn find(&self, tools: &Tools) -> Result<&Found, RunError> {
        if let Some(found) = self.found.get() {
            return Ok(found);
        }
        let found: Found = self.ask(&[], tools)?;
        for metric in &found.metrics {
            metric.register().map_err(|error| RunError::Submission(error.to_string()))?;
        }
        Ok(self.found.get_or_init(|| found))
    }

    fn ask<T: for<'de> Deserialize<'de>>(
        &self,
        pairs: &[Shown],
        tools: &Tools,
    ) -> Result<T, RunError> {
        let folder = &std::path::absolute(&self.folder)?;
        let answer = tools.ask(&Request::Metrics { names: &self.names, folder, pairs })?;
        Ok(serde_json::from_value(answer).map_err(io::Error::other)?)
    }
}
