//! Suites: every face in every light and variant through every solver, resumable, nothing done twice.

mod baseline;
mod cases;
mod content;
mod entrant;
mod file;
mod method;
mod record;
mod run;
mod scene;

pub use baseline::BaselineMethod;
pub use cases::Case;
pub use content::hash_path;
pub use entrant::{TIME_LEFT, in_words, solve};
pub use file::{SCALES, Suite};
pub use method::{Entrant, Method};
#[cfg(feature = "python")]
pub(crate) use run::SOLVER_SOURCES;
pub use run::{
    Observer, RunError, RunSummary, Tools, contact_sheet, describe, relight, report, run, synth,
};
pub use scene::{Scene, SceneError};
