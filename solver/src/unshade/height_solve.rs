//! Heights by Gauss-Newton: one per texel, so that the deviation of the normals is integrable.
//!
//! With light, specular terms and the coarse diffuse albedo held fixed, the pictures are linear in small changes of the
//! normals and of the albedo. The change of shading and highlights with the normal follows from the light. Unknown are
//! the height h (n_s = n - grad h, n_d the same blurred) and damped relative changes of the diffuse albedo; L1 by
//! reweighting, conjugate gradients on the normal equations; linearised anew on every texture, coarse to fine.

mod agreement;
mod conjugate_gradients;

use capture::gbuffer::{Atlas, GBuffer};
use glam::Vec3;

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
use crate::transport::CHANNELS;

/// Standard deviation of the blur between specular and diffuse deviation, over the texture's side.
pub(super) const BLUR: f32 = 0.003;
/// Standard deviation of the blur that takes detail out of the albedo's logarithm, over the texture's side: relief
/// must not be in it already.
const ALBEDO_SMOOTHING: f32 = 0.003;
/// Darkest albedo of a logarithm.
const DARKEST_ALBEDO: f32 = 1e-3;
/// Texels in which a unit step of the height would turn the normal by more than this have no height: the chart is
/// squeezed there.
const STEEPEST: f32 = 6.0;
/// Squared norm of the residual over that of the right-hand side at which a solve has converged.
const TOLERANCE: f64 = 1e-5;
/// Weight of squared heights, which pulls those to zero that no pixel sees.
const UNSEEN_DAMPING: f32 = 1e-3;

/// The linearised problem.
pub struct HeightSolve<'a> {
    config: &'a ReliefConfig,
    backend: &'a dyn Backend,
    samples: &'a Samples,
    field: HeightField,
    blur: Blur,
    size: usize,
    /// Sampled diffuse albedo without detail, R, G, B.
    albedo: Planes,
    /// S_d, and its change with the normal.
    lighting: Planes,
    highlights: ReliefHighlights<'a>,
    /// Conjugate-gradient steps per reweighting.
    steps: usize,
    neighbourhood: Neighbourhood<'a>,
}

impl<'a> HeightSolve<'a> {
    /// `samples` are those of `views`, with taps of the side of `atlas`.
    pub(super) fn new(
        config: &'a ReliefConfig,
        backend: &'a dyn Backend,
        samples: &'a Samples,
        views: &'a [GBuffer],
        atlas: &Atlas,
        lighting: &Lighting,
        highlights: ReliefHighlights<'a>,
    ) -> Self {
        let (size, coarse) = (atlas.size, lighting.size());
        let smooth = Blur::new(coarse, 3, ALBEDO_SMOOTHING * coarse as f32);
        let logs: Vec<f32> = lighting.albedo.iter().map(|a| a.max(DARKEST_ALBEDO).ln()).collect();
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
            lighting: lighting.sampled(samples),
            highlights,
            steps: config.steps_on(size),
            neighbourhood: Neighbourhood::new(config, samples, views),
        }
    }

    /// Linearises at the unknowns `x`, [`Self::unknowns`] of them, and moves them; `step` hears of every
    /// conjugate-gradient step with the mean absolute residual at the last linearisation, and may stop the
    /// solve: every step leaves heights that explain more than those before it.
    pub fn solve(
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

    /// Heights, then changes of the albedo.
    pub fn unknowns(&self) -> usize {
        4 * self.field.len()
    }

    /// The deviation of the normals by the unknowns `x`, 3 channels per texel.
    pub fn deviation(&self, x: &[f32]) -> Vec<f32> {
        self.field.deviation(&x[..self.field.len()])
    }

    /// Slopes at the current normals, and the colours that the linear model is to reach.
    fn linearise(&self, x: &[f32]) -> (Planes, Planes) {
        let samples = self.samples;
        let q = self.sampled(x);
        let highlights = self.highlights.at(samples, &q);
        let slopes = Planes::from_fn(samples.len(), |i| {
            let (albedo, change): ([f32; 3], [f32; 3]) = (self.albedo.sample(i, 0), q.sample(i, 6));
            let lighting: [f32; SHADING_ROWS] = self.lighting.sample(i, 0);
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let bent = normal + Vec3::from_array(q.sample(i, 3));
            let length = bent.length();
            let bent = bent / length;
            let shading = bent_shading(&lighting, normal, bent);
            let mut row = [0.0; SLOPES];
            row[..3].copy_from_slice(&highlights.sample::<3>(i, CHANNELS));
            for c in 0..3 {
                let slope = Vec3::from_slice(&lighting[3 + 3 * c..]);
                let slope = (slope - bent * bent.dot(slope)) / length;
                let albedo_now = albedo[c] * (1.0 + change[c]);
                row[3 + 3 * c..6 + 3 * c].copy_from_slice(&(albedo_now * slope).to_array());
                row[12 + c] = albedo[c] * shading[c];
            }
            row
        });
        // What the current unknowns leave, without what is too coarse to be relief.
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

    /// The unknowns at every sample: both deviations, change of the albedo.
    fn sampled(&self, x: &[f32]) -> Planes {
        let (height, albedo) = x.split_at(self.size * self.size);
        self.samples.taps.sample::<UNKNOWNS>(&self.texture(&self.field.deviation(height), albedo))
    }

    /// The unknowns of every texel, interleaved; `sharp` is the deviation.
    fn texture(&self, sharp: &[f32], albedo: &[f32]) -> Vec<f32> {
        let soft = self.blur.apply(sharp);
        interleave::<UNKNOWNS>(&[(sharp, 3), (&soft, 3), (albedo, 3)])
    }

    fn forward(&self, slopes: &Planes, q: &Planes) -> Planes {
        Planes::from_fn(self.samples.len(), |i| explained(&slopes.sample(i, 0), &q.sample(i, 0)))
    }

    /// Carries gradients by the interleaved unknowns, with `by_sharp` more by the deviation, to heights
    /// and albedo: the transpose of [`Self::texture`].
    fn carried(&self, gathered: &[f32], by_sharp: Option<&[f32]>) -> Vec<f32> {
        let mut sharp = part::<UNKNOWNS, 3>(gathered, 0);
        add(&mut sharp, &self.blur.adjoint(&part::<UNKNOWNS, 3>(gathered, 3)));
        if let Some(more) = by_sharp {
            add(&mut sharp, more);
        }
        let mut gradient = self.field.adjoint(&sharp);
        gradient.append(&mut part::<UNKNOWNS, 3>(gathered, 6));
        gradient
    }

    /// Weights of the reweighted least squares, and the mean absolute residual, [without the diffuse share](without_diffuse_share).
    fn weights(
        &self,
        slopes: &Planes,
        target: &Planes,
        fitted: &Planes,
        trust: &Planes,
    ) -> (Planes, f64) {
        let floor = RESIDUAL_FLOOR;
        let size = |i: usize| {
            let (target, fitted): ([f32; 3], [f32; 3]) = (target.sample(i, 0), fitted.sample(i, 0));
            let left = std::array::from_fn(|c| target[c] - fitted[c]);
            let left = without_diffuse_share(left, &slopes.sample(i, 0), self.config.diffuse_share);
            left.iter().map(|z| z.abs()).sum::<f32>() / 3.0
        };
        let weight = Planes::from_fn(self.samples.len(), |i| {
            // In units of the floor, so that the weights of the penalties do not depend on it.
            let weight = trust.get(0, i) * self.samples.weight.get(0, i);
            let weight = weight / (3.0 * floor * size(i).max(floor));
            [weight]
        });
        let sum: f64 = (0..self.samples.len())
            .map(|i| f64::from(self.samples.weight.get(0, i) * size(i)))
            .sum();
        (weight, sum / self.samples.len().max(1) as f64)
    }
}
