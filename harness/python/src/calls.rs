//! The stages as functions.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use capture::TruthPart;
use harness::cli;
use harness::suite::{self, SOLVER_SOURCES};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scoring::metrics::OwnMetric;
use scoring::score;
use solver::{Choice, Options};

use super::capture::Capture;
use super::commands::watched;
use super::errors::{named_error, raise};
use super::gpu_of_process;
use super::maps;
use super::threads::{End, detached, interruptible, long};

/// Runs the command line and returns its exit code.
#[pyfunction]
pub(super) fn run_command_line(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| cli::main(arguments))
}

/// Recovers maps from a capture: the maps by name, and where the solve was stopped.
///
/// `config` is the text of a configuration if `is_text`, else a preset's name or a file's path.
/// `progress(stage, iteration, total, loss)` may be given.
#[pyfunction]
#[pyo3(signature = (capture, config, is_text, out=None, progress=None, backend="auto", given=vec![]))]
#[allow(clippy::too_many_arguments)]
pub(super) fn solve<'py>(
    py: Python<'py>,
    capture: &Bound<'py, Capture>,
    config: &str,
    is_text: bool,
    out: Option<PathBuf>,
    progress: Option<&Bound<'py, PyAny>>,
    backend: &str,
    given: Vec<String>,
) -> PyResult<(Bound<'py, PyDict>, Option<String>)> {
    let mut config = if is_text {
        solver::Config::from_toml(config).map_err(raise)?
    } else {
        suite::solver_config(config).map_err(raise)?
    };
    if out.is_none() {
        // Nobody would see them.
        config = config.without_records();
    }
    let backend: Choice = backend.parse().map_err(raise)?;
    let given: Vec<TruthPart> = given
        .iter()
        .map(|part| part.parse())
        .collect::<Result<_, String>>()
        .map_err(|reason| named_error("SolveError", &reason))?;
    let capture = capture.get().inner.clone();
    let capture = py.detach(|| capture.with_truth(&given)).map_err(raise)?;
    let capture = &capture;
    let backend = py.detach(|| gpu_of_process::open(backend))?;
    let end = interruptible(py, progress, true, |interrupt, reporter| {
        let mut hear = |step: &solver::Progress| {
            let said = (step.stage.to_owned(), step.iteration, step.total, step.loss);
            match reporter.send(said) && !interrupt.load(Ordering::Relaxed) {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        };
        let backend = &*backend;
        match &out {
            Some(out) => {
                solver::solve_into(backend, out, SOLVER_SOURCES, capture, &config, &mut hear)
            }
            None => solver::solve_on(backend, capture, &config, Options::default(), &mut hear),
        }
    })?;
    match end {
        End::Done(solution) => {
            let solution = solution.map_err(raise)?;
            Ok((maps::to_dict(py, solution.maps)?, solution.record.interrupted))
        }
        End::Stopped => Err(raise(suite::RunError::Interrupted)),
    }
}

/// The scores of a maps folder as JSON text.
#[pyfunction]
#[pyo3(signature = (capture, maps, relit=None, lpips=None))]
pub(super) fn score_json(
    py: Python<'_>,
    capture: PathBuf,
    maps: PathBuf,
    relit: Option<PathBuf>,
    lpips: Option<&str>,
) -> PyResult<String> {
    let relit = relit.as_deref();
    let mut scores = long(py, || score::score(&capture, &maps, relit))?.map_err(raise)?;
    if let Some(net) = lpips {
        let rows = watched(py, None, |tools, _| suite::lpips(net, &capture, &maps, relit, tools))?;
        scores.rows.extend(rows);
    }
    json_of(&scores)
}

/// The pictures and maps that own metrics compare, as JSON text; `factor` is that of the albedo after one factor.
#[pyfunction]
#[pyo3(signature = (capture, maps, relit=None, factor=None))]
pub(super) fn shown_json(
    py: Python<'_>,
    capture: PathBuf,
    maps: PathBuf,
    relit: Option<PathBuf>,
    factor: Option<f64>,
) -> PyResult<String> {
    let all = || {
        let mut shown = score::shown_maps(&capture, &maps, factor);
        shown.extend(score::shown(&capture, &maps, relit.as_deref())?);
        Ok::<_, score::ScoreError>(shown)
    };
    let shown = long(py, all)?.map_err(raise)?;
    serde_json::to_string(&shown).map_err(|error| named_error("ScoreError", &error.to_string()))
}

/// The rows of an own metric with these values of `shown`, as JSON texts; `metric` is its statement.
#[pyfunction]
pub(super) fn judged_rows_json(
    py: Python<'_>,
    capture: PathBuf,
    shown: &str,
    metric: &str,
    values: Vec<Option<f64>>,
) -> PyResult<String> {
    let text = |error: serde_json::Error| named_error("ScoreError", &error.to_string());
    let shown: Vec<score::Shown> = serde_json::from_str(shown).map_err(text)?;
    let metric: OwnMetric = serde_json::from_str(metric).map_err(text)?;
    metric.register().map_err(raise)?;
    let rows = long(py, || score::judged_rows(&capture, &shown, &metric.id, &values))?;
    serde_json::to_string(&rows.map_err(raise)?).map_err(text)
}

/// Writes scores, as JSON text, to a file: the bytes that the command line writes.
#[pyfunction]
pub(super) fn write_scores(py: Python<'_>, text: &str, path: PathBuf) -> PyResult<()> {
    let scores: score::Scores = serde_json::from_str(text)
        .map_err(|error| named_error("ScoreError", &format!("no scores: {error}")))?;
    detached(py, || scores.write(&path))?.map_err(raise)
}

/// Reads a scores file as JSON text.
#[pyfunction]
pub(super) fn read_scores(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    json_of(&detached(py, || score::Scores::read(&path))?.map_err(raise)?)
}

fn json_of(scores: &score::Scores) -> PyResult<String> {
    serde_json::to_string(scores).map_err(|error| named_error("ScoreError", &error.to_string()))
}
