//! The optimisation: Adam, the stages and their order, normalisation.

pub mod adam;
pub mod checkpoint;
mod finish;
pub mod normalise;
pub mod relief;
mod run;
mod site;
pub mod solve;
pub mod stage;
pub mod transported;

#[cfg(test)]
mod tests;
