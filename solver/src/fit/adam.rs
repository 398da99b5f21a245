//! Adam (Kingma and Ba 2015), in the exact form of the framework that the paper uses.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::config::AdamConfig;
use crate::simd::widened;

/// Elements per task.
const CHUNK: usize = 1 << 14;

/// The optimiser of an array of parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Adam {
    config: AdamConfig,
    rate: f32,
    steps: i32,
    first: Vec<f32>,
    second: Vec<f32>,
}

impl Adam {
    /// An optimiser of `count` parameters, with a learning rate.
    pub fn new(config: &AdamConfig, rate: f32, count: usize) -> Self {
        Self {
            config: config.clone(),
            rate,
            steps: 0,
            first: vec![0.0; count],
            second: vec![0.0; count],
        }
    }

    /// The number of steps taken.
    pub fn steps(&self) -> usize {
        self.steps as usize
    }

    /// The configuration.
    pub(crate) fn config(&self) -> &AdamConfig {
        &self.config
    }

    /// Whether the learning rate is above 0.
    pub fn moves(&self) -> bool {
        self.rate != 0.0
    }

    /// A copy without moments, for a device that has its own.
    pub(crate) fn without_moments(&self) -> Self {
        Self {
            config: self.config.clone(),
            rate: self.rate,
            steps: self.steps,
            first: vec![],
            second: vec![],
        }
    }

    /// First and second moment.
    pub(crate) fn moments(&self) -> [&[f32]; 2] {
        [&self.first, &self.second]
    }

    /// Restores the state after `steps` steps of a device.
    pub(crate) fn restore(&mut self, steps: usize, first: Vec<f32>, second: Vec<f32>) {
        (self.steps, self.first, self.second) = (steps as i32, first, second);
    }

    /// The factors on the first moment and on the root of the second moment at step `number`, from 1, with `decay` of
    /// the learning rate.
    pub(crate) fn factors(&self, number: i32, decay: f32) -> [f32; 2] {
        let correction = |beta: f32| 1.0 - f64::from(beta).powi(number);
        let rate = (f64::from(decay * self.rate) / correction(self.config.beta1)) as f32;
        [rate, (1.0 / correction(self.config.beta2).sqrt()) as f32]
    }

    /// Number of parameters.
    pub fn count(&self) -> usize {
        self.first.len()
    }

    /// Takes a step by `decay` of the learning rate. No parameter falls below `minimum`.
    pub fn step(&mut self, parameters: &mut [f32], gradient: &[f32], decay: f32, minimum: f32) {
        let factors = self.next(decay, minimum);
        parameters
            .par_chunks_mut(CHUNK)
            .zip(gradient.par_chunks(CHUNK))
            .zip(self.first.par_chunks_mut(CHUNK).zip(self.second.par_chunks_mut(CHUNK)))
            .for_each(|((parameters, gradient), (first, second))| {
                step(parameters, gradient, first, second, &factors);
            });
    }

    /// Counts a step and returns its factors.
    fn next(&mut self, decay: f32, minimum: f32) -> Factors {
        self.steps += 1;
        let AdamConfig { beta1, beta2, epsilon, .. } = self.config;
        let [rate, root] = self.factors(self.steps, decay);
        Factors { beta1, beta2, epsilon, rate, root, minimum }
    }
}

/// The factors of a step, the same for all elements.
#[derive(Clone, Copy)]
struct Factors {
    beta1: f32,
    beta2: f32,
    epsilon: f32,
    rate: f32,
    root: f32,
    minimum: f32,
}

widened! {
    fn step(parameters: &mut [f32], gradient: &[f32], first: &mut [f32], second: &mut [f32], f: &Factors) {
        let moments = first.iter_mut().zip(second);
        for ((p, g), (m, v)) in parameters.iter_mut().zip(gradient).zip(moments) {
            *m = f.beta1 * *m + (1.0 - f.beta1) * g;
            *v = f.beta2 * *v + (1.0 - f.beta2) * g * g;
            let moved = *p - f.rate * *m / (v.sqrt() * f.root + f.epsilon);
            // Unlike max, this preserves a NaN, so that the loss becomes NaN.
            *p = if moved < f.minimum { f.minimum } else { moved };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reference is three steps of torch.optim.Adam, in f64, operation by operation.
    #[test]
    fn steps_follow_the_published_formula() {
        let config = AdamConfig::default();
        let (mut p, mut m, mut v) = (0.5f64, 0.0f64, 0.0f64);
        let mut adam = Adam::new(&config, 1e-2, 1);
        let mut parameter = [0.5f32];
        for (t, g) in [(1, 0.3), (2, -0.7), (3, 1e-4)] {
            adam.step(&mut parameter, &[g as f32], 1.0, f32::NEG_INFINITY);
            m = 0.9 * m + 0.1 * g;
            v = 0.999 * v + 0.001 * g * g;
            let denominator = v.sqrt() / (1.0 - 0.999f64.powi(t)).sqrt() + 1e-8;
            p -= 1e-2 / (1.0 - 0.9f64.powi(t)) * m / denominator;
            assert!((f64::from(parameter[0]) - p).abs() < 2e-7, "{} {p}", parameter[0]);
        }
    }

    #[test]
    fn the_first_step_is_the_rate_and_the_floor_holds() {
        let mut adam = Adam::new(&AdamConfig::default(), 0.1, 2);
        let mut parameters = [1.0, 0.05];
        adam.step(&mut parameters, &[123.0, 0.001], 1.0, 0.0);
        assert!((parameters[0] - 0.9).abs() < 1e-6, "{}", parameters[0]);
        assert_eq!(parameters[1], 0.0);
    }
}
