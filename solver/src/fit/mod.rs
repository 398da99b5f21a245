//! Full-batch optimisation by Adam.

pub mod adam;
pub mod albedo;

use crate::backend::Backend;
use crate::backend::resident::{Job, Variable};

/// A problem that is optimised step by step. It owns the parameters and borrows the constants.
pub trait Fit {
    /// The largest number of full-batch steps.
    fn iterations(&self) -> usize;

    /// The parameters with their optimisers, in a fixed order: that of the [`Job`], if a device has a program for it.
    fn variables(&mut self) -> Vec<Variable<'_>>;

    /// The loss, and its gradients with respect to [`Fit::variables`] in their order.
    fn gradient(&self, backend: &dyn Backend) -> (f64, Vec<Vec<f32>>);

    /// Takes one step by `decay` of the learning rates, and returns the loss before it.
    fn step(&mut self, backend: &dyn Backend, decay: f32) -> f64 {
        let (loss, gradients) = self.gradient(backend);
        step(self.variables(), &gradients, decay);
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

    /// The problem for a device; `None` if no device has a program for it.
    fn job(&self) -> Option<Job<'_>> {
        None
    }
}

/// Takes one step of every variable by its gradient, by `decay` of the learning rates.
pub fn step(variables: Vec<Variable<'_>>, gradients: &[Vec<f32>], decay: f32) {
    let pairs = variables.into_iter().zip(gradients);
    pairs.for_each(|(mut variable, gradient)| variable.step(gradient, decay));
}
