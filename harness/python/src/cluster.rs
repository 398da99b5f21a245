//! Single stages of a suite, for the workers of a cluster.

use std::collections::BTreeMap;
use std::path::PathBuf;

use harness::suite::{self, RemoteStage, Suite};
use harness::synth::Fingerprints;
use pyo3::prelude::*;

use super::commands::watched;
use super::errors::{named_error, raise};

/// Raises where this machine has another version, or another suite, than what sends the work; returns the
/// renderer's versions and code, by its stages.
#[pyfunction]
pub(super) fn check_worker(
    py: Python<'_>,
    suite: PathBuf,
    content: String,
    versions: String,
) -> PyResult<BTreeMap<String, String>> {
    watched(py, None, |tools, _| {
        suite::check_worker(&Suite::open(&suite)?, &content, &versions, tools)
    })
    .map(|renderer| renderer.0)
}

/// Does a stage of a suite in a folder that holds what it reads (JSON text of records by ids); JSON text of what became
/// of it, on `processors` or on all. With `key_only`, only what it is made from. `renderer` is what `check_worker` returned.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(super) fn run_remote_stage(
    py: Python<'_>,
    suite: PathBuf,
    out: PathBuf,
    stage: String,
    contents: &str,
    renderer: BTreeMap<String, String>,
    key_only: bool,
    processors: Option<Vec<usize>>,
) -> PyResult<String> {
    let contents = serde_json::from_str(contents).map_err(unread)?;
    let renderer = Fingerprints(renderer);
    let done = watched(py, None, |tools, _| {
        let stage = RemoteStage {
            id: &stage,
            contents: &contents,
            renderer: &renderer,
            processors: &processors,
        };
        let step = &mut |_, _, _: &str| {};
        suite::run_remote_stage(&Suite::open(&suite)?, &out, stage, key_only, tools, step)
    })?;
    serde_json::to_string(&done).map_err(unread)
}

/// Takes the output of a stage, which lies in the run's folder, for finished; `record` is JSON text of its hashes.
#[pyfunction]
pub(super) fn adopt(run: PathBuf, key: &str, stage: &str, record: &str) -> PyResult<()> {
    let output = serde_json::from_str(record).map_err(unread)?;
    suite::adopt(&run, key, stage, &output).map_err(raise)
}

fn unread(error: serde_json::Error) -> PyErr {
    named_error("UnshadeError", &error.to_string())
}
