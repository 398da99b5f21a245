//! Relief by Gauss-Newton: one height per texel, so that what bends the normals is integrable.
//!
//! With light, specular albedo and the coarse diffuse albedo held fixed, the pictures are linear in
//! small changes of the normals and of the albedo. How diffuse shading changes with the normal is known
//! from explicit transport, or else from the networks; how highlights do, from the networks. Unknown are the height h (n_s = n - grad h,
//! n_d the same blurred) and damped changes of the diffuse albedo; L1 by reweighting, conjugate
//! gradients on the normal equations, relinearised a few times.

use glam::Vec3;
use rayon::prelude::*;

use super::stage::State;
use super::transported::{LIT, Lit, bent_shading};
use crate::backend::{ALBEDOS, Backend};
use crate::config::{Config, HeightConfig};
use crate::error::SolveError;
use crate::gbuffer::{Atlas, GBuffer, blurred};
use crate::model::blur::Blur;
use crate::model::height::HeightField;
use crate::model::networks::Networks;
use crate::model::normals::DirectionScale;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, resample};

/// Rows of the sampled unknowns: specular and diffuse deviation, albedo.
const UNKNOWNS: usize = 9;
/// Darkest albedo that a logarithm is taken of.
const DARKEST: f32 = 1e-3;
/// Change of the albedo that counts as one unit of the unknown.
const ALBEDO_UNIT: f32 = 0.1;
/// Pulls heights that no pixel sees to zero.
const REST: f32 = 1e-3;

/// The linearised problem.
pub struct ReliefSolve<'a> {
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
    lit: Option<Planes>,
    views: &'a [GBuffer],
}

/// Rows of what a sample's colour gains from changes of its texels: by n_s (3, of every channel), by
/// n_d (3 of R, then of G and B), by the diffuse albedo (S_d of R, G, B).
const SLOPES: usize = 15;

impl<'a> ReliefSolve<'a> {
    /// `samples` are those of `views`, with taps of the side `size`. Diffuse shading and albedo are those
    /// of `lit` if there are any, else those of `state`.
    pub(super) fn new(
        config: &'a Config,
        backend: &'a dyn Backend,
        samples: &'a Samples,
        views: &'a [GBuffer],
        atlas: &Atlas,
        state: &'a State,
        lit: Option<&'a Lit>,
    ) -> Self {
        let state = lit.map_or(state, |lit| &lit.state);
        let size = atlas.size;
        let height = &config.height;
        let smooth = Blur::new(state.size, 3, height.albedo_smoothing * state.size as f32);
        let logs: Vec<f32> = state.diffuse.iter().map(|a| a.max(DARKEST).ln()).collect();
        let diffuse: Vec<f32> = smooth.apply(&logs).iter().map(|log| log.exp()).collect();
        let diffuse = resample(&diffuse, state.size, 3, size);
        let specular = resample(&state.specular, state.size, 1, size);
        let albedo = samples
            .taps
            .sample::<ALBEDOS>(&interleave::<ALBEDOS>(&[(&diffuse, 3), (&specular, 1)]));
        Self {
            config: height,
            backend,
            samples,
            scale: DirectionScale::from(&config.networks),
            field: HeightField::new(atlas),
            blur: Blur::new(size, 3, config.height.blur * size as f32),
            size,
            albedo,
            networks: &state.networks,
            light: backend.light(&state.networks, &samples.position),
            lit: lit.map(|lit| lit.sampled(samples)),
            views,
        }
    }

    /// The deviation of the normals, 3 channels per texel of the side of the taps; `step` hears of
    /// every conjugate-gradient step with the mean absolute residual at the last linearisation, and
    /// may stop the solve with [`SolveError::Interrupted`]: then it ends with what it has.
    pub fn solve(
        &self,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<Vec<f32>, SolveError> {
        let texels = self.size * self.size;
        let mut x = vec![0.0f32; 4 * texels];
        'solve: for outer in 0..self.config.linearisations {
            let (slopes, target) = self.linearise(&x);
            for reweighting in 0..self.config.reweightings {
                let fitted = match outer + reweighting {
                    0 => None,
                    _ => Some(self.forward(&slopes, &self.sampled(&x))),
                };
                let (weight, residual) = self.weights(&target, fitted.as_ref());
                match self.conjugate_gradients(&slopes, &weight, &target, &mut x, residual, step) {
                    // Every step leaves heights that explain more than those before it.
                    Err(SolveError::Interrupted) => break 'solve,
                    done => done?,
                }
            }
        }
        Ok(self.field.bend(&x[..texels]))
    }

    /// Slopes at the current normals, and the colours that the linear model is to reach.
    fn linearise(&self, x: &[f32]) -> (Planes, Planes) {
        let samples = self.samples;
        let q = self.sampled(x);
        let directions = self.scale.directions(samples, Some(&q));
        let shading = self.backend.shade(self.networks, &self.light, &directions);
        let jacobian = self.jacobian(&directions, &q);
        let current = |i: usize| -> [f32; 3] {
            let albedo: [f32; ALBEDOS] = self.albedo.sample(i, 0);
            let change: [f32; 3] = q.sample(i, 6);
            std::array::from_fn(|c| albedo[c] + change[c])
        };
        // S_d of R, G, B, and how it changes with the deviation.
        let diffuse = |i: usize| -> ([f32; 3], [Vec3; 3]) {
            let Some(lit) = &self.lit else {
                let slope = Vec3::from_array(jacobian.sample(i, 3));
                return ([shading.get(0, i); 3], [slope; 3]);
            };
            let lit: [f32; LIT] = lit.sample(i, 0);
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let bent = normal + Vec3::from_array(q.sample(i, 3));
            let length = bent.length();
            let bent = bent / length;
            let slope = |c: usize| {
                let slope = Vec3::from_slice(&lit[3 + 3 * c..]);
                (slope - bent * bent.dot(slope)) / length
            };
            (bent_shading(&lit, normal, bent), std::array::from_fn(slope))
        };
        let slopes = Planes::from_fn(samples.len(), |i| {
            let by_specular: [f32; 3] = jacobian.sample(i, 0);
            let gloss = self.albedo.get(3, i);
            let albedo = current(i);
            let (shading, slope) = diffuse(i);
            let mut row = [0.0; SLOPES];
            for c in 0..3 {
                row[c] = gloss * by_specular[c];
                row[3 + 3 * c..6 + 3 * c].copy_from_slice(&(albedo[c] * slope[c]).to_array());
                row[12 + c] = shading[c];
            }
            row
        });
        // What the current unknowns leave, without what is too coarse to be relief.
        let residual: Planes = Planes::from_fn(samples.len(), |i| {
            let specular = shading.get(1, i);
            let highlight = samples.fresnel.get(0, i) * self.albedo.get(3, i) * specular;
            let (target, albedo): ([f32; 3], [f32; 3]) = (samples.target.sample(i, 0), current(i));
            let diffuse: [f32; 3] = slopes.sample(i, 12);
            std::array::from_fn::<f32, 3, _>(|c| target[c] - albedo[c] * diffuse[c] - highlight)
        });
        let fine = self.without_coarse(&residual);
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
        let mut probe = samples.clone();
        let unit = 3.0 * samples.len() as f32;
        probe.target = Planes::from_fn(samples.len(), |_| [-1e6f32; 3]);
        probe.weight = Planes::from_fn(samples.len(), |_| [unit]);
        let albedo = Planes::from_fn(samples.len(), |_| [1.0, 0.0, 0.0, 1.0 / 3.0]);
        let (_, gradient) =
            self.backend.bend(self.networks, &probe, &self.light, directions, &albedo);
        self.scale.adjoint(samples, q, &gradient)
    }

    /// The unknowns at every sample: both deviations, change of the albedo.
    fn sampled(&self, x: &[f32]) -> Planes {
        let texels = self.size * self.size;
        let sharp = self.field.bend(&x[..texels]);
        let soft = self.blur.apply(&sharp);
        let albedo: Vec<f32> = x[texels..].iter().map(|x| ALBEDO_UNIT * x).collect();
        let parts: [(&[f32], usize); 3] = [(&sharp, 3), (&soft, 3), (&albedo, 3)];
        self.samples.taps.sample::<UNKNOWNS>(&interleave::<UNKNOWNS>(&parts))
    }

    fn forward(&self, slopes: &Planes, q: &Planes) -> Planes {
        Planes::from_fn(self.samples.len(), |i| {
            let s: [f32; SLOPES] = slopes.sample(i, 0);
            let q: [f32; UNKNOWNS] = q.sample(i, 0);
            let highlight = s[0] * q[0] + s[1] * q[1] + s[2] * q[2];
            std::array::from_fn::<f32, 3, _>(|c| {
                let slope = &s[3 + 3 * c..];
                let shading = slope[0] * q[3] + slope[1] * q[4] + slope[2] * q[5];
                shading + highlight + s[12 + c] * q[6 + c]
            })
        })
    }

    /// The transpose of [`Self::forward`] and [`Self::sampled`].
    fn adjoint(&self, slopes: &Planes, z: &Planes) -> Vec<f32> {
        let q = Planes::from_fn(self.samples.len(), |i| {
            let s: [f32; SLOPES] = slopes.sample(i, 0);
            let z: [f32; 3] = z.sample(i, 0);
            let all = z[0] + z[1] + z[2];
            let mut q = [0.0; UNKNOWNS];
            for k in 0..3 {
                q[k] = s[k] * all;
                q[3 + k] = s[3 + k] * z[0] + s[6 + k] * z[1] + s[9 + k] * z[2];
                q[6 + k] = s[12 + k] * z[k];
            }
            q
        });
        let gathered = self.samples.taps.gather::<UNKNOWNS>(&q, 0);
        let (texels, _) = gathered.as_chunks::<UNKNOWNS>();
        let part = |first: usize| -> Vec<f32> {
            texels.par_iter().flat_map_iter(|t| [t[first], t[first + 1], t[first + 2]]).collect()
        };
        let mut sharp = part(0);
        add(&mut sharp, &self.blur.adjoint(&part(3)));
        let mut gradient = self.field.adjoint(&sharp);
        gradient.extend(part(6).iter().map(|g| ALBEDO_UNIT * g));
        gradient
    }

    /// Weights of the reweighted least squares, and the weighted mean absolute residual.
    fn weights(&self, target: &Planes, fitted: Option<&Planes>) -> (Planes, f64) {
        let floor = self.config.residual_floor;
        let size = |i: usize| {
            let target: [f32; 3] = target.sample(i, 0);
            let fitted: [f32; 3] = fitted.map_or([0.0; 3], |fitted| fitted.sample(i, 0));
            (0..3).map(|c| (target[c] - fitted[c]).abs()).sum::<f32>() / 3.0
        };
        let weight = Planes::from_fn(self.samples.len(), |i| {
            // In units of the floor, so that the weights of the penalties do not depend on it.
            let weight = self.samples.weight.get(0, i) / (3.0 * floor * size(i).max(floor));
            [weight]
        });
        let sum: f64 = (0..self.samples.len())
            .map(|i| f64::from(self.samples.weight.get(0, i) * size(i)))
            .sum();
        (weight, sum / self.samples.len().max(1) as f64)
    }

    fn conjugate_gradients(
        &self,
        slopes: &Planes,
        weight: &Planes,
        target: &Planes,
        x: &mut [f32],
        residual: f64,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<(), SolveError> {
        let weighted = |z: &Planes| -> Planes {
            Planes::from_fn(self.samples.len(), |i| {
                let (z, weight): ([f32; 3], f32) = (z.sample(i, 0), weight.get(0, i));
                z.map(|z| weight * z)
            })
        };
        let texels = self.size * self.size;
        let normal = |x: &[f32]| {
            let mut out = self.adjoint(slopes, &weighted(&self.forward(slopes, &self.sampled(x))));
            let (by_height, by_albedo) = out.split_at_mut(texels);
            let (height, albedo) = x.split_at(texels);
            let bend = self.field.bend(height);
            let mut penalty = laplacian(&bend, self.size, 3, self.config.smoothness);
            let flatness = self.config.flatness;
            penalty.iter_mut().zip(&bend).for_each(|(p, d)| *p += flatness * d);
            add(by_height, &self.field.adjoint(&penalty));
            by_height.iter_mut().zip(height).for_each(|(g, h)| *g += REST * h);
            let damping = self.config.albedo_damping;
            by_albedo.iter_mut().zip(albedo).for_each(|(g, a)| *g += damping * a);
            out
        };
        let goal = self.adjoint(slopes, &weighted(target));
        let start = normal(x);
        let mut rest: Vec<f32> = goal.iter().zip(&start).map(|(b, ax)| b - ax).collect();
        let mut direction = rest.clone();
        let enough = 1e-5 * dot(&goal, &goal);
        let mut energy = dot(&rest, &rest);
        for _ in 0..self.config.steps {
            step(residual)?;
            if energy <= enough {
                continue;
            }
            let image = normal(&direction);
            let length = (energy / dot(&direction, &image)) as f32;
            x.par_iter_mut().zip(&direction).for_each(|(x, d)| *x += length * d);
            rest.par_iter_mut().zip(&image).for_each(|(r, q)| *r -= length * q);
            let next = dot(&rest, &rest);
            let turn = (next / energy) as f32;
            direction.par_iter_mut().zip(&rest).for_each(|(d, r)| *d = r + turn * *d);
            energy = next;
        }
        Ok(())
    }

    /// The residual of every view less its own blur over the covered pixels.
    fn without_coarse(&self, residual: &Planes) -> Planes {
        let sigma = self.config.coarsest_pixels;
        if sigma == 0.0 {
            return residual.clone();
        }
        let channels: Vec<Vec<Vec<f32>>> = self
            .views
            .par_iter()
            .enumerate()
            .map(|(view, gbuffer)| {
                let (width, height) = (gbuffer.width, gbuffer.height);
                let mut planes = vec![vec![0.0f32; width * height]; 4];
                for (i, (of, pixel)) in
                    self.samples.view_index.iter().zip(&self.samples.pixel).enumerate()
                {
                    if *of as usize == view {
                        (0..3).for_each(|c| planes[c][*pixel as usize] = residual.get(c, i));
                        planes[3][*pixel as usize] = 1.0;
                    }
                }
                planes.iter().map(|plane| blurred(plane, width, height, sigma)).collect()
            })
            .collect();
        Planes::from_fn(self.samples.len(), |i| {
            let view = &channels[self.samples.view_index[i] as usize];
            let pixel = self.samples.pixel[i] as usize;
            let cover = view[3][pixel].max(f32::MIN_POSITIVE);
            let residual: [f32; 3] = residual.sample(i, 0);
            std::array::from_fn::<f32, 3, _>(|c| residual[c] - view[c][pixel] / cover)
        })
    }
}

/// `weight` times the transpose-times-itself of the forward differences.
fn laplacian(texture: &[f32], size: usize, channels: usize, weight: f32) -> Vec<f32> {
    let line = size * channels;
    (0..texture.len())
        .into_par_iter()
        .map(|at| {
            let (x, y, value) = (at % line, at / line, texture[at]);
            let mut sum = 0.0;
            let mut pull = |neighbour: usize| sum += value - texture[neighbour];
            if x >= channels {
                pull(at - channels);
            }
            if x + channels < line {
                pull(at + channels);
            }
            if y > 0 {
                pull(at - line);
            }
            if y + 1 < size {
                pull(at + line);
            }
            weight * sum
        })
        .collect()
}

fn add(sum: &mut [f32], values: &[f32]) {
    sum.par_iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}

/// In fixed chunks, so that threads do not matter.
fn dot(a: &[f32], b: &[f32]) -> f64 {
    let parts: Vec<f64> = a
        .par_chunks(1 << 14)
        .zip(b.par_chunks(1 << 14))
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum())
        .collect();
    parts.iter().sum()
}
