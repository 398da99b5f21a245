//! The model of the published method: shading networks and textures.

use serde::{Deserialize, Serialize};

use crate::backend::{ALBEDOS, Backend};
use crate::model::deviation::Deviation;
use crate::model::deviation_textures::{BLURRED, SPECULAR};
use crate::model::networks::Networks;
use crate::model::normals::Deviations;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, resample};

/// The parameters of the published method: networks and textures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadingFields {
    /// The shading networks.
    pub networks: Networks,
    /// Side of the textures, texels.
    pub size: usize,
    /// The unscaled diffuse albedo, R, G, B per texel: radiance = albedo x S_d without highlights.
    pub diffuse: Vec<f32>,
    /// The unscaled specular albedo, one value per texel.
    pub specular: Vec<f32>,
    /// The texture t from which [`Deviation`] computes the deviation from the mesh normal; x, y, z per texel.
    pub deviation: Vec<f32>,
}

impl ShadingFields {
    /// Resamples the textures to another side.
    #[must_use]
    pub fn resized(self, size: usize) -> Self {
        if size == self.size {
            return self;
        }
        Self {
            diffuse: resample(&self.diffuse, self.size, 3, size),
            specular: resample(&self.specular, self.size, 1, size),
            deviation: resample(&self.deviation, self.size, 3, size),
            size,
            ..self
        }
    }

    /// Diffuse and specular albedo at every sample.
    pub fn albedo(&self, samples: &Samples) -> Planes {
        samples.taps.sample_vectors(&self.albedo_texture())
    }

    /// Diffuse and specular albedo, texel by texel.
    pub(super) fn albedo_texture(&self) -> Vec<f32> {
        interleave::<ALBEDOS>(&[(&self.diffuse, 3), (&self.specular, 1)])
    }

    /// The diffuse shading S_d and the specular layer F A_s S_s at every sample.
    pub fn layers(
        &self,
        samples: &Samples,
        deviation: &Deviation,
        backend: &dyn Backend,
    ) -> Planes {
        let bent = deviation.packed(&self.deviation, &self.specular).sample(&samples.taps);
        let deviations = Deviations { planes: &bent, blurred: BLURRED };
        let directions = deviation.scale.directions(samples, Some(deviations));
        let light = backend.light(&self.networks, &samples.position);
        let shading = backend.shade(&self.networks, &light, &directions);
        Planes::from_fn(samples.len(), |i| {
            let [diffuse, specular] = shading.sample(i, 0);
            [diffuse, samples.fresnel.get(0, i) * bent.get(SPECULAR, i) * specular]
        })
    }
}
