//! The optimisation: Adam, the stages and their order, normalisation.

pub mod adam;
mod bending_penalty;
pub mod checkpoint;
mod clock;
mod confidence;
mod context;
mod deviated_highlights;
pub mod deviation;
pub mod diffuse;
pub(crate) mod error;
mod finish;
mod found;
mod heights;
pub mod highlights;
mod light_estimate;
mod lighting;
mod linear_colour;
mod log;
mod nearby;
pub mod normalise;
mod pooled_specular;
pub(crate) mod progress;
mod recolour;
pub mod relief;
mod snapshot;
pub mod solve;
pub mod specular;
mod specular_floor;
pub mod stage;
mod stage_runner;
mod steps;
mod tint;
pub mod transported;
mod vectors;
pub mod warm_up;

#[cfg(test)]
mod tests;
