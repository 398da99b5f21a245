//! How far the light follows the pictures: as far as it explains those that it has not seen.
//!
//! A light of many cells can explain skin that is mottled as well as skin that is lit, and only how long it is sought
//! says which. So it is sought on either half of the face, a chequerboard of the chart, and judged by the other half.
//! The steps at which both halves together are explained best are the last that tell of light: a lamp goes on to
//! narrow for hundreds of them, an even sky is left alone after a few.

use super::highlights::{Found, Highlights};
use super::stage::{Memory, Stage, State};
use crate::backend::Backend;
use crate::config::{Config, TransportConfig};
use crate::model::kept::Kept;
use crate::model::samples::Samples;
use crate::transport::Transport;

/// Fields along a side of the chart.
const FIELDS: usize = 4;
/// Steps after which the halves judge each other.
const EACH: usize = 10;
/// Steps without a better light after which none is sought any more.
const PATIENCE: usize = 60;

/// A light and its nearness by each half, the albedo held.
pub(super) struct Halves<'a> {
    name: String,
    iterations: usize,
    halves: [Highlights<'a>; 2],
    /// As they were when they were best: their loss on each other, and after how many steps.
    least: Vec<f32>,
    lights: [Vec<f32>; 2],
    nearness: Vec<f32>,
}

impl<'a> Halves<'a> {
    /// From the lights that are known, their logarithms; see [`Highlights::new`].
    pub fn new(
        config: &'a Config,
        transport: &'a Transport,
        samples: &Samples,
        state: &State,
        found: [Found; 2],
        name: String,
        iterations: usize,
    ) -> Option<Self> {
        let halves = halves(&config.transport, samples);
        let half = |side: usize| {
            let rate = config.transport.distance_rate;
            let half = Highlights::new(config, transport, &halves[side], state, found[side])?;
            Some(half.of_light_alone(rate))
        };
        let halves = [half(0)?, half(1)?];
        let lights = [0, 1].map(|side: usize| found[side].log_light.to_vec());
        let nearness = halves.iter().map(|half| half.nearness[0]).collect();
        Some(Self { name, iterations, halves, least: vec![f32::INFINITY, 0.0], lights, nearness })
    }

    /// The logarithms of both lights where they were best, and how near they are in the transport's unit.
    pub fn best(self) -> ([Vec<f32>; 2], f32) {
        (self.lights, self.nearness.iter().sum::<f32>() / self.nearness.len() as f32)
    }

    /// The loss of either light on the half that it has not seen.
    fn judged(&mut self, state: &State) -> f32 {
        let exchange = |[a, b]: &mut [Highlights; 2]| {
            std::mem::swap(&mut a.log_light, &mut b.log_light);
            std::mem::swap(&mut a.nearness, &mut b.nearness);
        };
        exchange(&mut self.halves);
        let losses = self.halves.iter().map(|half| half.gradient(state).loss);
        let sum = losses.sum::<f64>() as f32;
        exchange(&mut self.halves);
        sum
    }
}

/// The samples that count, parted by the fields that they lie in; all of them twice if one half has none.
fn halves(config: &TransportConfig, samples: &Samples) -> [Samples; 2] {
    let samples = samples.thinned(config.highlight_samples);
    let (size, field) = (samples.taps.size(), samples.taps.size().div_ceil(FIELDS));
    let counts = |i: usize| samples.weight.get(0, i) > 0.0;
    let side = |i: usize| {
        let texel = samples.taps.nearest(i);
        (texel / size / field + texel % size / field) % 2
    };
    let parts = [0, 1].map(|half| Kept::those(samples.len(), |i| counts(i) && side(i) == half));
    let either = parts.iter().any(Kept::is_empty);
    parts.map(|part| if either { samples.clone() } else { samples.kept(&part) })
}

/// The mean of two lights, all as logarithms; finite also where both are darker than a float can say.
pub(super) fn mean(lights: &[Vec<f32>; 2]) -> Vec<f32> {
    let [a, b] = lights;
    let mean = |(a, b): (&f32, &f32)| a.max(*b) + (0.5 * (1.0 + (-(a - b).abs()).exp())).ln();
    a.iter().zip(b).map(mean).collect()
}

impl Stage for Halves<'_> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn step(&mut self, state: &mut State, backend: &dyn Backend, decay: f32) -> f64 {
        if self.halves[0].steps() == 0 {
            self.least[0] = self.judged(state);
        }
        let losses = self.halves.each_mut().map(|half| half.step(state, backend, decay));
        if self.halves[0].steps().is_multiple_of(EACH) {
            let loss = self.judged(state);
            if loss < self.least[0] {
                self.least = vec![loss, self.halves[0].steps() as f32];
                self.lights = self.halves.each_ref().map(|half| half.log_light.clone());
                self.nearness = self.halves.iter().map(|half| half.nearness[0]).collect();
            }
        }
        0.5 * losses.iter().sum::<f64>()
    }

    fn is_over(&self) -> bool {
        self.halves[0].steps() >= self.least[1] as usize + PATIENCE
    }

    fn memory(&mut self) -> Memory<'_> {
        let mut optimisers = vec![];
        let mut own = vec![&mut self.least, &mut self.nearness];
        own.extend(&mut self.lights);
        for half in &mut self.halves {
            let memory = half.memory();
            optimisers.extend(memory.optimisers);
            own.extend(memory.own);
        }
        Memory { optimisers, own }
    }
}
