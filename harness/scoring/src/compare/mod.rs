//! Regression scoring: a run against a baseline, score by score, with stated tolerances.

mod baseline;
mod error;
mod tolerance;
mod verdict;

pub use baseline::{Baseline, Entry};
pub use error::CompareError;
pub use tolerance::{Rule, Tolerances};
pub use verdict::{Comparison, Judged, Verdict, compare};
