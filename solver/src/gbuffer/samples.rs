//! The samples of an optimisation: every usable pixel, with what the model needs of it.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::raster::Fragments;
use super::taps::Taps;
use super::views::SeenView;
use super::weights::direction_to;
use crate::capture::{Camera, Mesh};
use crate::config::{NetworkConfig, RenderingConfig};
use crate::model::planes::Planes;

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
}

/// What of the configuration shapes samples, and the mesh's extent.
#[derive(Clone, Debug)]
pub struct SampleSpace {
    centre: Vec3,
    scale: f32,
    f0: Option<f32>,
}

struct Sample {
    position: Vec3,
    normal: Vec3,
    view: Vec3,
    uv: Vec2,
    target: [f32; 3],
    weight: f32,
    pixel: u32,
}

impl SampleSpace {
    /// Positions span -1 to 1 along the longest side of the mesh's box, times the configured scale.
    pub fn new(mesh: &Mesh, networks: &NetworkConfig, rendering: &RenderingConfig) -> Self {
        let (low, high) = mesh.bounds();
        let half = (0.5 * (high - low).max_element()).max(f32::MIN_POSITIVE);
        Self {
            centre: 0.5 * (low + high),
            scale: networks.position_scale / half,
            f0: rendering.fresnel.then_some(rendering.f0),
        }
    }

    /// The usable pixels of all training views, for textures of side `size`.
    pub fn training(&self, mesh: &Mesh, views: &[SeenView], size: usize) -> Samples {
        let of_view = |view: &SeenView| -> Vec<Sample> {
            let pick = |at: usize| {
                let target = std::array::from_fn(|c| view.image.data[3 * at + c]);
                sample(mesh, &view.camera, &view.fragments, at, target, view.weights[at])
            };
            (0..view.weights.len()).filter(|at| view.weights[*at] > 0.0).filter_map(pick).collect()
        };
        let mut samples: Vec<Sample> =
            views.par_iter().map(of_view).collect::<Vec<_>>().into_iter().flatten().collect();
        let sum: f64 = samples.iter().map(|s| f64::from(s.weight)).sum();
        let mean = (sum / samples.len().max(1) as f64) as f32;
        samples.iter_mut().for_each(|s| s.weight /= mean);
        self.arrange(&samples, size)
    }

    /// Every pixel at which a withheld camera sees the front of the mesh.
    pub fn withheld(&self, mesh: &Mesh, camera: &Camera, size: usize) -> Samples {
        let fragments = Fragments::of_view(mesh, camera);
        let samples: Vec<Sample> = (0..camera.width * camera.height)
            .filter(|at| fragments.is_front(mesh, *at, camera.position()))
            .filter_map(|at| sample(mesh, camera, &fragments, at, [0.0; 3], 0.0))
            .collect();
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
            target: Planes::from_fn(order.len(), |i| samples[order[i]].target),
            weight: Planes::from_fn(order.len(), |i| [samples[order[i]].weight]),
            taps,
            pixel: order.iter().map(|source| samples[*source].pixel).collect(),
        }
    }
}

impl Samples {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.pixel.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pixel.is_empty()
    }
}

/// Schlick's approximation, equation (1).
pub fn schlick(f0: f32, cosine: f32) -> f32 {
    f0 + (1.0 - f0) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5)
}

fn sample(
    mesh: &Mesh,
    camera: &Camera,
    fragments: &Fragments,
    at: usize,
    target: [f32; 3],
    weight: f32,
) -> Option<Sample> {
    let surface = fragments.surface(mesh, at)?;
    Some(Sample {
        position: surface.position,
        normal: surface.normal,
        view: direction_to(camera.position().as_vec3(), surface.position),
        uv: surface.uv,
        target,
        weight,
        pixel: at as u32,
    })
}
