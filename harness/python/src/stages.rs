//! The stages that render or take long, as functions.
//!
//! Each takes `progress(done, total, what)`. What it raises (or Ctrl-C) stops the stage and is raised
//! here; `False` stops it too, and raises `errors.Stopped`.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender};
use std::thread;
use std::time::Duration;

use harness::suite::{self, Observer, RunError, RunOptions, Suite, Tools};
use harness::synth::{Interpreter, Interrupt, StageError};
use pyo3::prelude::*;
use pyo3::types::PyBool;

use super::errors::{named_error, raise};

/// How often Ctrl-C is looked out for.
const TICK: Duration = Duration::from_millis(20);

type Heard<'py> = Option<&'py Bound<'py, PyAny>>;

/// Renders a scene file into a capture folder.
#[pyfunction]
#[pyo3(signature = (scene, out, progress=None))]
pub(super) fn synth(py: Python<'_>, scene: PathBuf, out: PathBuf, progress: Heard) -> PyResult<()> {
    watched(py, progress, |tools, said| {
        suite::synth(&scene, &out, tools, &mut |done, total, what| said.say(done, total, what))
    })
}

/// Renders maps in a capture's lights.
#[pyfunction]
#[pyo3(signature = (capture, maps, out, progress=None, renderer="mitsuba"))]
pub(super) fn relight(
    py: Python<'_>,
    capture: PathBuf,
    maps: PathBuf,
    out: PathBuf,
    progress: Heard,
    renderer: &str,
) -> PyResult<PathBuf> {
    watched(py, progress, |tools, said| {
        let step = &mut |done, total, what: &str| said.say(done, total, what);
        suite::relight(renderer, &capture, &maps, &out, &suite::SCALES, tools, step)
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
        let mut teller = Teller { said, done: 0, total: 0 };
        let options = RunOptions { redo, jobs, cluster: None };
        let summary = suite::run(&Suite::open(&suite)?, &out, &options, tools, &mut teller)?;
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

/// Arguments of the callback: done, total, and what.
type Step = (u64, u64, String);

/// The worker's end of the line to the callback.
pub(super) struct Said(Option<(SyncSender<Step>, Receiver<()>)>);

impl Said {
    /// Returns when it was heard, so that no more is done once the callback asks to stop.
    pub(super) fn say(&self, done: u64, total: u64, what: &str) {
        if let Some((steps, heard)) = &self.0 {
            // After a stop nobody listens any more.
            let _ = steps.send((done, total, what.to_owned())).map(|()| heard.recv());
        }
    }
}

/// Counts the stages of a run, and says in words how far the stage is.
struct Teller<'a> {
    said: &'a Said,
    done: u64,
    total: u64,
}

impl Observer for Teller<'_> {
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

/// Does `work` on another thread while this one, the caller's, hears its progress and looks out for
/// Ctrl-C.
pub(super) fn watched<T: Send>(
    py: Python<'_>,
    progress: Heard,
    work: impl FnOnce(&Tools, &Said) -> Result<T, RunError> + Send,
) -> PyResult<T> {
    let python: PathBuf = py.import("sys")?.getattr("executable")?.extract()?;
    let tools =
        Tools { interpreter: Interpreter::at(Path::new(&python)), interrupt: Interrupt::default() };
    let (sender, steps) = mpsc::sync_channel(0);
    let (answer, heard) = mpsc::sync_channel(1);
    let said = Said(progress.map(|_| (sender, heard)));
    let progress = progress.map(|progress| progress.clone().unbind());
    let mut stopped: PyResult<bool> = Ok(true);
    let result = py.detach(|| {
        thread::scope(|scope| {
            let tools = &tools;
            let worker = scope.spawn(move || work(tools, &said));
            let mut steps = Some(steps);
            while !worker.is_finished() {
                let step = match &steps {
                    Some(steps) => steps.recv_timeout(TICK),
                    None => Err(RecvTimeoutError::Disconnected),
                };
                if let Err(RecvTimeoutError::Disconnected) = step {
                    thread::sleep(TICK);
                }
                if !matches!(stopped, Ok(true)) {
                    continue;
                }
                let spoke = step.is_ok();
                stopped = Python::attach(|py| hear(py, progress.as_ref(), step.ok()));
                if !matches!(stopped, Ok(true)) {
                    tools.interrupt.store(true, Ordering::Relaxed);
                    steps = None;
                }
                if spoke {
                    let _ = answer.send(());
                }
            }
            worker.join()
        })
    });
    stopped?;
    match result {
        Ok(Ok(value)) => Ok(value),
        // The renderer's own exception keeps its name.
        Ok(Err(RunError::Stage(StageError::Input { kind, message }))) => {
            Err(named_error(&kind, &message))
        }
        Ok(Err(error)) => Err(raise(error)),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// Whether to go on, after Python has seen to its signals and the callback has heard the step.
fn hear(py: Python<'_>, progress: Option<&Py<PyAny>>, step: Option<Step>) -> PyResult<bool> {
    py.check_signals()?;
    let (Some(progress), Some(step)) = (progress, step) else { return Ok(true) };
    let answer = progress.call1(py, step)?;
    // A signal that came meanwhile is no news of the next step.
    py.check_signals()?;
    // None, as of a function that returns nothing, goes on.
    Ok(!answer.bind(py).is(PyBool::new(py, false)))
}
