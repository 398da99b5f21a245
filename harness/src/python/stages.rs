//! The stages that render or take long, as functions.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

use super::errors::{named_error, raise};
use crate::suite::{self, Observer, RunError, Suite, Tools};
use crate::synth::{Interpreter, Interrupt, StageError};

/// Renders a scene file into a capture folder.
#[pyfunction]
pub(super) fn synth(py: Python<'_>, scene: PathBuf, out: PathBuf) -> PyResult<()> {
    watched(py, |tools| suite::synth(&scene, &out, tools, &mut |_, _, _| {}))
}

/// Renders maps in a capture's lights.
#[pyfunction]
pub(super) fn relight(
    py: Python<'_>,
    capture: PathBuf,
    maps: PathBuf,
    out: PathBuf,
) -> PyResult<PathBuf> {
    watched(py, |tools| {
        suite::relight(&capture, &maps, &out, &suite::SCALES, tools, &mut |_, _, _| {})
    })?;
    Ok(out)
}

/// Runs a suite, resuming it, and returns its report's page.
#[pyfunction]
pub(super) fn run(py: Python<'_>, suite: PathBuf, out: PathBuf) -> PyResult<PathBuf> {
    watched(py, |tools| {
        Ok(suite::run(
            &Suite::open(&suite)?,
            &out,
            &suite::RunOptions::default(),
            tools,
            &mut Silent,
        )?
        .report)
    })
}

struct Silent;

impl Observer for Silent {
    fn stage_begins(&mut self, _: &str, _: usize, _: usize) {}
    fn step(&mut self, _: u64, _: u64, _: &str) {}
    fn stage_ends(&mut self, _: &str, _: Option<f64>) {}
}

/// Does `work` on another thread while this one looks out for Ctrl-C.
fn watched<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Tools) -> Result<T, RunError> + Send,
) -> PyResult<T> {
    let python: PathBuf = py.import("sys")?.getattr("executable")?.extract()?;
    let tools =
        Tools { interpreter: Interpreter::at(Path::new(&python)), interrupt: Interrupt::default() };
    let mut signal = Ok(());
    let result = py.detach(|| {
        thread::scope(|scope| {
            let worker = scope.spawn(|| work(&tools));
            while !worker.is_finished() {
                thread::sleep(Duration::from_millis(20));
                if signal.is_ok() {
                    signal = Python::attach(|py| py.check_signals());
                    tools.interrupt.store(signal.is_err(), Ordering::Relaxed);
                }
            }
            worker.join()
        })
    });
    signal?;
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
