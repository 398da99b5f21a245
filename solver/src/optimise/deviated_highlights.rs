//! Highlights that the found light makes on normals that heights deviate.

use glam::Vec3;

use super::context::SolveContext;
use super::lighting::Lighting;
use crate::backend::Backend;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::resample;
use crate::transport::{HIGHLIGHT_ROWS, SkinHighlights, SpecularTerm};

/// The light that makes them, and the specular terms of the samples.
pub(super) struct DeviatedHighlights<'a> {
    backend: &'a dyn Backend,
    skin_highlights: SkinHighlights<'a>,
    /// See [`SpecularTerm::at`].
    specular: Planes,
}

impl<'a> DeviatedHighlights<'a> {
    /// The light is seen through this power of the cosine. `None` if it is switched off, or if the light was not solved for with its highlights.
    pub fn new(
        context: &'a SolveContext,
        lighting: &'a Lighting,
        samples: &Samples,
        light_exponent: i32,
    ) -> Option<Self> {
        if !context.config.height.highlights || !lighting.explained {
            return None;
        }
        let skin_specular = resample(
            &lighting.skin_specular,
            lighting.state.size,
            SpecularTerm::ROWS,
            samples.taps.size(),
        );
        let specular = samples.taps.sample::<{ SpecularTerm::ROWS }>(&skin_specular);
        let skin_highlights = context.transport(lighting.setup).skin_highlights_through(
            &context.config.skin,
            &lighting.light.radiance,
            light_exponent,
        )?;
        Some(Self { backend: context.backend, skin_highlights, specular })
    }

    /// On skin that is rougher by this factor.
    pub fn rougher(&self, factor: f32) -> Self {
        let term = |i: usize| {
            let term = SpecularTerm::at(&self.specular, i);
            SpecularTerm { roughness: factor * term.roughness, ..term }.channels()
        };
        let specular = Planes::from_fn(self.specular.len(), term);
        Self { specular, skin_highlights: self.skin_highlights.clone(), ..*self }
    }

    /// Highlights with normals bent by the first rows of `deviations`, R, G, B, and how they change with those.
    pub fn at(&self, samples: &Samples, deviations: &Planes) -> Planes {
        let bent = |i: usize| {
            Vec3::from_array(samples.normal.sample(i, 0))
                + Vec3::from_array(deviations.sample(i, 0))
        };
        let normals = Planes::from_fn(samples.len(), |i| bent(i).normalize().to_array());
        let highlights =
            self.backend.highlights(&self.skin_highlights, samples, &normals, &self.specular);
        Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(normals.sample(i, 0));
            let [r, g, b, x, y, z]: [f32; HIGHLIGHT_ROWS] = highlights.sample(i, 0);
            let by = Vec3::new(x, y, z) / bent(i).length();
            let [x, y, z] = (by - normal * normal.dot(by)).to_array();
            [r, g, b, x, y, z]
        })
    }
}
