//! Fits of the explicit model: the light alone, or with the diffuse albedo.

use super::explicit::ExplicitModel;
use crate::backend::Backend;
use crate::backend::resident::Variable;
use crate::config::{AdamConfig, UnshadeConfig};
use crate::fit::adam::Adam;
use crate::fit::{self, Fit};

/// The light and its distance under an albedo that is held fixed.
pub(super) struct LightFit<'a> {
    pub model: ExplicitModel<'a>,
    /// Logarithm of the radiance, see [`Illuminations`](super::illuminations::Illuminations).
    pub log_light: Vec<f32>,
    /// One value; see [`Transport::nearness_unit`].
    pub relative_nearness: Vec<f32>,
    albedo: &'a [f32],
    light_adam: Adam,
    nearness_adam: Adam,
}

impl<'a> LightFit<'a> {
    /// Starts from a log radiance and a nearness.
    pub fn new(
        model: ExplicitModel<'a>,
        albedo: &'a [f32],
        log_light: Vec<f32>,
        relative_nearness: f32,
    ) -> Self {
        let (adam, config) = (AdamConfig::default(), model.config);
        Self {
            light_adam: Adam::new(&adam, config.rate, log_light.len()),
            nearness_adam: Adam::new(&adam, config.nearness_rate, 1),
            model,
            albedo,
            log_light,
            relative_nearness: vec![relative_nearness],
        }
    }

    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.light_adam.steps()
    }

    /// The loss of the light of another fit.
    pub fn loss_of(&self, other: &Self) -> f64 {
        self.model.gradient(&other.log_light, other.relative_nearness[0], self.albedo).loss
    }

    /// The loss, and its gradients with respect to [`Self::variables`].
    pub fn gradient(&self) -> (f64, Vec<Vec<f32>>) {
        let gradient = self.model.gradient(&self.log_light, self.relative_nearness[0], self.albedo);
        (gradient.loss, vec![gradient.by_log_light, vec![gradient.by_relative_nearness]])
    }

    /// The light and its nearness.
    pub fn variables(&mut self) -> Vec<Variable<'_>> {
        let nearness = Variable::new(&mut self.relative_nearness, &mut self.nearness_adam, 0.0);
        vec![
            Variable::new(&mut self.log_light, &mut self.light_adam, f32::NEG_INFINITY),
            Variable { maximum: self.model.transport.max_relative_nearness(), ..nearness },
        ]
    }

    /// Takes one step by `decay` of the learning rates, and returns the loss before it.
    pub fn step(&mut self, decay: f32) -> f64 {
        let (loss, gradients) = self.gradient();
        fit::step(self.variables(), &gradients, decay);
        loss
    }
}

/// Light and diffuse albedo together. The distance of the light is fitted too if the transport has its derivative.
pub(super) struct JointFit<'a> {
    /// Logarithm of the radiance, see [`Illuminations`](super::illuminations::Illuminations).
    pub log_light: Vec<f32>,
    /// The diffuse albedo, R, G, B per texel of the transport.
    pub albedo: Vec<f32>,
    /// One value: the change of the transport's nearness, see [`Transport::nearness_unit`].
    pub relative_nearness: Vec<f32>,
    model: ExplicitModel<'a>,
    iterations: usize,
    light_adam: Adam,
    albedo_adam: Adam,
    nearness_adam: Adam,
}

impl<'a> JointFit<'a> {
    /// Starts from a log radiance and an albedo.
    pub fn new(
        config: &UnshadeConfig,
        model: ExplicitModel<'a>,
        iterations: usize,
        log_light: Vec<f32>,
        albedo: Vec<f32>,
    ) -> Self {
        let (joint, adam) = (&config.joint, AdamConfig::default());
        Self {
            iterations,
            light_adam: Adam::new(&adam, joint.light_rate, log_light.len()),
            albedo_adam: Adam::new(&adam, joint.albedo_rate, albedo.len()),
            nearness_adam: Adam::new(&adam, config.light.nearness_rate, 1),
            relative_nearness: vec![0.0],
            log_light,
            albedo,
            model,
        }
    }
}

impl Fit for JointFit<'_> {
    fn iterations(&self) -> usize {
        self.iterations
    }

    fn gradient(&self, _: &dyn Backend) -> (f64, Vec<Vec<f32>>) {
        let gradient =
            self.model.gradient(&self.log_light, self.relative_nearness[0], &self.albedo);
        let by_nearness = vec![gradient.by_relative_nearness];
        (gradient.loss, vec![gradient.by_log_light, gradient.by_albedo, by_nearness])
    }

    fn variables(&mut self) -> Vec<Variable<'_>> {
        let transport = self.model.transport;
        let given = transport.nearness_per_metre() / transport.nearness_unit();
        let nearness = Variable::new(&mut self.relative_nearness, &mut self.nearness_adam, -given);
        vec![
            Variable::new(&mut self.log_light, &mut self.light_adam, f32::NEG_INFINITY),
            Variable::new(&mut self.albedo, &mut self.albedo_adam, 0.0),
            Variable { maximum: transport.max_relative_nearness() - given, ..nearness },
        ]
    }
}
