//! Heights by Gauss-Newton: one per texel, so that the deviation of the normals is integrable.
//!
//! With light, specular albedo and the coarse diffuse albedo held fixed, the pictures are linear in
//! small changes of the normals and of the albedo. How shading and highlights change with the normal is
//! known from explicit transport, or else from the networks. Unknown are the height h (n_s = n - grad h,
//! n_d the same blurred) and damped relative changes of the diffuse albedo; L1 by reweighting, conjugate
//! gradients on the normal equations; linearised anew on every texture, coarse to fine.

mod conjugate_gradients;
mod shown;

use capture::gbuffer::{Atlas, GBuffer};
use glam::Vec3;

use super::deviated_highlights::DeviatedHighlights;
use super::error::SolveError;
use super::lighting::{Lighting, SHADING_ROWS, bent_shading};
use super::linear_colour::{SLOPES, UNKNOWNS, believed, explained};
use super::nearby::Nearby;
use super::stage::State;
use super::vectors::add;
use crate::backend::{ALBEDOS, Backend};
use crate::config::{Config, HeightConfig};
use crate::model::blur::Blur;
use crate::model::height::HeightField;
use crate::model::networks::Networks;
use crate::model::normals::{Deviations, DirectionScale};
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, part, resample};
use crate::transport::CHANNELS;

/// The deviations among the sampled unknowns.
fn deviations(unknowns: &Planes) -> Deviations<'_> {
    Deviations { planes: unknowns, blurred: 3 }
}

/// The linearised problem.
pub struct HeightSolve<'a> {
    config: &'a HeightConfig,
    backend: &'a dyn Backend,
    samples: &'a Samples,
    scale: DirectionScale,
    field: HeightField,
    blur: Blur,
    size: usize,
    /// Sampled albedos of the state, the diffuse one without detail.
    albedo: Planes,
    /// Networks of the specular layer, and of the diffuse one without explicit transport.
    networks: &'a Networks,
    light: Planes,
    /// S_d under explicit transport, and how it changes with the normal.
    lighting: Option<Planes>,
    /// Highlights by the light; without them the networks'.
    highlights: Option<DeviatedHighlights<'a>>,
    /// Weight of the squared deviation in this light.
    flatness: f32,
    /// Conjugate-gradient steps per reweighting.
    steps: usize,
    nearby: Nearby<'a>,
}

impl<'a> HeightSolve<'a> {
    /// `samples` are those of `views`, with taps of the side of `atlas`. Diffuse shading and albedo are those
    /// of `lighting` if there are any, else those of `state`.
    pub(super) fn new(
        config: &'a Config,
        backend: &'a dyn Backend,
        samples: &'a Samples,
        views: &'a [GBuffer],
        atlas: &Atlas,
        state: &'a State,
        lighting: Option<&'a Lighting>,
    ) -> Self {
        let state = lighting.map_or(state, |lighting| &lighting.state);
        let size = atlas.size;
        let height = &config.height;
        let smooth = Blur::new(state.size, 3, height.albedo_smoothing * state.size as f32);
        let logs: Vec<f32> =
            state.diffuse.iter().map(|a| a.max(height.darkest_albedo).ln()).collect();
        let diffuse: Vec<f32> = smooth.apply(&logs).iter().map(|log| log.exp()).collect();
        let diffuse = resample(&diffuse, state.size, 3, size);
        let specular = resample(&state.specular, state.size, 1, size);
        let albedo = interleave::<ALBEDOS>(&[(&diffuse, 3), (&specular, 1)]);
        let albedo = samples.taps.sample_vectors(&albedo);
        Self {
            config: height,
            backend,
            samples,
            scale: DirectionScale::from(&config.networks),
            field: HeightField::new(atlas, height.steepest),
            blur: Blur::new(size, 3, config.height.blur * size as f32),
            size,
            albedo,
            networks: &state.networks,
            light: backend.light(&state.networks, &samples.position),
            lighting: lighting.map(|lighting| lighting.sampled(samples)),
            // What shading and the networks' highlights tell of relief grows with the light's contrast;
            // what the model gets wrong does not.
            flatness: height.flatness
                / lighting.map_or(1.0, Lighting::evidence_of_normals).max(height.minimum_contrast),
            highlights: None,
            steps: height.steps_on(size),
            nearby: Nearby::new(height, samples, views),
        }
    }

    /// With highlights by the light: what they tell of relief does not end with the light's contrast.
    pub(super) fn with(self, highlights: DeviatedHighlights<'a>) -> Self {
        Self { highlights: Some(highlights), flatness: self.config.flatness, ..self }
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
        let trust = self.nearby.trust(&slopes, &target);
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
        let highlights = self.highlights.as_ref().map(|light| light.at(samples, &q));
        // Shading by the networks.
        let directions = self.scale.directions(samples, Some(deviations(&q)));
        let shading = self.backend.shade(self.networks, &self.light, &directions);
        let jacobian = match (&highlights, &self.lighting) {
            (Some(_), Some(_)) => None,
            _ => Some(self.jacobian(&directions, &q)),
        };
        let by_networks = |i: usize, row: usize| -> [f32; 3] {
            jacobian.as_ref().map_or([0.0; 3], |jacobian| jacobian.sample(i, row))
        };
        let current = |i: usize| -> [f32; 3] {
            let albedo: [f32; ALBEDOS] = self.albedo.sample(i, 0);
            let change: [f32; 3] = q.sample(i, 6);
            std::array::from_fn(|c| albedo[c] * (1.0 + change[c]))
        };
        // S_d of R, G, B, and how it changes with the deviation.
        let diffuse = |i: usize| -> ([f32; 3], [Vec3; 3]) {
            let Some(lighting) = &self.lighting else {
                let slope = Vec3::from_array(by_networks(i, 3));
                return ([shading.get(0, i); 3], [slope; 3]);
            };
            let lighting: [f32; SHADING_ROWS] = lighting.sample(i, 0);
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let bent = normal + Vec3::from_array(q.sample(i, 3));
            let length = bent.length();
            let bent = bent / length;
            let slope = |c: usize| {
                let slope = Vec3::from_slice(&lighting[3 + 3 * c..]);
                (slope - bent * bent.dot(slope)) / length
            };
            (bent_shading(&lighting, normal, bent), std::array::from_fn(slope))
        };
        let slopes = Planes::from_fn(samples.len(), |i| {
            let albedo = current(i);
            let (shading, slope) = diffuse(i);
            let mut row = [0.0; SLOPES];
            row[..3].copy_from_slice(&match &highlights {
                Some(highlights) => highlights.sample::<3>(i, CHANNELS),
                None => by_networks(i, 0).map(|slope| self.albedo.get(3, i) * slope),
            });
            for c in 0..3 {
                row[3 + 3 * c..6 + 3 * c].copy_from_slice(&(albedo[c] * slope[c]).to_array());
                row[12 + c] = self.albedo.get(c, i) * shading[c];
            }
            row
        });
        // What the current unknowns leave with these highlights, without what is too coarse to be relief.
        let fine = |highlight: &(dyn Fn(usize) -> [f32; 3] + Sync)| {
            let residual = Planes::from_fn(samples.len(), |i| {
                let (target, change): ([f32; 3], [f32; 3]) =
                    (samples.target.sample(i, 0), q.sample(i, 6));
                let (diffuse, highlight): ([f32; 3], _) = (slopes.sample(i, 12), highlight(i));
                std::array::from_fn::<f32, 3, _>(|c| {
                    target[c] - diffuse[c] * (1.0 + change[c]) - highlight[c]
                })
            });
            self.nearby.without_coarse(&residual)
        };
        let left = fine(&|i| {
            let specular = samples.fresnel.get(0, i) * self.albedo.get(3, i);
            [specular * shading.get(1, i); 3]
        });
        // The networks know sharp lamps better than the cells of the light do, and all else worse.
        let fine = match &highlights {
            Some(by_light) => self.nearby.smaller(&fine(&|i| by_light.sample(i, 0)), &left),
            None => left,
        };
        let explained = self.forward(&slopes, &q);
        let target = Planes::from_fn(samples.len(), |i| {
            let (fine, explained): ([f32; 3], [f32; 3]) =
                (fine.sample(i, 0), explained.sample(i, 0));
            std::array::from_fn::<f32, 3, _>(|c| fine[c] + explained[c])
        });
        (slopes, target)
    }

    /// Derivatives of S_d by n_d and of F S_s by n_s, as rows n_s (3), n_d (3).
    fn jacobian(&self, directions: &Planes, q: &Planes) -> Planes {
        let samples = self.samples;
        // A target far below makes every residual positive, and weight and albedos are chosen so
        // that the gradient of the loss is the derivative itself: the red channel alone holds S_d,
        // all three hold F S_s.
        let unit = 3.0 * samples.len() as f32;
        let probe = Samples {
            fresnel: samples.fresnel.clone(),
            target: Planes::from_fn(samples.len(), |_| [-1e6f32; 3]),
            weight: Planes::from_fn(samples.len(), |_| [unit]),
            pixel: samples.pixel.clone(),
            ..Samples::none(samples.taps.size())
        };
        let albedo = Planes::from_fn(samples.len(), |_| [1.0, 0.0, 0.0, 1.0 / 3.0]);
        let (_, gradient) = self.backend.direction_gradient(
            self.networks,
            &probe,
            &self.light,
            directions,
            &albedo,
        );
        self.scale.adjoint(samples, deviations(q), &gradient)
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

    /// Weights of the reweighted least squares, and the mean absolute residual, of what is [`believed`].
    fn weights(
        &self,
        slopes: &Planes,
        target: &Planes,
        fitted: &Planes,
        trust: &Planes,
    ) -> (Planes, f64) {
        let floor = self.config.residual_floor;
        let size = |i: usize| {
            let (target, fitted): ([f32; 3], [f32; 3]) = (target.sample(i, 0), fitted.sample(i, 0));
            let left = std::array::from_fn(|c| target[c] - fitted[c]);
            let left = believed(left, &slopes.sample(i, 0), self.config.diffuse_doubt);
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
