//! Threads of the core's calls: their pools, Ctrl-C, and what a fork leaves of them.
//!
//! A forked child has one thread. Rayon's own pool, once begun, would be waited for in the child for ever; so no
//! call begins it. Long calls have a pool each, which ends with the call. Short ones share a pool of the process.

use std::process;
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender};
use std::thread;
use std::time::Duration;

use formats::cancel;
use harness::synth::Interrupt;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rayon::ThreadPool;

use super::errors::named_error;

/// The interval between two checks for Ctrl-C.
const TICK: Duration = Duration::from_millis(20);

/// The pool of short calls, and the process that its threads live in.
struct Shared {
    process: u32,
    pool: ThreadPool,
}

/// No lock: another thread may hold one at the moment of a fork.
static SHARED: AtomicPtr<Shared> = AtomicPtr::new(ptr::null_mut());

fn shared() -> PyResult<&'static ThreadPool> {
    let now = SHARED.load(Ordering::Acquire);
    // SAFETY: what was stored is a leaked box, which is never freed: in a child the parent's cannot be dropped.
    if let Some(shared) = unsafe { now.as_ref() }.filter(|s| s.process == process::id()) {
        return Ok(&shared.pool);
    }
    let pool = cancel::pool(0, None).map_err(no_threads)?;
    let new = Box::into_raw(Box::new(Shared { process: process::id(), pool }));
    let swapped = SHARED.compare_exchange(now, new, Ordering::AcqRel, Ordering::Acquire);
    let kept = swapped.map_or_else(
        |other| {
            // Another thread was first; ours goes.
            // SAFETY: `new` was made above and nobody else has it.
            drop(unsafe { Box::from_raw(new) });
            other
        },
        |_| new,
    );
    // SAFETY: as above.
    Ok(unsafe { &(*kept).pool })
}

fn no_threads(error: rayon::ThreadPoolBuildError) -> PyErr {
    PyRuntimeError::new_err(format!("cannot start threads: {error}"))
}

/// Does short work without Python's lock.
pub(super) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = shared()?;
    Ok(py.detach(|| pool.install(work)))
}

/// The arguments of a callback, a tuple.
pub(super) trait Arguments:
    Send + for<'py> IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>
{
}

impl<S> Arguments for S where
    S: Send
        + for<'py> IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>
{
}

/// The worker's end of the line to the callback, which takes `S`.
pub(super) struct Reporter<S> {
    steps: SyncSender<S>,
    /// Answers of the callback; absent without one.
    heard: Option<Receiver<bool>>,
}

impl<S> Reporter<S> {
    /// Returns when the callback has returned: whether to go on.
    pub(super) fn send(&self, step: S) -> bool {
        let Some(heard) = &self.heard else { return true };
        // After a stop the other end is gone.
        self.steps.send(step).is_ok() && heard.recv().unwrap_or(false)
    }
}

/// The end of a long call.
pub(super) enum End<T> {
    /// The work's result, also of work that the callback stopped by `unshade.STOP` and that ended by itself.
    Done(T),
    /// The callback stopped it by `unshade.STOP`, and it ended at once.
    Stopped,
}

/// Does long work on threads of its own while the caller's thread reports its progress and checks for Ctrl-C.
///
/// An exception of the callback, or Ctrl-C, raises `interrupt`, which ends the work at its next step or
/// [`cancel::check`]; it is then raised here. `unshade.STOP` raises it too where `graceful` is false.
pub(super) fn interruptible<T: Send, S: Arguments>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    graceful: bool,
    work: impl FnOnce(&Interrupt, &Reporter<S>) -> T + Send,
) -> PyResult<End<T>> {
    let interrupt = Interrupt::default();
    let pool = cancel::pool(0, Some(interrupt.clone())).map_err(no_threads)?;
    let (sender, steps) = mpsc::sync_channel(0);
    let (answer, heard) = mpsc::sync_channel(1);
    let reporter = Reporter { steps: sender, heard: progress.map(|_| heard) };
    let progress = progress.map(|progress| progress.clone().unbind());
    let mut stopped: PyResult<bool> = Ok(false);
    let result = py.detach(|| {
        let steps = steps;
        thread::scope(|scope| {
            let flag = &interrupt;
            // The reporter goes with the work, and with it the line.
            let work = move || cancel::catch(move || work(flag, &reporter));
            let worker = scope.spawn(move || pool.install(work));
            loop {
                let step = match steps.recv_timeout(TICK) {
                    Ok(step) => Some(step),
                    Err(RecvTimeoutError::Timeout) => None,
                    Err(RecvTimeoutError::Disconnected) => break,
                };
                let told = step.is_some();
                if matches!(stopped, Ok(false)) {
                    stopped = Python::attach(|py| hear(py, progress.as_ref(), step));
                    if stopped.is_err() || !graceful && matches!(stopped, Ok(true)) {
                        interrupt.store(true, Ordering::Relaxed);
                    }
                }
                if told {
                    let _ = answer.send(matches!(stopped, Ok(false)));
                }
            }
            worker.join()
        })
    });
    stopped?;
    match result {
        Ok(Some(value)) => Ok(End::Done(value)),
        Ok(None) => Ok(End::Stopped),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// Long work without a callback.
pub(super) fn long<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    match interruptible(py, None, false, |_, _: &Reporter<(bool,)>| work())? {
        End::Done(value) => Ok(value),
        End::Stopped => Err(named_error("Stopped", "interrupted")),
    }
}

/// Whether the callback answers `unshade.STOP`, after Python has seen to its signals.
fn hear<S: Arguments>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    step: Option<S>,
) -> PyResult<bool> {
    py.check_signals()?;
    let (Some(progress), Some(step)) = (progress, step) else { return Ok(false) };
    let answer = progress.bind(py).call1(step.into_pyobject(py)?)?;
    // A signal that came meanwhile is no news of the next step.
    py.check_signals()?;
    Ok(answer.is(&py.import("unshade.stopping")?.getattr("STOP")?))
}
