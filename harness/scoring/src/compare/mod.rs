//! Regression scoring: a run against a baseline, score by score, with tolerances that were measured or
//! reasoned.

mod acceptance;
mod annotations;
mod baseline;
mod calibration;
mod cause;
mod context;
mod error;
mod history;
mod junit;
mod markdown;
mod measure;
mod row_id;
mod sides;
mod spread;
mod text;
mod tolerance;
mod verdict;

pub use acceptance::{Acceptance, Acceptances, is_day};
pub use baseline::{Baseline, Captured, Entry};
pub use calibration::{Calibration, Limits, MIN_RUNS, Spread};
pub use cause::Finding;
pub use error::CompareError;
pub use junit::Places;
pub use row_id::RowId;
pub use sides::{run_folder, sides};
pub use tolerance::{Rule, Tolerances};
pub use verdict::{Comparison, Judged, VERDICTS, Verdict, compare};
