//! Full-batch optimisation by Adam: what an optimised problem offers, and the loop's variables.

pub mod adam;
pub mod albedo;

use crate::backend::Backend;
use crate::backend::resident::{Job, Variable};

/// A problem that is optimised step by step. It owns what moves; everything else is borrowed and stays.
pub trait Fit {
    /// The largest number of full-batch steps.
    fn iterations(&self) -> usize;

    /// The values that move with their optimisers, in a fixed order: that of the job, if a device takes it.
    fn variables(&mut self) -> Vec<Variable<'_>>;

    /// The loss, and its gradients by [`Fit::variables`] in their order.
    fn gradient(&self, backend: &dyn Backend) -> (f64, Vec<Vec<f32>>);

    /// Takes one step by `decay` of the learning rates, and returns the loss before it.
    fn step(&mut self, backend: &dyn Backend, decay: f32) -> f64 {
        let (loss, gradients) = self.gradient(backend);
        let variables = self.variables().into_iter();
        variables
            .zip(&gradients)
            .for_each(|(mut variable, gradient)| variable.step(gradient, decay));
        loss
    }

    /// Whether further steps gain nothing; asked before each.
    fn is_converged(&self) -> bool {
        false
    }

    /// Values besides the variables on which the next steps depend, for checkpoints.
    fn memory(&mut self) -> Vec<&mut Vec<f32>> {
        vec![]
    }

    /// The problem as a device may take it over; `None` if no device has a program for it.
    fn job(&self) -> Option<Job<'_>> {
        None
    }
}
