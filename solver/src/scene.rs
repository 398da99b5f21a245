//! The immutable inputs of a solve: pictures, G-buffers, and their samples at the sizes in use.

use std::borrow::Cow;

use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::{Projection, per_texel};
use capture::{Capture, CaptureError, View};
use rayon::prelude::*;

use crate::config::{TextureSize, ViewWeightConfig};
use crate::model::samples::{SampleSpace, Samples};
use crate::transport::{CHANNELS, luminance};

/// A capture with its G-buffers, the scale of its pictures and the sizes of its textures.
pub(crate) struct Scene<'a> {
    pub capture: &'a Capture,
    pub space: SampleSpace,
    /// Factor on the pictures, so that no rate or weight depends on their exposure.
    pub picture_scale: f32,
    /// G-buffers of the training views, in full resolution.
    pub gbuffers: Vec<GBuffer>,
    /// Side of the textures that are solved for, texels.
    pub size: usize,
    /// Side of the maps, texels.
    pub map_size: usize,
}

impl<'a> Scene<'a> {
    /// Scales the pictures to a mean of `target_luminance` where they show the mesh; `None` leaves them as they are.
    /// Fails if no picture shows the mesh.
    pub fn new(
        capture: &'a Capture,
        space: SampleSpace,
        target_luminance: Option<f32>,
        texture_size: TextureSize,
    ) -> Result<Self, CaptureError> {
        let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
        if gbuffers.iter().all(GBuffer::is_empty) {
            return Err(CaptureError::NothingVisible(capture.folder.clone()));
        }
        let picture_scale =
            target_luminance.map_or(1.0, |target| picture_scale(capture, &gbuffers, target));
        let size = texture_size.solved(capture);
        let map_size = texture_size.maps(size);
        let space = space.with_picture_scale(picture_scale);
        Ok(Self { capture, space, picture_scale, gbuffers, size, map_size })
    }

    /// The projections of a texture's texels into the training views.
    pub fn projections(&self) -> Vec<Projection<'_>> {
        Projection::of_views(&self.capture.train, &self.gbuffers)
    }

    /// Whether a training view shows each texel of an atlas.
    pub fn seen(&self, atlas: &Atlas) -> Vec<bool> {
        per_texel(atlas, &self.projections(), |_| true)
    }

    /// The samples of the full pictures, for textures of side `size`.
    pub fn samples(&self, weights: Option<&ViewWeightConfig>, size: usize) -> Samples {
        self.space.training(&self.capture.train, &self.gbuffers, weights, size)
    }

    /// The samples of the pictures averaged over 2 x 2 pixels, for textures of side `size`.
    pub fn samples_at_half_resolution(
        &self,
        weights: Option<&ViewWeightConfig>,
        size: usize,
    ) -> Samples {
        let Pictures { views, gbuffers } = self.halved(1);
        let weights = weights.cloned().map(|mut weights| {
            weights.depth_blur *= 0.5;
            weights
        });
        self.space.training(&views, &gbuffers, weights.as_ref(), size)
    }

    /// The training views, their width and height halved some times.
    pub fn halved(&self, times: usize) -> Pictures<'_> {
        let mut pictures = Pictures {
            views: Cow::Borrowed(&self.capture.train),
            gbuffers: Cow::Borrowed(&self.gbuffers),
        };
        for _ in 0..times {
            pictures.views = pictures.views.par_iter().map(View::half).collect();
        }
        if times > 0 {
            pictures.gbuffers = GBuffer::of_views(&self.capture.mesh, &pictures.views).into();
        }
        pictures
    }

    /// The number of pixels of the training views that show the mesh.
    pub fn pixels(&self) -> usize {
        self.gbuffers.iter().map(GBuffer::len).sum()
    }
}

/// Training views of one resolution, with their G-buffers.
pub(crate) struct Pictures<'a> {
    pub views: Cow<'a, [View]>,
    pub gbuffers: Cow<'a, [GBuffer]>,
}

/// The factor that scales the training pictures to a mean of `target_luminance` where they show the mesh; 1 if they are
/// black.
fn picture_scale(capture: &Capture, gbuffers: &[GBuffer], target_luminance: f32) -> f32 {
    let luminance_at = |view: &View, pixel: usize| -> f64 {
        luminance(&view.image.data[CHANNELS * pixel..][..CHANNELS])
    };
    let views = capture.train.iter().zip(gbuffers);
    let of_view = |(view, gbuffer): (&View, &GBuffer)| -> f64 {
        gbuffer.pixels.iter().map(|pixel| luminance_at(view, *pixel as usize)).sum()
    };
    let count: usize = gbuffers.iter().map(GBuffer::len).sum();
    let mean = (views.map(of_view).sum::<f64>() / count.max(1) as f64) as f32;
    if target_luminance > 0.0 && mean > 0.0 { target_luminance / mean } else { 1.0 }
}
