//! Shading and highlights of a known light.

use glam::Vec3;

use super::explicit::exp;
use super::light::{JointEstimate, LightEstimate};
use super::region_terms::{RegionTerms, evenness};
use crate::backend::Backend;
use crate::config::{SkinConfig, UnshadeConfig};
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, resample};
use crate::solution::RecoveredLight;
use crate::transport::{CHANNELS, SpecularTerm, Transport};

use super::relief_highlights::ReliefHighlights;

/// The light, with shading and albedo under it on the transport's texture.
pub(super) struct Lighting<'a> {
    transport: &'a Transport,
    skin: &'a SkinConfig,
    regions: &'a [u8],
    /// The diffuse albedo, R, G, B per texel, in units of 1 / S_d.
    pub albedo: Vec<f32>,
    /// S_d, R, G, B per texel.
    shading: Vec<f32>,
    /// Its change with the normal, 9 values per texel; see [`Transport::shading_by_normal`].
    shading_by_normal: Vec<f32>,
    /// S_d of full light on a surface that faces it.
    pub peak: f32,
    /// See [`LightEstimate::half_disagreement`].
    pub half_disagreement: f32,
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
        joint: JointEstimate,
    ) -> Self {
        let radiance = exp(&joint.log_light);
        let distance = (estimate.nearness > 0.0).then(|| estimate.nearness.recip());
        Self {
            skin: &config.skin,
            regions,
            albedo: joint.albedo,
            shading: transport.shading(&radiance),
            shading_by_normal: transport.shading_by_normal(&radiance),
            peak: transport.peak(&radiance),
            half_disagreement: estimate.half_disagreement,
            light: RecoveredLight { rows: config.transport.rows, distance, radiance },
            transport,
        }
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.transport.size()
    }

    /// 1 of a light that is the same from everywhere, 0 of lamps in the dark.
    pub fn evenness(&self) -> f32 {
        evenness(self.light.contrast())
    }

    /// The highlights of this light on samples with these terms. The light is seen through this power of the cosine.
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
            self.transport.skin_highlights_through(self.skin, &self.light.radiance, light_exponent);
        ReliefHighlights::new(backend, highlights, specular)
    }

    /// S_d at every sample, and its change with the normal ([`SHADING_ROWS`] rows).
    pub fn sampled(&self, samples: &Samples) -> Planes {
        let size = samples.taps.size();
        let shading = resample(&self.shading, self.size(), CHANNELS, size);
        let by_normal = resample(&self.shading_by_normal, self.size(), 3 * CHANNELS, size);
        let parts: [(&[f32], usize); 2] = [(&shading, CHANNELS), (&by_normal, 3 * CHANNELS)];
        samples.taps.sample::<SHADING_ROWS>(&interleave::<SHADING_ROWS>(&parts))
    }
}

/// Rows of [`Lighting::sampled`]: S_d (3), its changes with the normal (9).
pub(super) const SHADING_ROWS: usize = 4 * CHANNELS;

/// S_d with the normal bent from `normal` to `bent`, both unit.
pub(super) fn bent_shading(
    lighting: &[f32; SHADING_ROWS],
    normal: Vec3,
    bent: Vec3,
) -> [f32; CHANNELS] {
    std::array::from_fn(|c| {
        let slope = Vec3::from_slice(&lighting[CHANNELS + 3 * c..]);
        (lighting[c] + slope.dot(bent - normal)).max(0.0)
    })
}
