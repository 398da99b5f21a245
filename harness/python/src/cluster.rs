//! Single stages of a suite, for the workers of a cluster.

use std::collections::BTreeMap;
use std::path::PathBuf;

use harness::suite::{self, Suite, Wanted};
use pyo3::prelude::*;

use super::errors::{named_error, raise};
use super::stages::watched;

/// Raises where this machine has another version, or another suite, than what sends the work; returns the
/// renderer's fingerprint.
#[pyfunction]
pub(super) fn check_worker(
    py: Python<'_>,
    suite: PathBuf,
    content: String,
    versions: String,
) -> PyResult<String> {
    watched(py, None, |tools, _| {
        suite::check_worker(&Suite::open(&suite)?, &content, &versions, tools)
    })
}

/// Does a stage of a suite in a folder that holds what it reads (hashes by ids); JSON text of what became
/// of it, on `processors` or on all. With `key_only`, only what it is made from. `renderer` is what `check_worker` returned.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(super) fn run_part(
    py: Python<'_>,
    suite: PathBuf,
    out: PathBuf,
    stage: String,
    contents: BTreeMap<String, String>,
    renderer: String,
    key_only: bool,
    processors: Option<Vec<usize>>,
) -> PyResult<String> {
    let done = watched(py, None, |tools, _| {
        let wanted = Wanted {
            id: &stage,
            contents: &contents,
            renderer: &renderer,
            processors: &processors,
        };
        suite::run_part(&Suite::open(&suite)?, &out, wanted, key_only, tools, &mut |_, _, _| {})
    })?;
    serde_json::to_string(&done).map_err(|error| named_error("UnshadeError", &error.to_string()))
}

/// Takes the output of a stage, which lies in the run's folder, for finished.
#[pyfunction]
pub(super) fn adopt(run: PathBuf, key: &str, stage: &str, content: &str) -> PyResult<()> {
    suite::adopt(&run, key, stage, content).map_err(raise)
}
