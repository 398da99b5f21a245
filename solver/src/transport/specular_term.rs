//! The parameters of the specular term that vary over a face. Its value at a sample is the integral of [`super::skin`]
//! over the visible light ([`super::Reflection`], [`super::SkinHighlights`]).

use serde::{Deserialize, Serialize};

use crate::config::SkinConfig;
use crate::model::planes::Planes;

/// The parameters of the specular term at a place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpecularTerm {
    /// Reflectance at normal incidence.
    pub reflectance: f32,
    /// Factor on the GGX alphas of [`SkinConfig`].
    pub roughness: f32,
}

impl SpecularTerm {
    /// The number of channels of its textures, and of rows of its samples.
    pub const ROWS: usize = 2;

    /// The usual lobes, with this reflectance at normal incidence.
    pub fn usual(reflectance: f32) -> Self {
        Self { reflectance, roughness: 1.0 }
    }

    /// The channels of a texel.
    pub fn channels(self) -> [f32; Self::ROWS] {
        [self.reflectance, self.roughness]
    }

    /// The term with these [channels](Self::channels).
    pub fn of([reflectance, roughness]: [f32; Self::ROWS]) -> Self {
        Self { reflectance, roughness }
    }

    /// The term of sample `i`.
    pub fn at(samples: &Planes, i: usize) -> Self {
        Self::of(samples.sample(i, 0))
    }

    /// `skin` with the lobes of this place; alphas are at most 1.
    pub fn lobes_of(self, skin: &SkinConfig) -> SkinConfig {
        let roughness = skin.roughness.map(|alpha| (alpha * self.roughness).min(1.0));
        SkinConfig { roughness, ..*skin }
    }
}
