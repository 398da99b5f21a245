//! The stages as functions.

use std::ops::ControlFlow;
use std::path::PathBuf;

use harness::cli;
use harness::suite::{self, SOLVER_SOURCES};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use scoring::compare::{self as comparing, Tolerances};
use scoring::{check, score, study};
use solver::{Choice, Options};

use super::capture::Capture;
use super::errors::{named_error, raise};
use super::maps::Maps;
use super::stages::watched;

/// Runs the command line and returns its exit code.
#[pyfunction]
pub(super) fn run_command_line(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| cli::main(arguments))
}

/// Recovers maps from a capture or its folder; `progress(stage, iteration, total, loss)` may be given. What it
/// raises (or Ctrl-C) stops the solve and is raised here; `False` stops it too, and the maps so far
/// are returned. With `out`, the whole maps folder is written there, after a stop as well, and the
/// same call goes on from where it stopped.
#[pyfunction]
#[pyo3(signature = (capture, *, config="unshade", out=None, progress=None, backend="auto"))]
pub(super) fn solve(
    py: Python<'_>,
    capture: &Bound<'_, PyAny>,
    config: &str,
    out: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
    backend: &str,
) -> PyResult<Maps> {
    // A preset's name, or the text of a configuration.
    let mut config = if config.contains('=') {
        solver::Config::from_toml(config)
    } else {
        solver::Config::preset(config)
    }
    .map_err(raise)?;
    if out.is_none() {
        // Nobody would see them.
        config.records = solver::config::RecordConfig { stages: false, layers: false };
    }
    let backend: Choice = backend.parse().map_err(raise)?;
    let capture = Capture::given(capture)?;
    let capture = &capture.get().inner;
    let opened = py.detach(|| backend.open()).map_err(raise)?;
    let mut raised: Option<PyErr> = None;
    let solution = py.detach(|| {
        let mut hear = |step: &solver::Progress| {
            let go_on = Python::attach(|py| {
                py.check_signals()?;
                let Some(progress) = &progress else { return Ok(true) };
                let arguments = (step.stage, step.iteration, step.total, step.loss);
                let answer = progress.call1(py, arguments)?;
                // None, as of a function that returns nothing, goes on.
                Ok(!answer.bind(py).is(PyBool::new(py, false)))
            });
            match go_on {
                Ok(true) => return ControlFlow::Continue(()),
                Ok(false) => {}
                Err(error) => raised = Some(error),
            }
            ControlFlow::Break(())
        };
        let backend = &*opened;
        match &out {
            Some(out) => {
                solver::solve_into(backend, out, SOLVER_SOURCES, capture, &config, &mut hear)
            }
            None => solver::solve_on(backend, capture, &config, Options::default(), &mut hear),
        }
    });
    if let Some(error) = raised {
        return Err(error);
    }
    let solution = solution.map_err(raise)?;
    Maps::new_from(py, solution.maps, solution.record.interrupted)
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
    let mut scores = py.detach(|| score::score(&capture, &maps, relit)).map_err(raise)?;
    if let Some(net) = lpips {
        let rows = watched(py, None, |tools, _| suite::lpips(net, &capture, &maps, relit, tools))?;
        scores.rows.extend(rows);
    }
    json_of(&scores)
}

/// Likely faults of a maps folder, as JSON text: a list of findings.
#[pyfunction]
#[pyo3(signature = (maps, capture=None))]
pub(super) fn check_json(
    py: Python<'_>,
    maps: PathBuf,
    capture: Option<PathBuf>,
) -> PyResult<String> {
    let findings = py.detach(|| check::check(&maps, capture.as_deref())).map_err(raise)?;
    serde_json::to_string(&findings).map_err(|error| named_error("MapsError", &error.to_string()))
}

/// Writes scores, as JSON text, to a file: the bytes that the command line writes.
#[pyfunction]
pub(super) fn write_scores(py: Python<'_>, text: &str, path: PathBuf) -> PyResult<()> {
    let scores: score::Scores = serde_json::from_str(text)
        .map_err(|error| named_error("ScoreError", &format!("no scores: {error}")))?;
    py.detach(|| scores.write(&path)).map_err(raise)
}

/// Reads a scores file as JSON text.
#[pyfunction]
pub(super) fn read_scores(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    json_of(&py.detach(|| score::Scores::read(&path)).map_err(raise)?)
}

/// The study of runs as JSON text: (the study, its observations). With `out`, its folder is written.
#[pyfunction]
#[pyo3(signature = (runs, out=None))]
pub(super) fn study_json(
    py: Python<'_>,
    runs: Vec<PathBuf>,
    out: Option<PathBuf>,
) -> PyResult<(String, String)> {
    let made = || {
        let observations = study::observations(&runs)?;
        let found = study::Study::of(&observations);
        if let Some(out) = &out {
            study::write_study(&found, &observations, &runs, out, "unshade.study")?;
        }
        Ok::<_, study::StudyError>((found, observations))
    };
    let (found, observations) = py.detach(made).map_err(raise)?;
    let text = |error: serde_json::Error| named_error("ScoreError", &error.to_string());
    let found = serde_json::to_string(&found).map_err(text)?;
    Ok((found, serde_json::to_string(&observations).map_err(text)?))
}

fn json_of(scores: &score::Scores) -> PyResult<String> {
    serde_json::to_string(scores).map_err(|error| named_error("ScoreError", &error.to_string()))
}

/// True if no score of a run is worse than its baseline beyond the tolerance.
#[pyfunction]
#[pyo3(signature = (run, baseline, tolerances=None))]
pub(super) fn compare(
    run: PathBuf,
    baseline: PathBuf,
    tolerances: Option<PathBuf>,
) -> PyResult<bool> {
    let tolerances = match tolerances {
        Some(path) => Tolerances::read(&path),
        None => Tolerances::built_in(),
    }
    .map_err(raise)?;
    let [current, baseline] = comparing::sides(&run, &baseline).map_err(raise)?;
    Ok(comparing::compare(&current, &baseline, &tolerances).map_err(raise)?.passed())
}
