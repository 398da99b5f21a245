//! Suites: every face in every light and variant through every solver, resumable, nothing done twice.

mod baseline;
mod cases;
mod content;
mod entrant;
mod error;
mod file;
mod manifest;
mod method;
mod place;
mod preflight;
mod program;
mod record;
mod run;
mod scene;
mod stages;
mod tools;

/// What the solver's and the scoring's code was when this program was built.
pub(crate) const SOLVER_SOURCES: &str = env!("UNSHADE_SOLVER_SOURCES");
const SCORE_SOURCES: &str = env!("UNSHADE_SCORE_SOURCES");

pub use baseline::BaselineMethod;
pub use cases::Case;
pub use content::hash_path;
pub use entrant::{TIME_LEFT, in_words, solve};
pub use error::RunError;
pub use file::{RENDERERS, SCALES, Suite};
pub use method::{Entrant, Method};
pub use program::{Limits, Program, ProgramFiles, Start, Usage};
pub use run::{RunOptions, RunSummary, report, run};
pub use scene::{Scene, SceneError};
pub use stages::{Export, contact_sheet, describe, export, relight, synth};
pub use tools::{Observer, Tools};
