//! The samples of an optimisation: every usable pixel, with what the model needs of it.

use capture::gbuffer::GBuffer;
use capture::{Mesh, View};
use glam::{Vec2, Vec3};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::kept::Kept;
use super::planes::Planes;
use super::taps::Taps;
use crate::config::ViewWeightConfig;
use crate::transport::skin::schlick;
use crate::view_weights;

/// Samples of a run of [`Samples::thinned_in_runs`]: rows of texels of a texture.
const RUN: usize = 4096;

/// Samples in texel order; see [`Taps`].
#[derive(Clone, Debug)]
pub struct Samples {
    /// Input of the spatial network: position, centred and scaled.
    pub position: Planes,
    /// Unit normal of the mesh.
    pub normal: Planes,
    /// Unit vector to the camera.
    pub view: Planes,
    /// Fresnel factor of the mesh normal (1 if switched off).
    pub fresnel: Planes,
    /// Radiance in the picture; zero for withheld views.
    pub target: Planes,
    /// Weight in the loss, mean 1; zero for withheld views.
    pub weight: Planes,
    /// Where the samples lie in the textures.
    pub taps: Taps,
    /// Pixel number within its view.
    pub pixel: Vec<u32>,
    /// Number of the view.
    pub view_index: Vec<u32>,
}

/// How positions and the Fresnel factor become inputs of the model.
#[derive(Clone, Debug)]
pub struct SampleSpace {
    centre: Vec3,
    scale: f32,
    f0: Option<f32>,
    /// Factor on the pictures.
    gain: f32,
    /// See [`SampleSpace::rounded`].
    rounding_seed: u64,
}

/// Largest relative change of a value by a rounding seed: a few units in the last place, times the sums that a
/// solve makes of them.
const ROUNDING: f32 = 1e-6;

/// One sample before the samples are sorted and laid out.
struct Sample {
    position: Vec3,
    normal: Vec3,
    view: Vec3,
    uv: Vec2,
    target: Vec3,
    weight: f32,
    pixel: u32,
    view_index: u32,
}

impl SampleSpace {
    /// Positions span -1 to 1 along the longest side of the mesh's box, times `position_scale`.
    pub fn new(mesh: &Mesh, position_scale: f32) -> Self {
        let (low, high) = mesh.bounds();
        let half = (0.5 * (high - low).max_element()).max(f32::MIN_POSITIVE);
        Self {
            centre: 0.5 * (low + high),
            scale: position_scale / half,
            f0: None,
            gain: 1.0,
            rounding_seed: 0,
        }
    }

    /// With Schlick's factor of this reflectance at normal incidence; `None`: a factor of 1.
    pub fn with_fresnel(self, f0: Option<f32>) -> Self {
        Self { f0, ..self }
    }

    /// With every picture value multiplied by a number next to 1 that is drawn by this seed; 0: as they are.
    pub fn rounded(self, rounding_seed: u64) -> Self {
        Self { rounding_seed, ..self }
    }

    /// Samples of the pictures multiplied with `gain`.
    pub fn exposed(self, gain: f32) -> Self {
        Self { gain, ..self }
    }

    /// The usable pixels of training views (those that count at all), for textures of side `size`.
    pub fn training(
        &self,
        views: &[View],
        gbuffers: &[GBuffer],
        weights: Option<&ViewWeightConfig>,
        size: usize,
    ) -> Samples {
        let mut samples = vec![];
        for (number, (view, gbuffer)) in views.iter().zip(gbuffers).enumerate() {
            let weights = match weights {
                Some(weights) => view_weights::view_weights(gbuffer, weights),
                None => view_weights::cosine_weights(gbuffer),
            };
            let mut random = Pcg64Mcg::seed_from_u64(self.rounding_seed ^ ((number as u64) << 32));
            let mut rounded = |value: f32| match self.rounding_seed {
                0 => value,
                _ => value * (1.0 + ROUNDING * (random.next_u32() as i32 as f32 / i32::MIN as f32)),
            };
            let mut target = |pixel: u32| {
                let value = Vec3::from_slice(&view.image.data[3 * pixel as usize..]);
                Vec3::from_array(value.to_array().map(&mut rounded)) * self.gain
            };
            let usable = weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0);
            samples.extend(usable.map(|(i, weight)| Sample {
                view_index: number as u32,
                ..sample(gbuffer, i, target(gbuffer.pixels[i]), *weight)
            }));
        }
        let sum: f64 = samples.iter().map(|s| f64::from(s.weight)).sum();
        let mean = (sum / samples.len().max(1) as f64) as f32;
        samples.iter_mut().for_each(|s| s.weight /= mean);
        self.arrange(&samples, size)
    }

    /// Every pixel at which a withheld camera sees the front of the mesh.
    pub fn withheld(&self, gbuffer: &GBuffer, size: usize) -> Samples {
        let samples: Vec<_> =
            (0..gbuffer.len()).map(|i| sample(gbuffer, i, Vec3::ZERO, 0.0)).collect();
        self.arrange(&samples, size)
    }

    fn arrange(&self, samples: &[Sample], size: usize) -> Samples {
        let uvs: Vec<Vec2> = samples.iter().map(|sample| sample.uv).collect();
        let (taps, order) = Taps::sorted(size, &uvs);
        let vector = |of: &(dyn Fn(&Sample) -> Vec3 + Sync)| {
            Planes::from_fn(order.len(), |i| of(&samples[order[i]]).to_array())
        };
        Samples {
            position: vector(&|s| (s.position - self.centre) * self.scale),
            normal: vector(&|s| s.normal),
            view: vector(&|s| s.view),
            fresnel: Planes::from_fn(order.len(), |i| {
                let s = &samples[order[i]];
                [self.f0.map_or(1.0, |f0| schlick(f0, s.normal.dot(s.view)))]
            }),
            target: vector(&|s| s.target),
            weight: Planes::from_fn(order.len(), |i| [samples[order[i]].weight]),
            taps,
            pixel: order.iter().map(|source| samples[*source].pixel).collect(),
            view_index: order.iter().map(|source| samples[*source].view_index).collect(),
        }
    }
}

impl Samples {
    /// No samples, for textures of side `size`.
    pub fn none(size: usize) -> Self {
        let none = |rows: usize| Planes::new(rows, 0);
        Self {
            position: none(3),
            normal: none(3),
            view: none(3),
            fresnel: none(1),
            target: none(3),
            weight: none(1),
            taps: Taps::sorted(size, &[]).0,
            pixel: vec![],
            view_index: vec![],
        }
    }

    /// As many as fit into `count`, evenly spread over the texels.
    pub fn thinned(&self, count: usize) -> Self {
        self.kept(&Kept::spread(count, self.len(), 1))
    }

    /// Likewise, but in runs, so that most of what several views see of one texel stays together.
    pub fn thinned_in_runs(&self, count: usize) -> Self {
        self.kept(&Kept::spread(count, self.len(), RUN))
    }

    /// The samples that are kept.
    pub fn kept(&self, kept: &Kept) -> Self {
        Self {
            position: self.position.kept(kept),
            normal: self.normal.kept(kept),
            view: self.view.kept(kept),
            fresnel: self.fresnel.kept(kept),
            target: self.target.kept(kept),
            weight: self.weight.kept(kept),
            taps: self.taps.kept(kept),
            pixel: kept.of(&self.pixel),
            view_index: kept.of(&self.view_index),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.pixel.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pixel.is_empty()
    }
}

fn sample(gbuffer: &GBuffer, i: usize, target: Vec3, weight: f32) -> Sample {
    Sample {
        position: gbuffer.positions[i],
        normal: gbuffer.normals[i],
        view: gbuffer.view_dirs[i],
        uv: gbuffer.uvs[i],
        target,
        weight,
        pixel: gbuffer.pixels[i],
        view_index: 0,
    }
}
