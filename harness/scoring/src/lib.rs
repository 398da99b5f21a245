//! Measures maps and pictures against a rendered truth: [`metrics`], [`score`], [`compare`] with an
//! earlier run, and [`check`] for what is likely wrong without any truth.
//!
//! The crate reads files and captures; it depends on no solver.

pub mod check;
pub mod compare;
pub mod metrics;
pub mod run;
pub mod score;
pub mod study;
pub mod tables;
