//! The optimised state, and the stages of the optimisation: a stage owns its optimisers and the values that stay
//! fixed while it runs; another update of the state is another stage.

use serde::{Deserialize, Serialize};

use super::adam::Adam;
use crate::backend::resident::{Job, Variable};
use crate::backend::{ALBEDOS, Backend};
use crate::config::Config;
use crate::model::deviation::Deviation;
use crate::model::deviation_textures::{BLURRED, SPECULAR};
use crate::model::networks::Networks;
use crate::model::normals::Deviations;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, resample};

/// Everything that is being solved for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// The shading networks.
    pub networks: Networks,
    /// Side of the textures, texels.
    pub size: usize,
    /// R, G, B per texel; its scale is that of 1 / S_d.
    pub diffuse: Vec<f32>,
    /// One value per texel; its scale is that of 1 / S_s.
    pub specular: Vec<f32>,
    /// The texture t that [`Deviation`] makes the deviation from the mesh normal of; x, y, z per texel. Where heights
    /// are solved for, that is the deviation itself, before and after; else it is what tanh is taken of.
    pub deviation: Vec<f32>,
}

impl State {
    /// Brings the textures to another size.
    pub fn resize(&mut self, size: usize) {
        if size == self.size {
            return;
        }
        self.diffuse = resample(&self.diffuse, self.size, 3, size);
        self.specular = resample(&self.specular, self.size, 1, size);
        self.deviation = resample(&self.deviation, self.size, 3, size);
        self.size = size;
    }

    /// Diffuse and specular albedo at every sample.
    pub fn albedo(&self, samples: &Samples) -> Planes {
        samples.taps.sample_vectors(&self.albedo_texture())
    }

    /// Diffuse and specular albedo, texel by texel.
    pub(super) fn albedo_texture(&self) -> Vec<f32> {
        interleave::<ALBEDOS>(&[(&self.diffuse, 3), (&self.specular, 1)])
    }
}

/// One stage: a number of full-batch steps on some part of the state.
pub trait Stage {
    /// For progress and record.
    fn name(&self) -> String;
    /// How many steps.
    fn iterations(&self) -> usize;
    /// One step, by `decay` of the learning rates; the loss before it.
    fn step(&mut self, state: &mut State, backend: &dyn Backend, decay: f32) -> f64;
    /// Whether more steps lead nowhere; asked before each.
    fn is_over(&self) -> bool {
        false
    }
    /// For checkpoints: with the state, all that is needed to go on with the same bits.
    fn memory(&mut self) -> Memory<'_>;
    /// For a device that may take the stage in; nothing if there is no program for it.
    fn job(&self) -> Option<Job<'_>> {
        None
    }
    /// The variables, in the order that the job says.
    fn variables<'a>(&'a mut self, _state: &'a mut State) -> Vec<Variable<'a>> {
        vec![]
    }
}

/// The memory of a stage from step to step besides the state, in a fixed order.
#[derive(Serialize)]
pub struct Memory<'a> {
    /// Moments and step counts of the optimisers.
    pub optimisers: Vec<&'a mut Adam>,
    /// Parameters of its own.
    pub own: Vec<&'a mut Vec<f32>>,
}

impl<'a> Memory<'a> {
    /// The memory of a stage without parameters of its own.
    pub fn new(optimisers: Vec<&'a mut Adam>) -> Self {
        Self { optimisers, own: vec![] }
    }
}

/// The diffuse shading S_d and the specular layer F A_s S_s at every sample.
pub fn layers(
    samples: &Samples,
    deviation: &Deviation,
    state: &State,
    backend: &dyn Backend,
) -> Planes {
    let bent = deviation.packed(&state.deviation, &state.specular).sample(&samples.taps);
    let deviations = Deviations { planes: &bent, blurred: BLURRED };
    let directions = deviation.scale.directions(samples, Some(deviations));
    let light = backend.light(&state.networks, &samples.position);
    let shading = backend.shade(&state.networks, &light, &directions);
    Planes::from_fn(samples.len(), |i| {
        let [diffuse, specular] = shading.sample(i, 0);
        [diffuse, samples.fresnel.get(0, i) * bent.get(SPECULAR, i) * specular]
    })
}

/// The least that an optimiser leaves of an albedo.
pub(super) fn minimum_albedo(config: &Config) -> f32 {
    if config.rendering.positive_albedo { 0.0 } else { f32::NEG_INFINITY }
}
