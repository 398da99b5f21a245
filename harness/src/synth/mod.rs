//! The path tracer's side of the house, called as a child process: `python -m unshade.stage`.
//!
//! The child says what it does in JSON lines on its standard output and ends when its
//! standard input closes, so that a killed parent never leaves a renderer behind.

mod interpreter;
mod process;

pub use interpreter::{Fingerprints, Interpreter, InterpreterError};
pub use process::{Interrupt, StageError, cli_args, run_stage};
