//! The path tracer's side of the house, called as a child process: `python -m unshade.stage`.
//!
//! The child reads its request as a line of JSON, reports in such lines on its standard output, and ends when its
//! standard input closes, so that a killed parent never leaves a renderer behind.

mod interpreter;
mod process;
mod request;

pub use interpreter::{Fingerprints, Interpreter, InterpreterError};
pub use process::{Interrupt, Place, StageError, Tools};
pub use request::{Export, Request};
