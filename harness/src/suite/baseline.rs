//! The baselines: answers that need no optimisation, as solvers of a suite.

use std::path::Path;

use capture::Capture;
use capture::mean_texture::mean_texture;
use formats::{MapsError, atomic};
use solver::baselines::semantic_initialisation;

use super::error::RunError;

/// A method that every solver has to beat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BaselineMethod {
    /// The mean of the projected colours as diffuse albedo: shading and highlights stay in it.
    MeanTexture,
    /// What our solver starts from: one colour for each label region.
    SemanticInitialisation,
}

impl BaselineMethod {
    /// Every one of them.
    pub const ALL: [Self; 2] = [Self::MeanTexture, Self::SemanticInitialisation];

    /// Side of the textures where a suite names no other, texels.
    pub const TEXTURE_SIZE: usize = 512;

    /// As a suite names it.
    pub fn name(self) -> &'static str {
        match self {
            Self::MeanTexture => "mean_texture",
            Self::SemanticInitialisation => "semantic_initialisation",
        }
    }

    /// As tables name it.
    pub fn title(self) -> &'static str {
        match self {
            Self::MeanTexture => "mean projected texture",
            Self::SemanticInitialisation => "semantic initialisation",
        }
    }

    /// Writes the maps folder `maps` from `capture`, with textures of `size` texels a side.
    pub fn make(self, capture: &Path, maps: &Path, size: usize) -> Result<(), RunError> {
        atomic::apart(maps, &[capture]).map_err(MapsError::from)?;
        let capture = Capture::open(capture)?;
        let made = match self {
            Self::MeanTexture => mean_texture(&capture, size)?,
            Self::SemanticInitialisation => semantic_initialisation(&capture, size)?,
        };
        Ok(made.write(maps)?)
    }
}
