//! Shading and highlights of the estimated light.

use glam::Vec3;

use super::explicit::exp;
use super::illuminations::{Illuminations, by_parts};
use super::light::{JointEstimate, LightEstimate};
use super::region_terms::{RegionTerms, uniformity};
use crate::backend::Backend;
use crate::config::{SkinConfig, UnshadeConfig};
use crate::maps::scaled;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, resample};
use crate::solution::RecoveredLight;
use crate::transport::{CHANNELS, SpecularTerm, Transport};

use super::relief_highlights::ReliefHighlights;

/// The estimated light, and the shading under each illumination on the transport's texture.
pub(super) struct Lighting<'a> {
    transport: &'a Transport,
    skin: &'a SkinConfig,
    regions: &'a [u8],
    illuminations: &'a Illuminations,
    /// S_d (R, G, B per texel) of every illumination, and its derivative, 9 values per texel; see
    /// [`Transport::shading_by_normal`].
    shadings: Vec<[Vec<f32>; 2]>,
    /// The radiance, R, G, B per cell of every group.
    radiance: Vec<f32>,
    rows: usize,
    /// See [`Illuminations::peak`].
    pub peak: f32,
    /// See [`LightEstimate::fold_disagreement`].
    pub fold_disagreement: f32,
    /// Distance of the light from the head's centre, metres; none at infinity.
    distance: Option<f32>,
}

impl<'a> Lighting<'a> {
    /// `regions` are those of the transport's texture.
    pub fn new(
        config: &'a UnshadeConfig,
        transport: &'a Transport,
        illuminations: &'a Illuminations,
        regions: &'a [u8],
        estimate: &LightEstimate,
        joint: &JointEstimate,
    ) -> Self {
        let radiance = exp(&joint.log_light);
        let nearness = joint.nearness_per_metre;
        let shading = |illumination: usize| {
            let light = illuminations.light(&radiance, illumination, 0.0);
            [transport.shading(&light), transport.shading_by_normal(&light)]
        };
        Self {
            skin: &config.skin,
            regions,
            illuminations,
            shadings: (0..illuminations.len()).map(shading).collect(),
            rows: config.transport.rows,
            peak: illuminations.peak(transport, &radiance),
            fold_disagreement: estimate.fold_disagreement,
            distance: (nearness > 0.0).then(|| nearness.recip()),
            radiance,
            transport,
        }
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.transport.size()
    }

    /// See [`uniformity`].
    pub fn uniformity(&self) -> f32 {
        uniformity(self.illuminations.contrast(self.rows, &self.radiance))
    }

    /// Whether all frames have one illumination.
    pub fn is_one(&self) -> bool {
        self.illuminations.is_one()
    }

    /// The light of every group, its radiance divided by the scale of the pictures.
    pub fn recovered(&self, picture_scale: f32) -> Vec<RecoveredLight> {
        let light = |group: usize| RecoveredLight {
            rows: self.rows,
            distance: self.distance,
            radiance: scaled(
                self.illuminations.of_group(&self.radiance, group),
                picture_scale.recip(),
            ),
        };
        (0..self.illuminations.groups()).map(light).collect()
    }

    /// The highlights of this light on samples with these terms. The light is filtered with this power of the cosine.
    pub fn highlights<'b>(
        &'b self,
        backend: &'b dyn Backend,
        terms: &RegionTerms,
        samples: &Samples,
        light_exponent: i32,
    ) -> ReliefHighlights<'b> {
        let texture = terms.texture(self.regions);
        let texture = resample(&texture, self.size(), SpecularTerm::ROWS, samples.taps.size());
        let specular = samples.taps.sample::<{ SpecularTerm::ROWS }>(&texture);
        let parts = self.illuminations.parts(samples);
        let highlights = parts.iter().map(|part| {
            let light = self.illuminations.light(&self.radiance, part.illumination, 0.0);
            self.transport.skin_highlights(self.skin, &light, self.peak, light_exponent)
        });
        let highlights = highlights.collect();
        ReliefHighlights::new(backend, parts, highlights, specular)
    }

    /// S_d at every sample, and its derivative with respect to the normal ([`SHADING_ROWS`] rows).
    pub fn shading_with_derivative(&self, samples: &Samples) -> Planes {
        let size = samples.taps.size();
        let parts = self.illuminations.parts(samples);
        by_parts::<SHADING_ROWS>(&parts, samples.len(), |_, part| {
            let [shading, by_normal] = &self.shadings[part.illumination];
            let shading = resample(shading, self.size(), CHANNELS, size);
            let by_normal = resample(by_normal, self.size(), 3 * CHANNELS, size);
            let rows: [(&[f32], usize); 2] = [(&shading, CHANNELS), (&by_normal, 3 * CHANNELS)];
            part.samples(samples).taps.sample::<SHADING_ROWS>(&interleave::<SHADING_ROWS>(&rows))
        })
    }

    /// The error of S_d at the edges of shadows, at every sample; see [`Transport::shadow_edges`].
    pub fn shadow_edges(&self, samples: &Samples) -> Planes {
        let parts = self.illuminations.parts(samples);
        by_parts::<1>(&parts, samples.len(), |_, part| {
            let light = self.illuminations.light(&self.radiance, part.illumination, 0.0);
            let edges = self.transport.shadow_edges(&light);
            let edges = resample(&edges, self.size(), 1, samples.taps.size());
            part.samples(samples).taps.sample::<1>(&edges)
        })
    }
}

/// Rows of [`Lighting::shading_with_derivative`]: S_d (3), its derivatives with respect to the normal (9).
pub(super) const SHADING_ROWS: usize = 4 * CHANNELS;

/// S_d of a normal bent from `normal` to `bent`, both unit, to first order.
pub(super) fn bent_shading(
    shading_with_derivative: &[f32; SHADING_ROWS],
    normal: Vec3,
    bent: Vec3,
) -> [f32; CHANNELS] {
    std::array::from_fn(|c| {
        let slope = Vec3::from_slice(&shading_with_derivative[CHANNELS + 3 * c..]);
        (shading_with_derivative[c] + slope.dot(bent - normal)).max(0.0)
    })
}

/// [`bent_shading`] of every sample, whose mesh normal is bent by `deviations`.
pub(super) fn bent_shadings(
    samples: &Samples,
    shading_with_derivative: &Planes,
    deviations: &Planes,
) -> Planes {
    Planes::from_fn(samples.len(), |i| {
        let normal = Vec3::from_array(samples.normal.sample(i, 0));
        let bent = (normal + Vec3::from_array(deviations.sample(i, 0))).normalize();
        bent_shading(&shading_with_derivative.sample(i, 0), normal, bent)
    })
}
