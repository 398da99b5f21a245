//! Scoring.
pub mod report;
