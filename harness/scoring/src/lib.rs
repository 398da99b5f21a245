//! Measures maps and pictures against a rendered truth: [`metrics`], [`score`], [`compare`] with an
//! earlier run, and [`check`] for what is likely wrong without any truth.
//!
//! It needs files and captures, and no solver.

pub mod check;
pub mod compare;
pub mod metrics;
pub mod score;
pub mod study;
