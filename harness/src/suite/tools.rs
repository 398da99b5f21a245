//! Tools of every stage, and the observer of a run.

use crate::synth::{Interpreter, Interrupt};

/// Tools of every stage.
pub struct Tools {
    /// Runs the path tracer.
    pub interpreter: Interpreter,
    /// Raised by Ctrl-C.
    pub interrupt: Interrupt,
}

/// Hears how a run gets on.
pub trait Observer {
    /// `done` of `total` stages are finished and `id` begins.
    fn stage_begins(&mut self, id: &str, done: usize, total: usize);
    /// The stage `id` has done `done` of `total` steps, and is at `what`; `total` is 0 where nobody can count them, and
    /// `what` then is the last line of a program.
    fn step(&mut self, id: &str, done: u64, total: u64, what: &str);
    /// The stage is finished; `seconds` is absent if its earlier result was still valid.
    fn stage_ends(&mut self, id: &str, seconds: Option<f64>);
    /// The method of the stage failed; what follows from the stage is left out.
    fn stage_fails(&mut self, id: &str, reason: &str);
}
