//! The commands of the command line, as one function.
//!
//! A command calls `progress(done, total, what)`. An exception of that (or Ctrl-C) stops the command and is raised
//! here; `unshade.STOP` stops it too, and raises `errors.Stopped`.

use std::path::{Path, PathBuf};

use harness::cli::run_request;
use harness::suite::{Observer, RunError};
use harness::synth::{Interpreter, StageError, Tools};
use pyo3::prelude::*;

use super::errors::{named_error, raise};
use super::threads::{End, Reporter, interruptible};

/// Runs a command: a JSON object with its name as `command` and its arguments, as those of the command line. Returns
/// its result as JSON text. Raises the first method's error, if one failed, after everything else has been done.
#[pyfunction]
#[pyo3(signature = (request, progress=None))]
pub(super) fn command(
    py: Python<'_>,
    request: &str,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let outcome = watched(py, progress, |tools, reporter| {
        let mut observer = ProgressReporter { reporter, stages: None };
        run_request(request, tools, &mut observer)
    })?;
    outcome.failure.map_or(Ok(outcome.value), |error| Err(raise(error)))
}

/// The callback's arguments: done, total, and the step.
pub(super) type Step = (u64, u64, String);

/// Passes the progress of a stage on; of a suite, counts its stages and describes the one that runs.
struct ProgressReporter<'a> {
    reporter: &'a Reporter<Step>,
    /// Finished stages of a suite, and all of them.
    stages: Option<(u64, u64)>,
}

impl ProgressReporter<'_> {
    /// A stop raises the interrupt, which the stage sees by itself.
    fn send(&self, what: String) {
        if let Some((done, total)) = self.stages {
            self.reporter.send((done, total, what));
        }
    }
}

impl Observer for ProgressReporter<'_> {
    fn suite_begins(&mut self) {
        self.stages = Some((0, 0));
    }

    fn stage_begins(&mut self, id: &str, done: usize, total: usize) {
        self.stages = self.stages.map(|_| (done as u64, total as u64));
        self.send(id.to_owned());
    }

    fn step(&mut self, id: &str, done: u64, total: u64, what: &str) {
        match (self.stages, total) {
            (None, _) => {
                self.reporter.send((done, total, what.to_owned()));
            }
            (_, 0) => self.send(format!("{id}: {what}")),
            _ => self.send(format!("{id}: {done} of {total}, {what}")),
        }
    }

    fn stage_ends(&mut self, id: &str, _: Option<f64>) {
        self.stages = self.stages.map(|(done, total)| (done + 1, total));
        self.send(id.to_owned());
    }

    fn stage_fails(&mut self, id: &str, reason: &str) {
        self.send(format!("{id}: failed: {reason}"));
    }
}

/// Does `work` on other threads while this one, the caller's, reports its progress and checks for Ctrl-C.
pub(super) fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Tools, &Reporter<Step>) -> Result<T, RunError> + Send,
) -> PyResult<T> {
    let python: PathBuf = py.import("sys")?.getattr("executable")?.extract()?;
    let interpreter = Interpreter::at(Path::new(&python));
    let end = interruptible(py, progress, false, |interrupt, reporter| {
        work(&Tools { interpreter, interrupt: interrupt.clone() }, reporter)
    })?;
    match end {
        End::Done(Ok(value)) => Ok(value),
        // The renderer's own exception keeps its name.
        End::Done(Err(RunError::Stage(StageError::Input { kind, message, .. }))) => {
            Err(named_error(&kind, &message))
        }
        End::Done(Err(error)) => Err(raise(error)),
        End::Stopped => Err(raise(RunError::Interrupted)),
    }
}
