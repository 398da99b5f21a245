//! A stage outside a suite.

use std::sync::atomic::Ordering;
use std::time::Instant;

use crate::suite::{Observer, RunError};
use crate::synth::{Interpreter, Interrupt, Tools};

/// The tools of a command that Ctrl-C stops cleanly; without them Ctrl-C ends the process.
pub(super) fn tools() -> Tools {
    let interrupt = Interrupt::default();
    let flag = interrupt.clone();
    // A second handler (a caller that set its own) keeps the first: then Ctrl-C is theirs.
    if let Err(error) = ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed)) {
        tracing::debug!("Ctrl-C is handled elsewhere: {error}");
    }
    Tools { interpreter: Interpreter::find(), interrupt }
}

/// Runs one stage outside a suite, with its bar.
pub(super) fn alone<T>(
    id: &str,
    observer: &mut dyn Observer,
    stage: impl FnOnce(&mut dyn FnMut(u64, u64, &str)) -> Result<T, RunError>,
) -> Result<T, RunError> {
    let start = Instant::now();
    observer.stage_begins(id, 0, 1);
    let result = stage(&mut |done, total, what| observer.step(id, done, total, what))?;
    observer.stage_ends(id, Some(start.elapsed().as_secs_f64()));
    Ok(result)
}
