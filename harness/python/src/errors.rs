//! Rust's errors as the named exceptions of `unshade.errors`.

use capture::CaptureError;
use formats::MapsError;
use pyo3::prelude::*;
use solver::{BackendError, ConfigError, SolveError};

use harness::suite::RunError;
use report::ReportError;
use scoring::check::CheckError;
use scoring::score::ScoreError;
use view::ViewError;

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
    formats::atomic::FolderError => "StorageError",
    BackendError => "BackendError",
    CaptureError => "CaptureError",
    ConfigError => "ConfigError",
    formats::picture::PictureError => "PictureError",
    scoring::compare::CompareError => "CompareError",
    scoring::metrics::MetricError => "MetricError",
    scoring::study::StudyError => "ScoreError",
}

impl Named for ViewError {
    fn class(&self) -> &'static str {
        match self {
            Self::Capture(error) => error.class(),
            Self::Maps(error) => error.class(),
            Self::Picture(error) => error.class(),
            Self::Compare { reason, .. } => reason.class(),
            Self::Folder(error) => error.class(),
            Self::Read { .. } | Self::Write { .. } => "StorageError",
            Self::NoAlbedo(_) | Self::TooMany(_) => "MapsError",
        }
    }
}

/// A folder that may not be written is the same fault for all.
impl Named for MapsError {
    fn class(&self) -> &'static str {
        if let Self::Folder(error) = self { error.class() } else { "MapsError" }
    }
}

impl Named for ScoreError {
    fn class(&self) -> &'static str {
        if let Self::Folder(error) = self { error.class() } else { "ScoreError" }
    }
}

impl Named for ReportError {
    fn class(&self) -> &'static str {
        if let Self::Folder(error) = self { error.class() } else { "ReportError" }
    }
}

/// An error that a solve hands on keeps the class that it has elsewhere.
impl Named for SolveError {
    fn class(&self) -> &'static str {
        match self {
            Self::Config(error) => error.class(),
            Self::Capture(error) => error.class(),
            Self::Maps(error) => error.class(),
            Self::Interrupted => "Stopped",
            Self::NotFinite { .. }
            | Self::Memory { .. }
            | Self::GivenToOther
            | Self::Exposure(_)
            | Self::SeveralLights { .. } => "SolveError",
        }
    }
}

/// An error that a stage hands on keeps the class that it has elsewhere, the renderer's exceptions
/// too.
impl Named for RunError {
    fn class(&self) -> &'static str {
        match self {
            Self::Scene(_) => "SceneError",
            Self::Interpreter(_) | Self::Stage(_) => "RendererError",
            Self::Capture(error) => error.class(),
            Self::Config(error) | Self::ConfigFile { reason: error, .. } => error.class(),
            Self::Backend(error) => error.class(),
            Self::Solve(error) => error.class(),
            Self::Maps(error) => error.class(),
            Self::Score(error) => error.class(),
            Self::Check(error) => error.class(),
            Self::Report(error) => error.class(),
            Self::View(error) => error.class(),
            Self::Compare(error) => error.class(),
            Self::Study(error) => error.class(),
            Self::Program { .. } | Self::Methods { .. } => "SolveError",
            Self::Output(_) | Self::File { .. } | Self::Busy(_) | Self::Folder(_) => "StorageError",
            Self::Worker(_) => "ClusterError",
            Self::Interrupted | Self::Stopped { .. } => "Stopped",
            Self::Bench(_)
            | Self::Viewer(_)
            | Self::UnknownName { .. }
            | Self::Keep { .. }
            | Self::NoRun(_) => "UnshadeError",
            Self::Argument(_) => "ValueError",
            Self::Seal(_) | Self::Submission(_) => "UnshadeError",
        }
    }
}

/// An error of a capture or a maps folder keeps the class that it has elsewhere.
impl Named for CheckError {
    fn class(&self) -> &'static str {
        match self {
            Self::NoFolder(_) => "MapsError",
            Self::Capture(error) => error.class(),
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
        let module = if class == "ValueError" { "builtins" } else { "unshade.errors" };
        let raised = py
            .import(module)
            .and_then(|errors| errors.getattr(class))
            .and_then(|class| class.call1((message,)));
        raised.map_or_else(|error| error, PyErr::from_value)
    })
}
