//! The optimisation: Adam, the stages and their order, normalisation.

pub mod adam;
pub mod normalise;
pub mod solve;
pub mod stage;

#[cfg(test)]
mod tests;
