//! The outcome of a command.

use crate::suite::RunError;

/// The outcome of a command, for a terminal and for a caller in Python.
#[derive(Default)]
pub struct Outcome {
    /// The exit code.
    pub code: u8,
    /// The lines that a terminal shows.
    pub lines: Vec<String>,
    /// The result as JSON text; empty without one.
    pub value: String,
    /// The first method that failed, after everything else has been done.
    pub failure: Option<RunError>,
}

impl Outcome {
    /// A finished command that shows one line.
    pub(super) fn line(line: impl ToString) -> Self {
        Self { lines: vec![line.to_string()], ..Self::default() }
    }

    /// With a result.
    pub(super) fn with(self, value: &impl serde::Serialize) -> Result<Self, RunError> {
        let value = serde_json::to_string(value).map_err(std::io::Error::from)?;
        Ok(Self { value, ..self })
    }
}
