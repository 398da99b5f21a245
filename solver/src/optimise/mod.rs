//! The optimisation: Adam, the stages and their order, normalisation.

pub mod adam;
mod bending_penalty;
mod bent_highlights;
pub mod checkpoint;
mod clock;
mod confidence;
pub mod deviation;
pub mod diffuse;
pub(crate) mod error;
mod finish;
mod found;
mod gloss;
mod heights;
pub mod highlights;
mod linear_colour;
mod lit;
mod log;
mod nearby;
pub mod normalise;
mod probed;
pub(crate) mod progress;
mod recolour;
mod reflectance;
pub mod relief;
mod run;
mod site;
mod snapshot;
pub mod solve;
pub mod specular;
pub mod stage;
mod steps;
mod tint;
pub mod transported;
mod vectors;
mod veil;
pub mod warm_up;

#[cfg(test)]
mod tests;
