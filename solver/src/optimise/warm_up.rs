//! The warm-up: networks and albedos together.

use super::adam::Adam;
use super::stage::{Memory, Stage, State, minimum_albedo};
use crate::backend::resident::{Job, Variable};
use crate::backend::{ALBEDOS, Backend};
use crate::config::Config;
use crate::model::normals::DirectionScale;
use crate::model::planes::Planes;
use crate::model::prior::prior;
use crate::model::samples::Samples;
use crate::model::texture::part;

/// Networks and albedos together (section 4.3.1).
pub struct WarmUp<'a> {
    config: &'a Config,
    samples: &'a Samples,
    directions: Planes,
    /// Widths of the networks' layers.
    shape: Vec<usize>,
    networks: Adam,
    diffuse: Adam,
    specular: Adam,
}

impl<'a> WarmUp<'a> {
    /// A warm-up on samples whose taps are of the state's size.
    pub fn new(config: &'a Config, samples: &'a Samples, state: &State) -> Self {
        let (w, adam) = (&config.warm_up, &config.adam);
        Self {
            config,
            samples,
            directions: DirectionScale::from(&config.networks).directions(samples, None),
            shape: state.networks.shape.clone(),
            networks: Adam::new(adam, w.network_rate, state.networks.parameters.len()),
            diffuse: Adam::new(adam, w.diffuse_rate, state.diffuse.len()),
            specular: Adam::new(adam, w.specular_rate, state.specular.len()),
        }
    }

    /// Loss and its gradient.
    pub(super) fn gradient(&self, state: &State, backend: &dyn Backend) -> WarmUpGradient {
        let albedo = state.albedo_texture();
        let joint =
            backend.joint_textures(&state.networks, self.samples, &self.directions, &albedo);
        let mut diffuse = part::<ALBEDOS, 3>(&joint.albedo, 0);
        let specular = part::<ALBEDOS, 1>(&joint.albedo, 3);
        let prior = prior(&state.diffuse, state.size, self.config.warm_up.prior, &mut diffuse);
        WarmUpGradient { loss: joint.loss + prior, networks: joint.networks, diffuse, specular }
    }
}

/// Gradients of the warm-up's loss.
pub(super) struct WarmUpGradient {
    pub loss: f64,
    pub networks: Vec<f32>,
    pub diffuse: Vec<f32>,
    pub specular: Vec<f32>,
}

impl Stage for WarmUp<'_> {
    fn name(&self) -> String {
        "warm-up".to_owned()
    }

    fn iterations(&self) -> usize {
        self.config.warm_up.iterations
    }

    fn step(&mut self, state: &mut State, backend: &dyn Backend, decay: f32) -> f64 {
        let WarmUpGradient { loss, networks, diffuse, specular } = self.gradient(state, backend);
        let gradients = [networks, diffuse, specular];
        self.variables(state).iter_mut().zip(&gradients).for_each(|(v, g)| v.step(g, decay));
        loss
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory::new(vec![&mut self.networks, &mut self.diffuse, &mut self.specular])
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Joint {
            samples: self.samples,
            directions: &self.directions,
            shape: &self.shape,
            prior: self.config.warm_up.prior,
        })
    }

    fn variables<'a>(&'a mut self, state: &'a mut State) -> Vec<Variable<'a>> {
        let (free, minimum) = (f32::NEG_INFINITY, minimum_albedo(self.config));
        vec![
            Variable::new(&mut state.networks.parameters, &mut self.networks, free),
            Variable::new(&mut state.diffuse, &mut self.diffuse, minimum),
            Variable::new(&mut state.specular, &mut self.specular, minimum),
        ]
    }
}
