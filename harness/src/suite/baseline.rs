//! The baselines: answers that need no optimisation, as methods of a suite.

use std::path::Path;

use capture::Capture;
use capture::mean_texture::mean_texture;
use formats::{MapsError, atomic};
use solver::baselines::semantic_initialisation;

use super::error::RunError;

/// Variant, name in a suite, title in tables, and what makes its maps from a capture and a texture's
/// side in texels. All that there is to say of a baseline outside the solver.
macro_rules! baselines {
    ($($(#[$doc:meta])* $variant:ident, $name:literal, $title:literal, $make:path;)*) => {
        /// A method that every solver has to beat.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum BaselineMethod { $($(#[$doc])* $variant,)* }

        impl BaselineMethod {
            /// Every one of them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// As a suite names it.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// As tables name it.
            pub fn title(self) -> &'static str {
                match self { $(Self::$variant => $title,)* }
            }

            /// Writes the maps folder `maps` from `capture`, with textures of `size` texels a side.
            pub fn make(self, capture: &Path, maps: &Path, size: usize) -> Result<(), RunError> {
                atomic::refuse_overlap(maps, &[capture]).map_err(MapsError::from)?;
                let capture = Capture::open(capture)?;
                let made = match self { $(Self::$variant => $make(&capture, size)?,)* };
                Ok(made.write(maps)?)
            }
        }
    };
}

baselines! {
    /// The mean of the projected colours as diffuse albedo: shading and highlights stay in it.
    MeanTexture, "mean_texture", "mean projected texture", mean_texture;
    /// The start of our solver: one colour for each label region.
    SemanticInitialisation, "semantic_initialisation", "semantic initialisation",
        semantic_initialisation;
}

impl BaselineMethod {
    /// Side of the textures where a suite names no other, texels.
    pub const TEXTURE_SIZE: usize = 512;
}
