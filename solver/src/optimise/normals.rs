//! The paper's normals: a deviation texture, moved with the specular albedo.

use super::adam::Adam;
use super::stage::{Memory, Stage, State, minimum_albedo};
use crate::backend::resident::{Job, NormalsJob, Variable};
use crate::backend::{Backend, TexturedNormals};
use crate::config::Config;
use crate::model::deviation::{Deviation, TextureGradients};
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// Specular albedo and deviation, with frozen networks and diffuse albedo (section 4.3.2).
pub struct Normals<'a> {
    config: &'a Config,
    samples: &'a Samples,
    deviation: &'a Deviation,
    name: String,
    networks: Networks,
    light: Planes,
    albedo: Planes,
    by_deviation: Adam,
    by_specular: Adam,
}

impl<'a> Normals<'a> {
    /// The stage of one round; L(p) and the diffuse albedo are evaluated once.
    pub fn new(
        config: &'a Config,
        samples: &'a Samples,
        deviation: &'a Deviation,
        state: &State,
        backend: &dyn Backend,
        round: usize,
    ) -> Self {
        let (f, adam) = (&config.fine_tuning, &config.adam);
        Self {
            config,
            samples,
            deviation,
            name: format!("normals and specular {round}"),
            networks: state.networks.clone(),
            light: backend.light(&state.networks, &samples.position),
            albedo: state.albedo(samples),
            by_deviation: Adam::new(adam, f.deviation_rate, state.deviation.len()),
            by_specular: Adam::new(adam, f.specular_rate, state.specular.len()),
        }
    }

    /// Loss, and its gradients by deviation and specular albedo.
    pub(super) fn gradient(&self, state: &State, backend: &dyn Backend) -> (f64, TextureGradients) {
        let textures = self.deviation.packed(&state.deviation, &state.specular);
        let textured = TexturedNormals {
            networks: &state.networks,
            samples: self.samples,
            light: &self.light,
            albedo: &self.albedo,
            scale: &self.deviation.scale,
            textures: &textures,
        };
        let (loss, gradient) = backend.deviation_gradient(&textured);
        (loss, self.deviation.adjoint(&textures, &gradient))
    }
}

impl Stage for Normals<'_> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn iterations(&self) -> usize {
        self.config.fine_tuning.iterations
    }

    fn step(&mut self, state: &mut State, backend: &dyn Backend, decay: f32) -> f64 {
        let (loss, TextureGradients { deviation, specular }) = self.gradient(state, backend);
        let gradients = [deviation, specular];
        self.variables(state).iter_mut().zip(&gradients).for_each(|(v, g)| v.step(g, decay));
        loss
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory::new(vec![&mut self.by_deviation, &mut self.by_specular])
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Normals(NormalsJob {
            samples: self.samples,
            deviation: self.deviation,
            networks: &self.networks,
            light: &self.light,
            albedo: &self.albedo,
        }))
    }

    fn variables<'a>(&'a mut self, state: &'a mut State) -> Vec<Variable<'a>> {
        let minimum = minimum_albedo(self.config);
        vec![
            Variable::new(&mut state.deviation, &mut self.by_deviation, f32::NEG_INFINITY),
            Variable::new(&mut state.specular, &mut self.by_specular, minimum),
        ]
    }
}
