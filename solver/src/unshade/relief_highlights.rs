//! The highlights of the light on normals that relief deviates.

use glam::Vec3;

use crate::backend::Backend;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{HIGHLIGHT_ROWS, SkinHighlights, SpecularTerm};

/// A light, and the specular terms of samples.
pub(super) struct ReliefHighlights<'a> {
    backend: &'a dyn Backend,
    highlights: SkinHighlights<'a>,
    /// See [`SpecularTerm::at`].
    specular: Planes,
}

impl<'a> ReliefHighlights<'a> {
    pub fn new(backend: &'a dyn Backend, highlights: SkinHighlights<'a>, specular: Planes) -> Self {
        Self { backend, highlights, specular }
    }

    /// On skin that is rougher by this factor.
    pub fn rougher(&self, factor: f32) -> Self {
        let term = |i: usize| {
            let term = SpecularTerm::at(&self.specular, i);
            SpecularTerm { roughness: factor * term.roughness, ..term }.channels()
        };
        let specular = Planes::from_fn(self.specular.len(), term);
        Self { specular, highlights: self.highlights.clone(), ..*self }
    }

    /// Highlights with normals bent by the first rows of `deviations`, R, G, B, and their change with those.
    pub fn at(&self, samples: &Samples, deviations: &Planes) -> Planes {
        let bent = |i: usize| {
            Vec3::from_array(samples.normal.sample(i, 0))
                + Vec3::from_array(deviations.sample(i, 0))
        };
        let normals = Planes::from_fn(samples.len(), |i| bent(i).normalize().to_array());
        let highlights =
            self.backend.highlights(&self.highlights, samples, &normals, &self.specular);
        Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(normals.sample(i, 0));
            let [r, g, b, x, y, z]: [f32; HIGHLIGHT_ROWS] = highlights.sample(i, 0);
            let by = Vec3::new(x, y, z) / bent(i).length();
            let [x, y, z] = (by - normal * normal.dot(by)).to_array();
            [r, g, b, x, y, z]
        })
    }
}
