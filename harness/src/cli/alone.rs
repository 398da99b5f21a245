//! A stage outside a suite.

use std::sync::atomic::Ordering;
use std::time::Instant;

use super::progress::Progress;
use crate::suite::{Observer, RunError, Tools};
use crate::synth::{Interpreter, Interrupt};

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
pub(super) fn alone(
    id: &str,
    work: impl FnOnce(&Tools, &mut dyn FnMut(u64, u64, &str)) -> Result<(), RunError>,
) -> Result<(), RunError> {
    let mut progress = Progress::new();
    let start = Instant::now();
    progress.stage_begins(id, 0, 1);
    let result = work(&tools(), &mut |done, total, what| progress.step(id, done, total, what));
    if result.is_ok() {
        progress.stage_ends(id, Some(start.elapsed().as_secs_f64()));
    }
    progress.finish();
    result
}
