//! The fit of the diffuse albedo under fixed shading.

use super::Fit;
use super::adam::Adam;
use crate::backend::Backend;
use crate::backend::resident::{Job, Variable};
use crate::model::layer::Layer;
use crate::model::planes::Planes;
use crate::model::prior::albedo_prior;
use crate::model::samples::Samples;

/// The fit of the diffuse albedo alone. The model is linear in it, so the shading is evaluated once.
pub struct AlbedoFit<'a> {
    /// The parameters: R, G, B per texel of the samples' texture.
    pub albedo: Vec<f32>,
    samples: &'a Samples,
    iterations: usize,
    prior_weight: f32,
    minimum: f32,
    layer: Layer,
    albedo_adam: Adam,
}

/// The settings of an [`AlbedoFit`].
#[derive(Clone, Copy, Debug)]
pub struct AlbedoSteps {
    /// Full-batch steps.
    pub iterations: usize,
    /// Weight of the albedo prior.
    pub prior_weight: f32,
    /// The least albedo after a step.
    pub minimum: f32,
}

impl<'a> AlbedoFit<'a> {
    /// Starts from an albedo; `shading` has S_d of R, G and B, and the specular layer, at every sample.
    pub fn new(
        steps: AlbedoSteps,
        albedo_adam: Adam,
        samples: &'a Samples,
        shading: &Planes,
        albedo: Vec<f32>,
    ) -> Self {
        let AlbedoSteps { iterations, prior_weight, minimum } = steps;
        let layer = Layer::new(samples, shading);
        Self { albedo, samples, iterations, prior_weight, minimum, layer, albedo_adam }
    }
}

impl Fit for AlbedoFit<'_> {
    fn iterations(&self) -> usize {
        self.iterations
    }

    fn gradient(&self, _backend: &dyn Backend) -> (f64, Vec<Vec<f32>>) {
        let (loss, mut by_albedo) = self.layer.gradient(self.samples, &self.albedo);
        let (size, weight) = (self.samples.taps.size(), self.prior_weight);
        let penalty = albedo_prior(&self.albedo, size, weight, &mut by_albedo);
        (loss + penalty, vec![by_albedo])
    }

    fn job(&self) -> Option<Job<'_>> {
        let samples = self.samples;
        let known = Planes::from_fn(samples.len(), |i| {
            let [factor, target] = self.layer.known(i);
            let [r, g, b] = (target - factor.w).truncate().to_array();
            [r, g, b, target.w, factor.x, factor.y, factor.z]
        });
        Some(Job::Layer { taps: &samples.taps, known, prior: self.prior_weight })
    }

    fn variables(&mut self) -> Vec<Variable<'_>> {
        vec![Variable::new(&mut self.albedo, &mut self.albedo_adam, self.minimum)]
    }
}
