//! Suites: every face in every light through every solver, resumable, nothing done twice.

mod content;
mod entrant;
mod file;
mod record;
mod run;
mod scene;

pub use content::hash_path;
pub use entrant::{TIME_LEFT, mean_texture, solve};
pub use file::{Case, Entrant, Method, Suite};
#[cfg(feature = "python")]
pub(crate) use run::SOLVER_SOURCES;
pub use run::{
    Observer, RunError, RunSummary, Tools, contact_sheet, describe, relight, run, synth,
};
pub use scene::{Scene, SceneError};
