//! The observer of a command.

/// Follows the progress of a command.
pub trait Observer {
    /// A suite is read, and its first stage begins soon.
    fn suite_begins(&mut self) {}
    /// Shows a line to the user, besides the results.
    fn message(&mut self, _line: &str) {}
    /// `done` of `total` stages are finished and `id` begins.
    fn stage_begins(&mut self, id: &str, done: usize, total: usize);
    /// The stage `id` has done `done` of `total` steps, and is at `what`; `total` is 0 where they cannot be counted, and
    /// `what` then is the last line of a program.
    fn step(&mut self, id: &str, done: u64, total: u64, what: &str);
    /// The stage is finished; `seconds` is absent if its earlier result was still valid.
    fn stage_ends(&mut self, id: &str, seconds: Option<f64>);
    /// The method of the stage failed; what follows from the stage is left out.
    fn stage_fails(&mut self, id: &str, reason: &str);
}
