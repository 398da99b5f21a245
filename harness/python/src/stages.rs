//! The stages that render or take long, as functions.
//!
//! Each takes `progress(done, total, what)`. What it raises (or Ctrl-C) stops the stage and is raised
//! here; `unshade.STOP` stops it too, and raises `errors.Stopped`.

use std::path::{Path, PathBuf};

use harness::suite::{self, Observer, RunError, RunOptions, Suite, Tools};
use harness::synth::{Interpreter, StageError};
use pyo3::prelude::*;

use super::errors::{named_error, raise};
use super::threads::{End, Reporter, interruptible};

type Heard<'py> = Option<&'py Bound<'py, PyAny>>;

/// Renders a scene file into a capture folder.
#[pyfunction]
#[pyo3(signature = (scene, out, progress=None))]
pub(super) fn synth(py: Python<'_>, scene: PathBuf, out: PathBuf, progress: Heard) -> PyResult<()> {
    watched(py, progress, |tools, said| {
        suite::synth(&scene, &out, tools, &mut |done, total, what| said.say(done, total, what))
    })
}

/// Renders maps in a capture's lights, or in a lat-long picture.
#[pyfunction]
#[pyo3(signature = (capture, maps, out, progress=None, renderer="mitsuba", light=None))]
pub(super) fn relight(
    py: Python<'_>,
    capture: PathBuf,
    maps: PathBuf,
    out: PathBuf,
    progress: Heard,
    renderer: &str,
    light: Option<PathBuf>,
) -> PyResult<PathBuf> {
    watched(py, progress, |tools, said| {
        let relight = suite::Relight {
            capture: &capture,
            maps: &maps,
            out: &out,
            renderer,
            scales: &suite::SCALES,
            light: light.as_deref(),
        };
        suite::relight(&relight, tools, &mut |done, total, what| said.say(done, total, what))
    })?;
    Ok(out)
}

/// Writes the error budget of a relit view; JSON text of what it found.
#[pyfunction]
#[pyo3(signature = (capture, maps, out, light=None, view=None, progress=None))]
pub(super) fn budget(
    py: Python<'_>,
    capture: PathBuf,
    maps: PathBuf,
    out: PathBuf,
    light: Option<String>,
    view: Option<String>,
    progress: Heard,
) -> PyResult<String> {
    let said = watched(py, progress, |tools, said| {
        let (light, view) = (light.as_deref(), view.as_deref());
        let budget = suite::Budget { capture: &capture, maps: &maps, out: &out, light, view };
        suite::budget(&budget, tools, &mut |done, total, what| said.say(done, total, what))
    })?;
    Ok(said.to_string())
}

/// Writes maps as an asset; JSON text of what the asset says of itself.
#[pyfunction]
#[pyo3(signature = (maps, out, options, capture=None, mesh=None, progress=None))]
pub(super) fn export(
    py: Python<'_>,
    maps: PathBuf,
    out: PathBuf,
    options: Vec<String>,
    capture: Option<PathBuf>,
    mesh: Option<PathBuf>,
    progress: Heard,
) -> PyResult<String> {
    let said = watched(py, progress, |tools, said| {
        let export = suite::Export {
            maps: &maps,
            out: &out,
            capture: capture.as_deref(),
            mesh: mesh.as_deref(),
            options: options.into_iter().map(Into::into).collect(),
        };
        suite::export(&export, tools, &mut |done, total, what| said.say(done, total, what))
    })?;
    Ok(said.to_string())
}

/// Runs a suite, resuming it, and returns its report's page.
#[pyfunction]
#[pyo3(signature = (suite, out, redo=Vec::new(), progress=None, jobs=1))]
pub(super) fn run(
    py: Python<'_>,
    suite: PathBuf,
    out: PathBuf,
    redo: Vec<String>,
    progress: Heard,
    jobs: usize,
) -> PyResult<PathBuf> {
    watched(py, progress, |tools, said| {
        let mut reporter = RunReporter::new(said);
        let options = RunOptions { redo, jobs, cluster: None };
        let summary = suite::run(&Suite::open(&suite)?, &out, &options, tools, &mut reporter)?;
        match summary.failed.into_iter().next() {
            None => Ok(summary.report),
            Some((name, reason)) => Err(RunError::Methods { name, reason, report: summary.report }),
        }
    })
}

/// Writes the report of a run folder.
#[pyfunction]
#[pyo3(signature = (run, out, progress=None))]
pub(super) fn report(py: Python<'_>, run: PathBuf, out: PathBuf, progress: Heard) -> PyResult<()> {
    watched(py, progress, |tools, said| {
        suite::report(&run, &out, tools, &mut |done, total, what| said.say(done, total, what))
    })
}

/// The callback's arguments: done, total, and what.
pub(super) type Step = (u64, u64, String);

impl Reporter<Step> {
    pub(super) fn say(&self, done: u64, total: u64, what: &str) {
        // A stop raises the interrupt, which the stage sees by itself.
        self.send((done, total, what.to_owned()));
    }
}

/// Counts the stages of a run, and says in words how far the stage is.
pub(super) struct RunReporter<'a> {
    said: &'a Reporter<Step>,
    done: u64,
    total: u64,
}

impl<'a> RunReporter<'a> {
    pub(super) fn new(said: &'a Reporter<Step>) -> Self {
        Self { said, done: 0, total: 0 }
    }
}

impl Observer for RunReporter<'_> {
    fn stage_begins(&mut self, id: &str, done: usize, total: usize) {
        (self.done, self.total) = (done as u64, total as u64);
        self.said.say(self.done, self.total, id);
    }

    fn step(&mut self, id: &str, done: u64, total: u64, what: &str) {
        let what = match total {
            0 => format!("{id}: {what}"),
            _ => format!("{id}: {done} of {total}, {what}"),
        };
        self.said.say(self.done, self.total, &what);
    }

    fn stage_ends(&mut self, id: &str, _: Option<f64>) {
        self.done += 1;
        self.said.say(self.done, self.total, id);
    }

    fn stage_fails(&mut self, id: &str, reason: &str) {
        self.said.say(self.done, self.total, &format!("{id}: failed: {reason}"));
    }
}

/// Does `work` on other threads while this one, the caller's, hears its progress and looks out for
/// Ctrl-C.
pub(super) fn watched<T: Send>(
    py: Python<'_>,
    progress: Heard,
    work: impl FnOnce(&Tools, &Reporter<Step>) -> Result<T, RunError> + Send,
) -> PyResult<T> {
    let python: PathBuf = py.import("sys")?.getattr("executable")?.extract()?;
    let interpreter = Interpreter::at(Path::new(&python));
    let end = interruptible(py, progress, false, |interrupt, said| {
        work(&Tools { interpreter, interrupt: interrupt.clone() }, said)
    })?;
    match end {
        End::Done(Ok(value)) => Ok(value),
        // The renderer's own exception keeps its name.
        End::Done(Err(RunError::Stage(StageError::Input { kind, message }))) => {
            Err(named_error(&kind, &message))
        }
        End::Done(Err(error)) => Err(raise(error)),
        End::Stopped => Err(raise(RunError::Interrupted)),
    }
}
