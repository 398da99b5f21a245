//! The parts of the truth that a privileged solve holds fixed ([`capture::Truth`]), in the units of the solve. Without
//! such parts everything here is the identity.

use capture::Truth;
use capture::gbuffer::Atlas;
use formats::picture::Picture;
use glam::Vec3;

use super::illuminations::Illuminations;
use super::region_terms::RegionTerms;
use crate::config::UnshadeConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::shrunk;
use crate::scene::Scene;
use crate::transport::{CHANNELS, Sky, Transport, luminances};

/// Least radiance of a cell over the mean shading: the logarithm of a black cell is finite, and so is the colour of its
/// shading.
const LEAST_RADIANCE: f32 = 1e-6;
/// Least true albedo by which a diffuse layer is divided.
const LEAST_ALBEDO: f32 = 1e-3;

/// The known parts of a scene's truth.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    truth: &'a Truth,
    picture_scale: f32,
}

impl<'a> Known<'a> {
    /// `picture_scale` is that of the [`Scene`].
    pub fn new(truth: &'a Truth, picture_scale: f32) -> Self {
        Self { truth, picture_scale }
    }

    /// The configuration, in which a known light has no learning rates.
    pub fn configured(&self, config: &UnshadeConfig) -> UnshadeConfig {
        let mut config = config.clone();
        if self.has_light() {
            config.joint.light_rate = 0.0;
            config.light.nearness_rate = 0.0;
        }
        config
    }

    /// Whether the light is known.
    pub fn has_light(&self) -> bool {
        self.truth.light.is_some()
    }

    /// The logarithm of the radiance per cell of every group's light, scaled to a mean shading of 1, and its nearness per metre.
    pub fn light(
        &self,
        far: &Transport,
        illuminations: &Illuminations,
        rows: usize,
    ) -> Option<(Vec<f32>, f32)> {
        let light = self.truth.light.as_ref()?;
        let nearness = light.distance.map_or(0.0, f32::recip);
        let sky = Sky::lat_long(rows);
        // The picture is seen from the origin, the cells from the centre of the mesh.
        let shift = (nearness * far.centre()).as_dvec3();
        let means = |picture: &Picture| sky.means(picture, shift);
        let cells: Vec<f32> = light.pictures.iter().flat_map(means).collect();
        let relative = nearness / far.nearness_unit();
        let mean = |illumination: usize| {
            let light = illuminations.light(&cells, illumination, relative);
            let shading = luminances(&far.shading_nearer(&light, relative).0);
            shading.iter().sum::<f32>() / shading.len().max(1) as f32
        };
        let trained = illuminations.trained();
        let mean = (0..trained).map(mean).sum::<f32>() / trained.max(1) as f32;
        let log = |radiance: &f32| (radiance / mean).max(LEAST_RADIANCE).ln();
        Some((cells.iter().map(log).collect(), nearness))
    }

    /// The terms with the known specular albedo and roughness on a texture of side `size`.
    pub fn terms(&self, terms: RegionTerms, config: &UnshadeConfig, size: usize) -> RegionTerms {
        let texture = |map: &Option<Picture>, factor: f32| {
            map.as_ref().map(|map| of_side(map, size).iter().map(|value| factor * value).collect())
        };
        let reflectance = texture(&self.truth.specular, self.picture_scale);
        let roughness = texture(&self.truth.roughness, config.skin.roughness[0].recip());
        terms.with_known([reflectance, roughness])
    }

    /// The known deviations of specular and diffuse normals on a texture of the scene's size.
    pub fn deviations(&self, scene: &Scene) -> Option<[Vec<f32>; 2]> {
        let size = scene.size;
        let atlas = Atlas::new(&scene.capture.mesh, size);
        let deviation = |normals: &Picture| -> Vec<f32> {
            let normals = of_side(normals, size);
            let pairs = normals.as_chunks::<3>().0.iter().zip(&atlas.normals);
            pairs
                .flat_map(|(n, mesh)| (Vec3::from(*n).normalize_or(*mesh) - mesh).to_array())
                .collect()
        };
        let [specular, diffuse] = self.truth.normals.as_ref()?;
        Some([deviation(specular), deviation(diffuse)])
    }

    /// Replaces the highlights of the samples by the known ones.
    pub fn highlights(&self, samples: &Samples, estimate: Planes) -> Planes {
        let Some(views) = &self.truth.highlights else { return estimate };
        Planes::from_fn(samples.len(), |i| {
            self.pixel(views, samples, i).map(|radiance| self.picture_scale * radiance)
        })
    }

    /// Replaces the shading of the samples by the known diffuse layer over the known albedo, with the mean of the
    /// estimate.
    pub fn shading(&self, samples: &Samples, estimate: Planes) -> Planes {
        let Some((views, albedo)) = &self.truth.shading else { return estimate };
        let albedo = samples.taps.sample::<CHANNELS>(&of_side(albedo, samples.taps.size()));
        let known = Planes::from_fn::<CHANNELS>(samples.len(), |i| {
            let layer = self.pixel(views, samples, i);
            std::array::from_fn(|c| layer[c] / albedo.get(c, i).max(LEAST_ALBEDO))
        });
        let sum = |planes: &Planes| -> f64 {
            (0..samples.len())
                .map(|i| planes.sample::<CHANNELS>(i, 0).iter().sum::<f32>() as f64)
                .sum()
        };
        let factor = (sum(&estimate) / sum(&known).max(f64::MIN_POSITIVE)) as f32;
        Planes::from_fn::<CHANNELS>(samples.len(), |i| {
            known.sample::<CHANNELS>(i, 0).map(|s| factor * s)
        })
    }

    fn pixel(&self, views: &[Picture], samples: &Samples, i: usize) -> [f32; CHANNELS] {
        let view = &views[samples.view_index[i] as usize];
        let at = CHANNELS * samples.pixel[i] as usize;
        std::array::from_fn(|c| view.data[at + c])
    }
}

/// A map as a texture of another side.
fn of_side(map: &Picture, side: usize) -> Vec<f32> {
    shrunk(&map.data, map.width, map.channels, side)
}
