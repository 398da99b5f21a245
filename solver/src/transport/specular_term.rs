//! The specular term as it varies over a face: what is solved for in it. Its value at a sample is [`super::skin`]'s
//! over the light that the place sees ([`super::Reflection`], [`super::SkinHighlights`]).

use serde::{Deserialize, Serialize};

use crate::config::SkinConfig;
use crate::model::planes::Planes;

/// What is solved for in the specular term, at a place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpecularTerm {
    /// Reflectance at normal incidence.
    pub reflectance: f32,
    /// Factor on the GGX alphas of [`SkinConfig`].
    pub roughness: f32,
}

impl SpecularTerm {
    /// Channels of a texture of it, and rows of its samples.
    pub const ROWS: usize = 2;

    /// The usual lobes of this reflectance at normal incidence.
    pub fn usual(reflectance: f32) -> Self {
        Self { reflectance, roughness: 1.0 }
    }

    /// As the channels of a texel.
    pub fn channels(self) -> [f32; Self::ROWS] {
        [self.reflectance, self.roughness]
    }

    /// Of sample `i`.
    pub fn at(samples: &Planes, i: usize) -> Self {
        let [reflectance, roughness] = samples.sample(i, 0);
        Self { reflectance, roughness }
    }

    /// `skin` with the lobes of this place, of alphas up to 1.
    pub fn lobes_of(self, skin: &SkinConfig) -> SkinConfig {
        let roughness = skin.roughness.map(|alpha| (alpha * self.roughness).min(1.0));
        SkinConfig { roughness, ..*skin }
    }
}
