//! The diffuse albedo alone.

use super::adam::Adam;
use super::stage::{Memory, Stage, State, layers, minimum_albedo};
use crate::backend::Backend;
use crate::backend::resident::{Job, Variable};
use crate::config::Config;
use crate::model::deviation::Deviation;
use crate::model::layer::Layer;
use crate::model::planes::Planes;
use crate::model::prior::prior;
use crate::model::samples::Samples;

/// Diffuse albedo alone, with frozen shading (section 4.3.2).
pub struct Diffuse<'a> {
    config: &'a Config,
    samples: &'a Samples,
    name: String,
    iterations: usize,
    prior: f32,
    layer: Layer,
    by_diffuse: Adam,
}

impl<'a> Diffuse<'a> {
    /// The stage of one round; no network is evaluated after this.
    pub fn new(
        config: &'a Config,
        samples: &'a Samples,
        deviation: &Deviation,
        state: &State,
        backend: &dyn Backend,
        round: usize,
    ) -> Self {
        let layers = layers(samples, deviation, state, backend);
        let shading = Planes::from_fn(samples.len(), |i| {
            let [diffuse, specular] = layers.sample(i, 0);
            [diffuse, diffuse, diffuse, specular]
        });
        let f = &config.fine_tuning;
        let count = 3 * samples.taps.size() * samples.taps.size();
        Self {
            config,
            samples,
            name: format!("diffuse {round}"),
            iterations: f.iterations,
            prior: f.prior,
            layer: Layer::new(samples, &shading),
            by_diffuse: Adam::new(&config.adam, f.diffuse_rate, count),
        }
    }

    /// The refinement under known shading: S_d of every channel, and the specular layer.
    pub fn refinement(config: &'a Config, samples: &'a Samples, shading: &Planes) -> Self {
        let t = &config.transport;
        let count = 3 * samples.taps.size() * samples.taps.size();
        Self {
            config,
            samples,
            name: "albedo".to_owned(),
            iterations: t.refinement,
            prior: t.refinement_prior,
            layer: Layer::new(samples, shading),
            by_diffuse: Adam::new(&config.adam, t.refinement_rate, count),
        }
    }

    /// Loss and its gradient by the diffuse albedo.
    pub(super) fn gradient(&self, state: &State) -> (f64, Vec<f32>) {
        let (loss, mut by_diffuse) = self.layer.gradient(self.samples, &state.diffuse);
        let prior = prior(&state.diffuse, state.size, self.prior, &mut by_diffuse);
        (loss + prior, by_diffuse)
    }
}

impl Stage for Diffuse<'_> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn step(&mut self, state: &mut State, _backend: &dyn Backend, decay: f32) -> f64 {
        let (loss, by_diffuse) = self.gradient(state);
        self.by_diffuse.step(&mut state.diffuse, &by_diffuse, decay, minimum_albedo(self.config));
        loss
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory::new(vec![&mut self.by_diffuse])
    }

    fn job(&self) -> Option<Job<'_>> {
        let samples = self.samples;
        let known = Planes::from_fn(samples.len(), |i| {
            let [factor, target] = self.layer.known(i);
            let [r, g, b] = (target - factor.w).truncate().to_array();
            [r, g, b, target.w, factor.x, factor.y, factor.z]
        });
        Some(Job::Layer { taps: &samples.taps, known, prior: self.prior })
    }

    fn variables<'a>(&'a mut self, state: &'a mut State) -> Vec<Variable<'a>> {
        let minimum = minimum_albedo(self.config);
        vec![Variable::new(&mut state.diffuse, &mut self.by_diffuse, minimum)]
    }
}
