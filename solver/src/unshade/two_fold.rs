//! The light by two-fold cross-validation.
//!
//! A light of many cells can explain skin that is mottled as well as skin that is lit; the number of steps decides
//! which. So it is fitted on either half of the face, a chequerboard of the chart, and validated on the other half. The
//! steps at which both halves together are explained best are the last that carry information on the light: a lamp
//! narrows for hundreds of them, an even sky stops after a few.

use super::explicit::{ExplicitModel, LightFit};
use crate::backend::Backend;
use crate::backend::resident::Variable;
use crate::config::UnshadeConfig;
use crate::fit::Fit;
use crate::model::kept::Kept;
use crate::model::samples::Samples;
use crate::transport::Transport;

/// Fields along a side of the chart.
const FIELDS: usize = 4;
/// Steps between two validations.
const INTERVAL: usize = 10;
/// Steps without a better light after which the fit ends.
const PATIENCE: usize = 60;

/// A light and its nearness by each half of the face, under an albedo that stays.
pub(super) struct TwoFoldLightFit<'a> {
    iterations: usize,
    halves: [LightFit<'a>; 2],
    /// The least validation loss, and the steps after which it was reached.
    best: Vec<f32>,
    /// Both lights and nearnesses of that step.
    lights: [Vec<f32>; 2],
    nearness: Vec<f32>,
}

impl<'a> TwoFoldLightFit<'a> {
    /// From the logarithms of two lights and a nearness in the transport's unit; `model` makes the model of a half.
    pub fn new(
        config: &UnshadeConfig,
        samples: &Samples,
        albedo: &'a [f32],
        lights: &[Vec<f32>; 2],
        nearness: f32,
        iterations: usize,
        model: impl Fn(&Samples, &[f32]) -> ExplicitModel<'a>,
    ) -> Self {
        let parts = halves(config, samples);
        let half = |side: usize| {
            let model = model(&parts[side], &lights[side]);
            LightFit::new(model, albedo, lights[side].clone(), nearness)
        };
        Self {
            iterations,
            halves: [half(0), half(1)],
            best: vec![f32::INFINITY, 0.0],
            lights: lights.clone(),
            nearness: vec![nearness; 2],
        }
    }

    /// The logarithms of both lights at the best step, and their mean nearness in the transport's unit.
    pub fn best(self) -> ([Vec<f32>; 2], f32) {
        (self.lights, self.nearness.iter().sum::<f32>() / self.nearness.len() as f32)
    }

    /// The sum of the losses of either light on the half that it has not seen.
    fn validation_loss(&self) -> f32 {
        let [a, b] = &self.halves;
        (a.loss_of(b) + b.loss_of(a)) as f32
    }
}

/// The samples with weights above 0, divided by their fields; all of them twice if one half has none.
fn halves(config: &UnshadeConfig, samples: &Samples) -> [Samples; 2] {
    let samples = samples.thinned(config.light.samples);
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

/// The mean of two lights, all as logarithms; finite also where both are darker than the least float.
pub(super) fn mean(lights: &[Vec<f32>; 2]) -> Vec<f32> {
    let [a, b] = lights;
    let mean = |(a, b): (&f32, &f32)| a.max(*b) + (0.5 * (1.0 + (-(a - b).abs()).exp())).ln();
    a.iter().zip(b).map(mean).collect()
}

/// The mean absolute difference of the shadings by two lights over their mean.
pub(super) fn half_disagreement(
    transport: &Transport,
    log_lights: &[Vec<f32>; 2],
    nearness: f32,
) -> f32 {
    let [a, b] = log_lights
        .each_ref()
        .map(|log_light| transport.shading_nearer(&super::explicit::exp(log_light), nearness).0);
    let (apart, sum) = a.iter().zip(&b).fold((0.0, 0.0), |(apart, sum), (a, b)| {
        (apart + f64::from((a - b).abs()), sum + f64::from(a + b))
    });
    if sum > 0.0 { (apart / sum) as f32 } else { 0.0 }
}

impl Fit for TwoFoldLightFit<'_> {
    fn iterations(&self) -> usize {
        self.iterations
    }

    fn variables(&mut self) -> Vec<Variable<'_>> {
        self.halves.iter_mut().flat_map(Fit::variables).collect()
    }

    fn gradient(&self, backend: &dyn Backend) -> (f64, Vec<Vec<f32>>) {
        let [a, b] = self.halves.each_ref().map(|half| half.gradient(backend));
        (0.5 * (a.0 + b.0), a.1.into_iter().chain(b.1).collect())
    }

    fn step(&mut self, backend: &dyn Backend, decay: f32) -> f64 {
        if self.halves[0].steps() == 0 {
            self.best[0] = self.validation_loss();
        }
        let losses = self.halves.each_mut().map(|half| half.step(backend, decay));
        if self.halves[0].steps().is_multiple_of(INTERVAL) {
            let loss = self.validation_loss();
            if loss < self.best[0] {
                self.best = vec![loss, self.halves[0].steps() as f32];
                self.lights = self.halves.each_ref().map(|half| half.log_light.clone());
                self.nearness = self.halves.iter().map(|half| half.nearness[0]).collect();
            }
        }
        0.5 * losses.iter().sum::<f64>()
    }

    fn is_converged(&self) -> bool {
        self.halves[0].steps() >= self.best[1] as usize + PATIENCE
    }

    fn memory(&mut self) -> Vec<&mut Vec<f32>> {
        let mut memory = vec![&mut self.best, &mut self.nearness];
        memory.extend(&mut self.lights);
        memory
    }
}
