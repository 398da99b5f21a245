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
    /// Input of the spatial network: position, centred and scaled. Without rows if no network reads it.
    pub position: Planes,
    /// Unit normal of the mesh.
    pub normal: Planes,
    /// Unit vector to the camera.
    pub view: Planes,
    /// Fresnel factor of the mesh normal (1 if switched off). Without rows if no network reads it.
    pub fresnel: Planes,
    /// Radiance in the picture; zero for withheld views.
    pub target: Planes,
    /// Weight in the loss, mean 1; zero for withheld views.
    pub weight: Planes,
    /// Where the samples lie in the textures.
    pub taps: Taps,
    /// Pixel number within its view.
    pub pixel: Vec<u32>,
    /// Number of the frame: training views, then withheld cameras.
    pub view_index: Vec<u32>,
}

/// Converts G-buffers and pictures to samples: position scale, exposure, perturbation.
#[derive(Clone, Debug)]
pub struct SampleSpace {
    network_inputs: Option<NetworkInputs>,
    /// Factor on the pictures.
    picture_scale: f32,
    /// See [`SampleSpace::with_perturbed_pictures`].
    perturbation_seed: u64,
}

/// The inputs that the networks of the published method read in addition.
#[derive(Clone, Debug)]
struct NetworkInputs {
    centre: Vec3,
    position_scale: f32,
    f0: Option<f32>,
}

/// Largest relative change of a value by a perturbation: a few units in the last place, times the number of values in
/// the sums of a solve.
const PERTURBATION: f32 = 1e-6;

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

impl Default for SampleSpace {
    /// Pictures as they are, and no inputs of networks.
    fn default() -> Self {
        Self { network_inputs: None, picture_scale: 1.0, perturbation_seed: 0 }
    }
}

impl SampleSpace {
    /// Adds the inputs of networks. Positions span -1 to 1 along the longest side of the mesh's box, times
    /// `position_scale`. `f0` is the reflectance at normal incidence in Schlick's factor; `None` is a factor of 1.
    pub fn with_network_inputs(self, mesh: &Mesh, position_scale: f32, f0: Option<f32>) -> Self {
        let (low, high) = mesh.bounds();
        let half = (0.5 * (high - low).max_element()).max(f32::MIN_POSITIVE);
        let (centre, position_scale) = (0.5 * (low + high), position_scale / half);
        Self { network_inputs: Some(NetworkInputs { centre, position_scale, f0 }), ..self }
    }

    /// Multiplies every picture value by its own random factor within 1 +- [`PERTURBATION`], drawn by this seed; 0
    /// leaves them as they are.
    pub fn with_perturbed_pictures(self, perturbation_seed: u64) -> Self {
        Self { perturbation_seed, ..self }
    }

    /// Multiplies the pictures by a factor.
    pub fn with_picture_scale(self, picture_scale: f32) -> Self {
        Self { picture_scale, ..self }
    }

    /// The pixels of training views with weights above 0, for textures of side `size`. Without [`ViewWeightConfig`] a
    /// weight is the cosine between view and normal.
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
            let seed = self.perturbation_seed;
            let mut random = Pcg64Mcg::seed_from_u64(seed ^ ((number as u64) << 32));
            let mut unit = || random.next_u32() as i32 as f32 / i32::MIN as f32;
            let mut perturbed = |value: f32| match seed {
                0 => value,
                _ => value * (1.0 + PERTURBATION * unit()),
            };
            let mut target = |pixel: u32| {
                let value = Vec3::from_slice(&view.image.data[3 * pixel as usize..]);
                Vec3::from_array(value.to_array().map(&mut perturbed)) * self.picture_scale
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

    /// Every pixel at which the camera of the frame `number` sees the front of the mesh, without its picture.
    pub fn withheld(&self, gbuffer: &GBuffer, number: usize, size: usize) -> Samples {
        let sample = |i: usize| {
            let view_index = number as u32;
            Sample { view_index, ..sample(gbuffer, i, Vec3::ZERO, 0.0) }
        };
        let samples: Vec<_> = (0..gbuffer.len()).map(sample).collect();
        self.arrange(&samples, size)
    }

    fn arrange(&self, samples: &[Sample], size: usize) -> Samples {
        let uvs: Vec<Vec2> = samples.iter().map(|sample| sample.uv).collect();
        let (taps, order) = Taps::sorted(size, &uvs);
        let count = order.len();
        let vector = |of: &(dyn Fn(&Sample) -> Vec3 + Sync)| {
            Planes::from_fn(count, |i| of(&samples[order[i]]).to_array())
        };
        let (position, fresnel) = match &self.network_inputs {
            None => (Planes::new(0, count), Planes::new(0, count)),
            Some(NetworkInputs { centre, position_scale, f0 }) => {
                let fresnel = Planes::from_fn(count, |i| {
                    let s = &samples[order[i]];
                    [f0.map_or(1.0, |f0| schlick(f0, s.normal.dot(s.view)))]
                });
                (vector(&|s| (s.position - centre) * position_scale), fresnel)
            }
        };
        Samples {
            position,
            normal: vector(&|s| s.normal),
            view: vector(&|s| s.view),
            fresnel,
            target: vector(&|s| s.target),
            weight: Planes::from_fn(count, |i| [samples[order[i]].weight]),
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

    /// Every n-th sample, with the least n that leaves at most `count`. The choice depends on the number of samples
    /// alone.
    pub fn thinned(&self, count: usize) -> Self {
        self.kept(&Kept::spread(count, self.len(), 1))
    }

    /// Every n-th run of samples, so that most samples of one texel in several views stay together.
    pub fn thinned_in_runs(&self, count: usize) -> Self {
        self.kept(&Kept::spread(count, self.len(), RUN))
    }

    /// A part of the samples.
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
