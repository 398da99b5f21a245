//! The highlights of the light on the normals of relief.

use glam::Vec3;

use super::illuminations::{PartOfSamples, by_parts};
use crate::backend::Backend;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{HIGHLIGHT_ROWS, SkinHighlights, SpecularTerm};

/// The highlights of every illumination on its samples with their specular terms.
pub(super) struct ReliefHighlights<'a> {
    backend: &'a dyn Backend,
    parts: Vec<PartOfSamples>,
    /// Those of each part.
    highlights: Vec<SkinHighlights<'a>>,
    /// See [`SpecularTerm::at`].
    specular: Planes,
}

impl<'a> ReliefHighlights<'a> {
    /// `highlights` are those of each of the `parts`.
    pub fn new(
        backend: &'a dyn Backend,
        parts: Vec<PartOfSamples>,
        highlights: Vec<SkinHighlights<'a>>,
        specular: Planes,
    ) -> Self {
        Self { backend, parts, highlights, specular }
    }

    /// Multiplies the roughness of the samples by a factor.
    pub fn with_rougher_skin(&self, factor: f32) -> Self {
        let term = |i: usize| {
            let term = SpecularTerm::at(&self.specular, i);
            SpecularTerm { roughness: factor * term.roughness, ..term }.channels()
        };
        let specular = Planes::from_fn(self.specular.len(), term);
        let (parts, highlights) = (self.parts.clone(), self.highlights.clone());
        Self { backend: self.backend, parts, highlights, specular }
    }

    /// The highlights, R, G, B, with normals bent by the first rows of `deviations`, and the derivative of their
    /// luminance with respect to the deviation.
    pub fn at(&self, samples: &Samples, deviations: &Planes) -> Planes {
        let bent = |i: usize| {
            Vec3::from_array(samples.normal.sample(i, 0))
                + Vec3::from_array(deviations.sample(i, 0))
        };
        let normals = Planes::from_fn(samples.len(), |i| bent(i).normalize().to_array());
        let highlights = by_parts::<HIGHLIGHT_ROWS>(&self.parts, samples.len(), |at, part| {
            let [normals, specular] = [&normals, &self.specular].map(|planes| part.planes(planes));
            let samples = part.samples(samples);
            self.backend.highlights(&self.highlights[at], &samples, &normals, &specular)
        });
        Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(normals.sample(i, 0));
            let [r, g, b, x, y, z]: [f32; HIGHLIGHT_ROWS] = highlights.sample(i, 0);
            let by = Vec3::new(x, y, z) / bent(i).length();
            let [x, y, z] = (by - normal * normal.dot(by)).to_array();
            [r, g, b, x, y, z]
        })
    }
}
