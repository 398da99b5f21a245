//! The GPU of this process: a forked child cannot use one that its parent has opened.

use std::process;
use std::sync::atomic::{AtomicU32, Ordering};

use pyo3::PyResult;
use solver::{Backend, Choice};

use super::errors::{named_error, raise};

/// The process that opened a GPU, or 0.
static OPENED: AtomicU32 = AtomicU32::new(0);

/// Opens the backend. Raises `BackendError` where a GPU was opened before this process was forked: its driver's
/// threads are not in the child.
pub(super) fn open(choice: Choice) -> PyResult<Box<dyn Backend>> {
    let opened = OPENED.load(Ordering::Relaxed);
    if choice != Choice::Cpu && opened != 0 && opened != process::id() {
        return Err(named_error(
            "BackendError",
            "a GPU was opened before this process was forked, and cannot be used in it; start the process by \
             \"spawn\" or \"forkserver\", or give backend=\"cpu\"",
        ));
    }
    let backend = choice.open().map_err(raise)?;
    if !backend.name().starts_with("cpu") {
        OPENED.store(process::id(), Ordering::Relaxed);
    }
    Ok(backend)
}
