//! Suites: every face in every light and variant through every method, resumable, nothing done twice.
//!
//! `file` and `method` read the suite, `cases` multiplies faces, lights, variants and seeds. `preflight` checks
//! everything before anything is rendered, `plan` lists the stages, `pool` schedules them. `executor` compares the
//! key of a stage (`key`) with its record (`record`), then skips it, restores an earlier result, or runs it (`stage`,
//! `methods`).

mod baseline;
mod calibration_runs;
mod case_place;
mod case_size;
mod cases;
mod clean;
mod cluster;
mod competitor;
mod cost;
mod earlier;
mod error;
mod executor;
mod file;
mod finished;
mod forecast;
mod key;
mod manifest;
mod memory;
mod method;
mod method_work;
mod methods;
mod near;
mod observer;
mod output;
mod own_metrics;
mod packaged;
mod perceptual;
mod place;
mod plan;
mod pool;
mod preflight;
mod processors;
mod program;
mod record;
mod relative_path;
mod remote_stage;
mod run;
mod scene;
mod seal;
mod seeds;
mod size;
mod solve;
mod sources;
mod stage;
mod stage_work;
mod stages;
mod submission;
mod sweep;
mod tree_hashes;

pub use crate::synth::Tools;
pub use baseline::BaselineMethod;
pub use calibration_runs::CalibrationRuns;
pub use case_place::case_places;
pub use cases::Case;
pub use clean::{Cleaned, Part, clean};
pub use cluster::{Cluster, check_worker};
pub use competitor::Competitor;
pub use earlier::Bound;
pub use error::RunError;
pub use file::{NETS, RENDERERS, SCALES, Suite};
pub use forecast::{Forecast, StageForecast, forecast};
pub use method::{BaselineSettings, CompetitorMethod, Method, MethodKind, SolverMethod};
pub use observer::Observer;
pub use output::OutputHashes;
pub use own_metrics::OwnMetrics;
pub use packaged::set_folder as set_scenes_folder;
pub use perceptual::lpips;
pub use program::{Gives, Limits, Program, ProgramFiles, Start, Usage};
pub use remote_stage::{RemoteResult, RemoteStage, adopt, run_remote_stage};
pub use run::{RunOptions, RunSummary, begin_from, report, run};
pub use scene::{Scene, SceneError};
pub use seal::{Round, SealedCase, Sealing, seal, seal_verify, secret};
pub use seeds::Vary;
pub use size::in_words as in_bytes;
pub use solve::{TIME_LEFT, in_words, solve, solver_config};
pub use sources::{CAPTURE_SOURCES, READER_SOURCES, SCORE_SOURCES, SOLVER_SOURCES};
pub use stages::{
    Budget, Relight, budget, contact_sheet, describe, export, figure, relight, synth,
};
pub use submission::{Checked, check_submission, score_submission};
