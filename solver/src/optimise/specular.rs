//! The specular albedo alone, where the normals stay.

use super::adam::Adam;
use super::stage::{Memory, Stage, State, layers, minimum_albedo};
use crate::backend::Backend;
use crate::backend::resident::{Job, Variable};
use crate::config::Config;
use crate::model::deviation::Deviation;
use crate::model::planes::{BLOCK, Planes, Row};
use crate::model::samples::Samples;
use crate::simd::widened;

/// Specular albedo alone, with frozen networks, normals and diffuse albedo: the model is linear in it,
/// so that no network is evaluated after the first step.
pub struct Specular<'a> {
    config: &'a Config,
    samples: &'a Samples,
    name: String,
    /// The target less the diffuse layer (3 rows), F S_s, and the weight.
    rest: Planes,
    by_specular: Adam,
}

impl<'a> Specular<'a> {
    /// The stage of one round.
    pub fn new(
        config: &'a Config,
        samples: &'a Samples,
        deviation: &Deviation,
        state: &State,
        backend: &dyn Backend,
        round: usize,
    ) -> Self {
        // With a white specular albedo, the specular layer is F S_s.
        let white = vec![1.0; state.specular.len()];
        let layers =
            layers(samples, deviation, &State { specular: white, ..state.clone() }, backend);
        let albedo = samples.taps.sample::<3>(&state.diffuse);
        let rest = Planes::from_fn(samples.len(), |i| {
            let [shading, specular_shading]: [f32; 2] = layers.sample(i, 0);
            let (albedo, target): ([f32; 3], [f32; 3]) =
                (albedo.sample(i, 0), samples.target.sample(i, 0));
            let [r, g, b]: [f32; 3] = std::array::from_fn(|c| target[c] - albedo[c] * shading);
            [r, g, b, specular_shading, samples.weight.get(0, i)]
        });
        let rate = config.fine_tuning.specular_rate;
        Self {
            config,
            samples,
            name: format!("specular {round}"),
            rest,
            by_specular: Adam::new(&config.adam, rate, state.specular.len()),
        }
    }
}

impl Stage for Specular<'_> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn iterations(&self) -> usize {
        self.config.fine_tuning.iterations
    }

    fn step(&mut self, state: &mut State, _backend: &dyn Backend, decay: f32) -> f64 {
        let scale = 1.0 / (3.0 * self.samples.len() as f32);
        let value = |block: usize, albedo: &[Row; 1], gradient: &mut [Row; 1], loss: &mut Row| {
            specular_block(self.rest.rows_of(block), scale, albedo, gradient, loss);
        };
        let (gradient, sum) = self.samples.taps.exchange(&state.specular, value);
        self.by_specular.step(&mut state.specular, &gradient, decay, minimum_albedo(self.config));
        sum * f64::from(scale)
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory::new(vec![&mut self.by_specular])
    }

    fn job(&self) -> Option<Job<'_>> {
        let known = Planes::from_fn(self.samples.len(), |i| {
            let [r, g, b, specular_shading, weight]: [f32; 5] = self.rest.sample(i, 0);
            [r, g, b, weight, specular_shading]
        });
        Some(Job::Layer { taps: &self.samples.taps, known, prior: 0.0 })
    }

    fn variables<'a>(&'a mut self, state: &'a mut State) -> Vec<Variable<'a>> {
        let minimum = minimum_albedo(self.config);
        vec![Variable::new(&mut state.specular, &mut self.by_specular, minimum)]
    }
}

widened! {
    fn specular_block(
        rest: &[Row; 5],
        scale: f32,
        albedo: &[Row; 1],
        gradient: &mut [Row; 1],
        loss: &mut Row,
    ) {
        let [r, g, b, specular_shading, weight] = rest;
        for lane in 0..BLOCK {
            let highlight = albedo[0].0[lane] * specular_shading.0[lane];
            let (mut signs, mut sum) = (0.0, 0.0);
            for rest in [r, g, b] {
                let residual = highlight - rest.0[lane];
                signs += if residual == 0.0 { 0.0 } else { 1.0f32.copysign(residual) };
                sum += residual.abs();
            }
            loss.0[lane] = weight.0[lane] * sum;
            gradient[0].0[lane] = weight.0[lane] * scale * signs * specular_shading.0[lane];
        }
    }
}
