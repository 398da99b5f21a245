//! The optimisation: Adam, the stages and their order, normalisation.

pub mod adam;
pub mod checkpoint;
mod clock;
mod confidence;
mod context;
mod deviated_highlights;
mod deviation_penalty;
pub mod diffuse;
mod distance;
pub(crate) mod error;
mod finish;
mod found;
mod halves;
pub mod height_solve;
mod heights;
pub mod highlights;
mod light_estimate;
mod lighting;
mod linear_colour;
mod log;
mod nearby;
pub mod normalise;
pub mod normals;
mod pooled_specular;
pub(crate) mod progress;
mod recolour;
mod refinement;
mod region_terms;
mod regression;
mod roughness;
mod snapshot;
pub mod solve;
pub mod specular;
mod specular_floor;
pub mod stage;
mod stage_runner;
mod steps;
mod surroundings;
mod tint;
pub mod transported;
mod vectors;
pub mod warm_up;

#[cfg(test)]
mod tests;
