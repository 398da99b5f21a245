//! The light by two-fold cross-validation.
//!
//! A light of many cells can explain mottled skin as well as shading; the number of steps decides which. Therefore one
//! light is fitted to each fold of the face, the two colours of a chequerboard on the chart, and validated on the other
//! fold. The fit stops at the least validation loss: a lamp keeps narrowing for hundreds of steps, a uniform sky
//! overfits after a few.

use super::explicit::{ExplicitModel, exp};
use super::explicit_fits::LightFit;
use super::illuminations::Illuminations;
use crate::backend::Backend;
use crate::backend::resident::Variable;
use crate::config::UnshadeConfig;
use crate::fit::Fit;
use crate::model::kept::Kept;
use crate::model::samples::Samples;
use crate::transport::Transport;

/// Fields of the chequerboard along a side of the chart.
const FIELDS_PER_SIDE: usize = 4;
/// Steps between two validations.
const INTERVAL: usize = 10;
/// Steps without a lower validation loss after which the fit ends.
const PATIENCE: usize = 60;

/// A light and its nearness for each fold of the face, under an albedo that is held fixed.
pub(super) struct TwoFoldLightFit<'a> {
    iterations: usize,
    folds: [LightFit<'a>; 2],
    /// The least validation loss, and the number of steps before it.
    least_validation: Vec<f32>,
    /// The log radiances and relative nearnesses of both folds at the least validation loss.
    best_lights: [Vec<f32>; 2],
    best_nearness: Vec<f32>,
}

impl<'a> TwoFoldLightFit<'a> {
    /// Starts from the log radiances of both folds and one relative nearness; `model` returns the model of a fold.
    pub fn new(
        config: &UnshadeConfig,
        samples: &Samples,
        albedo: &'a [f32],
        log_lights: &[Vec<f32>; 2],
        relative_nearness: f32,
        iterations: usize,
        model: impl Fn(&Samples, &[f32]) -> ExplicitModel<'a>,
    ) -> Self {
        let samples = folds(config, samples);
        let fit = |fold: usize| {
            let model = model(&samples[fold], &log_lights[fold]);
            LightFit::new(model, albedo, log_lights[fold].clone(), relative_nearness)
        };
        Self {
            iterations,
            folds: [fit(0), fit(1)],
            least_validation: vec![f32::INFINITY, 0.0],
            best_lights: log_lights.clone(),
            best_nearness: vec![relative_nearness; 2],
        }
    }

    /// Returns the log radiances at the least validation loss, and their mean relative nearness.
    pub fn into_best(self) -> ([Vec<f32>; 2], f32) {
        let nearness = self.best_nearness;
        (self.best_lights, nearness.iter().sum::<f32>() / nearness.len() as f32)
    }

    /// The sum of the losses of each light on the other fold.
    fn validation_loss(&self) -> f32 {
        let [a, b] = &self.folds;
        (a.loss_of(b) + b.loss_of(a)) as f32
    }
}

/// Returns the samples with weights above 0 of each fold; if a fold has none, all samples twice.
fn folds(config: &UnshadeConfig, samples: &Samples) -> [Samples; 2] {
    let samples = samples.thinned(config.light.samples);
    let (size, field) = (samples.taps.size(), samples.taps.size().div_ceil(FIELDS_PER_SIDE));
    let counts = |i: usize| samples.weight.get(0, i) > 0.0;
    let fold_of = |i: usize| {
        let texel = samples.taps.nearest(i);
        (texel / size / field + texel % size / field) % 2
    };
    let folds = [0, 1].map(|fold| Kept::those(samples.len(), |i| counts(i) && fold_of(i) == fold));
    let has_empty_fold = folds.iter().any(Kept::is_empty);
    folds.map(|fold| if has_empty_fold { samples.clone() } else { samples.kept(&fold) })
}

/// The logarithm of the mean of two lights, from their logarithms; finite even where both radiances underflow.
pub(super) fn mean(log_lights: &[Vec<f32>; 2]) -> Vec<f32> {
    let [a, b] = log_lights;
    let mean = |(a, b): (&f32, &f32)| a.max(*b) + (0.5 * (1.0 + (-(a - b).abs()).exp())).ln();
    a.iter().zip(b).map(mean).collect()
}

/// The mean absolute deviation of the shadings by two lights from their mean, over that mean, under all illuminations
/// of training views.
pub(super) fn fold_disagreement(
    transport: &Transport,
    illuminations: &Illuminations,
    log_lights: &[Vec<f32>; 2],
    relative_nearness: f32,
) -> f32 {
    let lights = log_lights.each_ref().map(|log_light| exp(log_light));
    let (mut difference, mut sum) = (0.0, 0.0);
    for illumination in 0..illuminations.trained() {
        let [a, b] = lights.each_ref().map(|light| {
            let light = illuminations.light(light, illumination, relative_nearness);
            transport.shading_nearer(&light, relative_nearness).0
        });
        for (a, b) in a.iter().zip(&b) {
            difference += f64::from((a - b).abs());
            sum += f64::from(a + b);
        }
    }
    if sum > 0.0 { (difference / sum) as f32 } else { 0.0 }
}

impl Fit for TwoFoldLightFit<'_> {
    fn iterations(&self) -> usize {
        self.iterations
    }

    fn variables(&mut self) -> Vec<Variable<'_>> {
        self.folds.iter_mut().flat_map(LightFit::variables).collect()
    }

    fn gradient(&self, _: &dyn Backend) -> (f64, Vec<Vec<f32>>) {
        let [a, b] = self.folds.each_ref().map(LightFit::gradient);
        (0.5 * (a.0 + b.0), a.1.into_iter().chain(b.1).collect())
    }

    fn step(&mut self, _: &dyn Backend, decay: f32) -> f64 {
        if self.folds[0].steps() == 0 {
            self.least_validation[0] = self.validation_loss();
        }
        let losses = self.folds.each_mut().map(|fold| fold.step(decay));
        if self.folds[0].steps().is_multiple_of(INTERVAL) {
            let loss = self.validation_loss();
            if loss < self.least_validation[0] {
                self.least_validation = vec![loss, self.folds[0].steps() as f32];
                self.best_lights = self.folds.each_ref().map(|fold| fold.log_light.clone());
                self.best_nearness =
                    self.folds.iter().map(|fold| fold.relative_nearness[0]).collect();
            }
        }
        0.5 * losses.iter().sum::<f64>()
    }

    fn is_converged(&self) -> bool {
        self.folds[0].steps() >= self.least_validation[1] as usize + PATIENCE
    }

    fn memory(&mut self) -> Vec<&mut Vec<f32>> {
        let mut memory = vec![&mut self.least_validation, &mut self.best_nearness];
        memory.extend(&mut self.best_lights);
        memory
    }
}
