//! Heights by Gauss-Newton: one per texel, so that the deviation of the normals is integrable.
//!
//! With light, specular terms and the coarse diffuse albedo held fixed, the pictures are linear in small changes of the
//! normals and of the albedo. The derivatives of shading and highlights with respect to the normal follow from the
//! light. The unknowns are the height h (n_s = n - grad h, n_d the same blurred) and damped relative changes of the
//! diffuse albedo. L1 is minimised by reweighted least squares, with conjugate gradients on the normal equations.

mod agreement;
mod conjugate_gradients;

use capture::gbuffer::{Atlas, GBuffer};
use glam::Vec3;

use super::light::JointEstimate;
use super::lighting::{Lighting, SHADING_ROWS, bent_shading};
use super::linear_colour::{SLOPES, UNKNOWNS, explained, without_diffuse_share};
use super::neighbourhood::{Neighbourhood, RESIDUAL_FLOOR};
use super::relief_highlights::ReliefHighlights;
use super::vectors::add;
use crate::backend::Backend;
use crate::config::ReliefConfig;
use crate::model::blur::Blur;
use crate::model::height::HeightField;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, part, resample};
use crate::run::error::SolveError;
use crate::transport::{CHANNELS, LIGHT_EXPONENT};

/// Standard deviation of the blur between specular and diffuse deviation, over the texture's side.
pub(super) const BLUR: f32 = 0.003;
/// Standard deviation of the blur of the albedo's logarithm, over the texture's side. Its detail may be relief, and is
/// removed.
const ALBEDO_SMOOTHING: f32 = 0.003;
/// Least albedo in a logarithm.
const LEAST_LOG_ALBEDO: f32 = 1e-3;
/// Texels where a unit step of the height would deviate the normal by more than this have no height: the chart is
/// compressed there.
const STEEPEST: f32 = 6.0;
/// Squared norm of the residual over that of the right-hand side at convergence.
const TOLERANCE: f64 = 1e-5;
/// Weight of squared heights, which sets heights without pixels to zero.
const UNSEEN_DAMPING: f32 = 1e-3;

/// The linearised problem.
pub struct HeightProblem<'a> {
    config: &'a ReliefConfig,
    backend: &'a dyn Backend,
    samples: &'a Samples,
    field: HeightField,
    blur: Blur,
    size: usize,
    /// The smoothed diffuse albedo at every sample, R, G, B.
    albedo: Planes,
    /// See [`Lighting::shading_with_derivative`].
    shading_with_derivative: Planes,
    highlights: ReliefHighlights<'a>,
    has_one_illumination: bool,
    /// Conjugate-gradient steps per reweighting.
    steps: usize,
    neighbourhood: Neighbourhood<'a>,
}

impl<'a> HeightProblem<'a> {
    /// Sets up the problem for the `samples` of `views`, whose taps have the size of `atlas`.
    pub(super) fn new(
        config: &'a ReliefConfig,
        backend: &'a dyn Backend,
        samples: &'a Samples,
        views: &'a [GBuffer],
        atlas: &Atlas,
        lighting: &'a Lighting,
        joint: &JointEstimate,
    ) -> Self {
        let (size, coarse) = (atlas.size, lighting.size());
        let smooth = Blur::new(coarse, 3, ALBEDO_SMOOTHING * coarse as f32);
        let logs: Vec<f32> = joint.albedo.iter().map(|a| a.max(LEAST_LOG_ALBEDO).ln()).collect();
        let albedo: Vec<f32> = smooth.apply(&logs).iter().map(|log| log.exp()).collect();
        let albedo = resample(&albedo, coarse, 3, size);
        Self {
            config,
            backend,
            samples,
            field: HeightField::new(atlas, STEEPEST),
            blur: Blur::new(size, 3, BLUR * size as f32),
            size,
            albedo: samples.taps.sample::<CHANNELS>(&albedo),
            shading_with_derivative: lighting.shading_with_derivative(samples),
            highlights: lighting.highlights(backend, &joint.terms, samples, LIGHT_EXPONENT),
            has_one_illumination: lighting.is_one(),
            steps: config.steps,
            neighbourhood: Neighbourhood::new(config, samples, views),
        }
    }

    /// Linearises at the unknowns `x`, [`Self::unknowns`] of them, and updates them. `step` is called before every
    /// conjugate-gradient step with the mean absolute residual at the last reweighting, and may end the solve; every
    /// step reduces the error, so that the unknowns are usable then.
    pub fn minimise(
        &self,
        x: &mut [f32],
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<(), SolveError> {
        let (slopes, target) = self.linearise(x);
        let trust = self.neighbourhood.trust(&slopes, &target);
        (0..self.config.reweightings).try_for_each(|_| {
            let fitted = self.forward(&slopes, &self.sampled(x));
            let (weight, residual) = self.weights(&slopes, &target, &fitted, &trust);
            self.conjugate_gradients(&slopes, &weight, &target, x, residual, step)
        })
    }

    /// The number of unknowns: heights, then changes of the albedo.
    pub fn unknowns(&self) -> usize {
        4 * self.field.len()
    }

    /// The deviation of the normals by the unknowns `x`, 3 channels per texel.
    pub fn deviation(&self, x: &[f32]) -> Vec<f32> {
        self.field.deviation(&x[..self.field.len()])
    }

    /// The slopes at the current normals, and the target colours of the linear model.
    fn linearise(&self, x: &[f32]) -> (Planes, Planes) {
        let samples = self.samples;
        let q = self.sampled(x);
        let highlights = self.highlights.at(samples, &q);
        let slopes = Planes::from_fn(samples.len(), |i| {
            let (albedo, change): ([f32; 3], [f32; 3]) = (self.albedo.sample(i, 0), q.sample(i, 6));
            let derivative: [f32; SHADING_ROWS] = self.shading_with_derivative.sample(i, 0);
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let bent = normal + Vec3::from_array(q.sample(i, 3));
            let length = bent.length();
            let bent = bent / length;
            let shading = bent_shading(&derivative, normal, bent);
            let mut row = [0.0; SLOPES];
            row[..3].copy_from_slice(&highlights.sample::<3>(i, CHANNELS));
            for c in 0..3 {
                let slope = Vec3::from_slice(&derivative[3 + 3 * c..]);
                let slope = (slope - bent * bent.dot(slope)) / length;
                let albedo_now = albedo[c] * (1.0 + change[c]);
                row[3 + 3 * c..6 + 3 * c].copy_from_slice(&(albedo_now * slope).to_array());
                row[12 + c] = albedo[c] * shading[c];
            }
            row
        });
        // The residual of the current unknowns, without components too coarse to be relief.
        let residual = Planes::from_fn(samples.len(), |i| {
            let (target, change): ([f32; 3], [f32; 3]) =
                (samples.target.sample(i, 0), q.sample(i, 6));
            let (diffuse, highlight): ([f32; 3], [f32; 3]) =
                (slopes.sample(i, 12), highlights.sample(i, 0));
            std::array::from_fn::<f32, 3, _>(|c| {
                target[c] - diffuse[c] * (1.0 + change[c]) - highlight[c]
            })
        });
        let fine = self.neighbourhood.without_coarse(&residual);
        let explained = self.forward(&slopes, &q);
        let target = Planes::from_fn(samples.len(), |i| {
            let (fine, explained): ([f32; 3], [f32; 3]) =
                (fine.sample(i, 0), explained.sample(i, 0));
            std::array::from_fn::<f32, 3, _>(|c| fine[c] + explained[c])
        });
        (slopes, target)
    }

    /// The unknowns at every sample: specular and diffuse deviation, change of the albedo.
    fn sampled(&self, x: &[f32]) -> Planes {
        let (height, albedo) = x.split_at(self.size * self.size);
        self.samples.taps.sample::<UNKNOWNS>(&self.texture(&self.field.deviation(height), albedo))
    }

    /// The unknowns of every texel, interleaved; `sharp` is the specular deviation.
    fn texture(&self, sharp: &[f32], albedo: &[f32]) -> Vec<f32> {
        let soft = self.blur.apply(sharp);
        interleave::<UNKNOWNS>(&[(sharp, 3), (&soft, 3), (albedo, 3)])
    }

    fn forward(&self, slopes: &Planes, q: &Planes) -> Planes {
        Planes::from_fn(self.samples.len(), |i| explained(&slopes.sample(i, 0), &q.sample(i, 0)))
    }

    /// The transpose of [`Self::texture`]: gradients with respect to heights and albedo, from those with respect to the
    /// interleaved unknowns. `by_sharp` is added to the gradient with respect to the specular deviation.
    fn transpose_to_unknowns(&self, gathered: &[f32], by_sharp: Option<&[f32]>) -> Vec<f32> {
        let mut sharp = part::<UNKNOWNS, 3>(gathered, 0);
        add(&mut sharp, &self.blur.adjoint(&part::<UNKNOWNS, 3>(gathered, 3)));
        if let Some(by_sharp) = by_sharp {
            add(&mut sharp, by_sharp);
        }
        let mut gradient = self.field.adjoint(&sharp);
        gradient.append(&mut part::<UNKNOWNS, 3>(gathered, 6));
        gradient
    }

    /// The weights of the reweighted least squares, and the mean absolute residual, both
    /// [without the diffuse share](without_diffuse_share).
    fn weights(
        &self,
        slopes: &Planes,
        target: &Planes,
        fitted: &Planes,
        trust: &Planes,
    ) -> (Planes, f64) {
        let floor = RESIDUAL_FLOOR;
        let mean_residual = |i: usize| {
            let (target, fitted): ([f32; 3], [f32; 3]) = (target.sample(i, 0), fitted.sample(i, 0));
            let residual = std::array::from_fn(|c| target[c] - fitted[c]);
            let share = self.config.diffuse_share;
            let residual = without_diffuse_share(residual, &slopes.sample(i, 0), share);
            residual.iter().map(|z| z.abs()).sum::<f32>() / 3.0
        };
        let weight = Planes::from_fn(self.samples.len(), |i| {
            // In units of the floor, so that the weights of the penalties do not depend on it.
            let weight = trust.get(0, i) * self.samples.weight.get(0, i);
            [weight / (3.0 * floor * mean_residual(i).max(floor))]
        });
        let sum: f64 = (0..self.samples.len())
            .map(|i| f64::from(self.samples.weight.get(0, i) * mean_residual(i)))
            .sum();
        (weight, sum / self.samples.len().max(1) as f64)
    }
}
