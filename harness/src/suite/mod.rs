//! Suites: every face in every light and variant through every solver, resumable, nothing done twice.

mod baseline;
mod cases;
mod competitor;
mod error;
mod file;
mod make_maps;
mod manifest;
mod method;
mod packaged;
mod place;
mod preflight;
mod program;
mod record;
mod relit;
mod run;
mod scene;
mod sources;
mod stages;
mod tools;

pub use baseline::BaselineMethod;
pub use cases::Case;
pub use competitor::{Class, Competitor};
pub use error::RunError;
pub use file::{RENDERERS, SCALES, Suite};
pub use make_maps::{TIME_LEFT, in_words, solve};
pub use method::{Method, MethodKind};
pub use packaged::set_folder as set_scenes_folder;
pub use program::{Gives, Limits, Program, ProgramFiles, Start, Usage};
pub use run::{RunOptions, RunSummary, report, run};
pub use scene::{Scene, SceneError};
pub use sources::{READER_SOURCES, SOLVER_SOURCES};
pub use stages::{Export, contact_sheet, describe, export, figure, relight, synth};
pub use tools::{Observer, Tools};
