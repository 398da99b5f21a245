//! Scores, reports, compares and runs reflectance recovery against a rendered truth.
//!
//! [`suite`] walks through the stages: [`synth`] calls the path tracer, the solver makes maps,
//! [`score`] measures them with [`metrics`], [`report`] shows them, [`compare`] guards them.

pub mod bench;
pub mod check;
pub mod cli;
pub mod compare;
pub mod metrics;
#[cfg(feature = "python")]
mod python;
pub mod report;
pub mod score;
pub mod suite;
pub mod synth;
