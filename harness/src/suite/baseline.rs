//! The baselines: answers that need no optimisation, as methods of a suite.

use std::fs;
use std::path::Path;

use capture::mean_texture::mean_texture;
use capture::{Capture, CaptureError};
use formats::atomic::{self, Folder};
use formats::{Maps, MapsError, picture};
use scoring::score;
use solver::baselines::{semantic_initialisation, unlit_view};
use solver::exposure;

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

            /// The name in a suite.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The name in tables.
            pub fn title(self) -> &'static str {
                match self { $(Self::$variant => $title,)* }
            }

            fn maps(self, capture: &Capture, size: usize) -> Result<Maps, CaptureError> {
                match self { $(Self::$variant => $make(capture, size),)* }
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

    /// Writes the maps folder `maps` from `capture`, with textures of `size` texels a side. Of photographs also
    /// `views/`, its unlit pictures of the withheld views: without a truth nothing else of a baseline can be scored.
    pub fn make(self, capture: &Path, maps: &Path, size: usize) -> Result<(), RunError> {
        atomic::refuse_overlap(maps, &[capture]).map_err(MapsError::from)?;
        let photographed = score::is_photographed(capture);
        let capture = Capture::open(capture)?;
        let (capture, _) = exposure::evened(&capture)?;
        let made = self.maps(&capture, size)?;
        let folder = Folder::begin(maps)?;
        made.write_into(folder.path())?;
        if let (true, Some(texture)) =
            (photographed && !capture.withheld.is_empty(), &made.diffuse_albedo)
        {
            let views = folder.path().join("views");
            fs::create_dir_all(&views)?;
            for camera in &capture.withheld {
                let file = views.join(format!("{}.exr", camera.name));
                picture::write_exr_rgb(&file, &unlit_view(&capture, texture, camera))
                    .map_err(MapsError::from)?;
            }
        }
        Ok(folder.commit()?)
    }
}
