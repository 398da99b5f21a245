//! Highlights that the found light makes on normals that heights deviate.

use glam::Vec3;

use super::context::SolveContext;
use super::lighting::Lighting;
use crate::backend::Backend;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::resample;
use crate::transport::{HIGHLIGHT_ROWS, SkinHighlights};

/// The light that makes them, and the specular albedo of the samples.
pub(super) struct DeviatedHighlights<'a> {
    backend: &'a dyn Backend,
    skin_highlights: SkinHighlights<'a>,
    /// Specular albedo of every sample.
    albedo: Planes,
}

impl<'a> DeviatedHighlights<'a> {
    /// `None` if it is switched off, or if the light was not solved for with its highlights.
    pub fn new(
        context: &'a SolveContext,
        lighting: &'a Lighting,
        samples: &Samples,
    ) -> Option<Self> {
        if !context.config.height.highlights || !lighting.explained {
            return None;
        }
        let skin_specular =
            resample(&lighting.skin_specular, lighting.state.size, 1, samples.taps.size());
        let albedo = samples.taps.sample::<1>(&skin_specular);
        let skin_highlights = context
            .transport(lighting.setup)
            .skin_highlights(&context.config.skin, &lighting.light.radiance)?;
        Some(Self { backend: context.backend, skin_highlights, albedo })
    }

    /// Highlights with normals bent by the first rows of `deviations`, R, G, B, and how they change with those.
    pub fn at(&self, samples: &Samples, deviations: &Planes) -> Planes {
        let bent = |i: usize| {
            Vec3::from_array(samples.normal.sample(i, 0))
                + Vec3::from_array(deviations.sample(i, 0))
        };
        let normals = Planes::from_fn(samples.len(), |i| bent(i).normalize().to_array());
        let highlights = self.backend.highlights(&self.skin_highlights, samples, &normals);
        Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(normals.sample(i, 0));
            let [r, g, b, x, y, z]: [f32; HIGHLIGHT_ROWS] = highlights.sample(i, 0);
            let by = Vec3::new(x, y, z) / bent(i).length();
            let [x, y, z] = (by - normal * normal.dot(by)).to_array();
            [r, g, b, x, y, z].map(|value| self.albedo.get(0, i) * value)
        })
    }
}
