//! Shading and highlights of the estimated light.

use glam::Vec3;

use super::explicit::exp;
use super::light::{JointEstimate, LightEstimate};
use super::region_terms::{RegionTerms, uniformity};
use crate::backend::Backend;
use crate::config::{SkinConfig, UnshadeConfig};
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, resample};
use crate::solution::RecoveredLight;
use crate::transport::{CHANNELS, SpecularTerm, Transport};

use super::relief_highlights::ReliefHighlights;

/// The estimated light, and the shading under it on the transport's texture.
pub(super) struct Lighting<'a> {
    transport: &'a Transport,
    skin: &'a SkinConfig,
    regions: &'a [u8],
    /// S_d, R, G, B per texel.
    shading: Vec<f32>,
    /// Its derivative, 9 values per texel; see [`Transport::shading_by_normal`].
    shading_by_normal: Vec<f32>,
    /// See [`Transport::peak`].
    pub peak: f32,
    /// See [`LightEstimate::fold_disagreement`].
    pub fold_disagreement: f32,
    /// The light for the record.
    pub light: RecoveredLight,
}

impl<'a> Lighting<'a> {
    /// `regions` are those of the transport's texture.
    pub fn new(
        config: &'a UnshadeConfig,
        transport: &'a Transport,
        regions: &'a [u8],
        estimate: &LightEstimate,
        joint: &JointEstimate,
    ) -> Self {
        let radiance = exp(&joint.log_light);
        let nearness = estimate.nearness_per_metre;
        let distance = (nearness > 0.0).then(|| nearness.recip());
        Self {
            skin: &config.skin,
            regions,
            shading: transport.shading(&radiance),
            shading_by_normal: transport.shading_by_normal(&radiance),
            peak: transport.peak(&radiance),
            fold_disagreement: estimate.fold_disagreement,
            light: RecoveredLight { rows: config.transport.rows, distance, radiance },
            transport,
        }
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.transport.size()
    }

    /// See [`uniformity`].
    pub fn uniformity(&self) -> f32 {
        uniformity(self.light.contrast())
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
        let highlights =
            self.transport.skin_highlights(self.skin, &self.light.radiance, light_exponent);
        ReliefHighlights::new(backend, highlights, specular)
    }

    /// S_d at every sample, and its derivative with respect to the normal ([`SHADING_ROWS`] rows).
    pub fn shading_with_derivative(&self, samples: &Samples) -> Planes {
        let size = samples.taps.size();
        let shading = resample(&self.shading, self.size(), CHANNELS, size);
        let by_normal = resample(&self.shading_by_normal, self.size(), 3 * CHANNELS, size);
        let parts: [(&[f32], usize); 2] = [(&shading, CHANNELS), (&by_normal, 3 * CHANNELS)];
        samples.taps.sample::<SHADING_ROWS>(&interleave::<SHADING_ROWS>(&parts))
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
