//! Runs reflectance recovery against a rendered truth.
//!
//! [`suite`] walks through the stages: [`synth`] calls the path tracer, the solver makes maps, `scoring`
//! measures them, `report` shows them; [`cli`] is the command line.

pub mod cli;
mod rerun_viewer;
pub mod suite;
pub mod synth;
