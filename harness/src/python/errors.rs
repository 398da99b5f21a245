//! Rust's errors as the named exceptions of `unshade.errors`.

use pyo3::prelude::*;

use crate::score::ScoreError;
use crate::suite::RunError;
use solver::{BackendError, CaptureError, ConfigError, MapsError, SolveError};

/// An error that has a Python exception of its own.
pub(super) trait Named: std::error::Error {
    /// The class in `unshade.errors`.
    fn class(&self) -> &'static str;
}

macro_rules! named {
    ($($error:ty => $class:literal),* $(,)?) => {
        $(impl Named for $error {
            fn class(&self) -> &'static str {
                $class
            }
        })*
    };
}

named! {
    BackendError => "BackendError",
    CaptureError => "CaptureError",
    MapsError => "MapsError",
    ConfigError => "ConfigError",
    solver::picture::PictureError => "PictureError",
    ScoreError => "ScoreError",
    RunError => "UnshadeError",
    crate::compare::CompareError => "CompareError",
    crate::metrics::MetricError => "MetricError",
    crate::report::ReportError => "ReportError",
}

/// What a solve met with has the name that it has elsewhere.
impl Named for SolveError {
    fn class(&self) -> &'static str {
        match self {
            Self::Config(error) => error.class(),
            Self::Capture(error) => error.class(),
            Self::Maps(error) => error.class(),
            Self::NotFinite { .. } | Self::Interrupted | Self::Memory { .. } => "SolveError",
        }
    }
}

/// The exception for `error`.
pub(super) fn raise<E: Named>(error: E) -> PyErr {
    named_error(error.class(), &error.to_string())
}

/// The exception `class` of `unshade.errors`.
pub(super) fn named_error(class: &str, message: &str) -> PyErr {
    Python::attach(|py| {
        let raised = py
            .import("unshade.errors")
            .and_then(|errors| errors.getattr(class))
            .and_then(|class| class.call1((message,)));
        raised.map_or_else(|error| error, PyErr::from_value)
    })
}
