//! The immutable inputs of a solve: pictures, G-buffers, and their samples at the sizes in use.

use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::{Projection, per_texel};
use capture::{Capture, CaptureError, View};
use rayon::prelude::*;

use crate::config::{TextureSize, ViewWeightConfig};
use crate::model::samples::{SampleSpace, Samples};
use crate::transport::{CHANNELS, LUMINANCE};

/// A capture and what follows from it alone.
pub(crate) struct Scene<'a> {
    pub capture: &'a Capture,
    pub space: SampleSpace,
    /// Factor on the pictures, so that no rate or weight depends on their exposure.
    pub gain: f32,
    /// G-buffers of the training views, in full resolution.
    pub gbuffers: Vec<GBuffer>,
    /// Side of the textures that are solved for, texels.
    pub size: usize,
    /// Side of the maps, texels.
    pub map_size: usize,
}

impl<'a> Scene<'a> {
    /// The pictures are brought to a mean luminance of `exposure` where they show the mesh; `None` leaves them.
    /// Fails if they show nothing of it.
    pub fn new(
        capture: &'a Capture,
        space: SampleSpace,
        exposure: Option<f32>,
        texture_size: TextureSize,
    ) -> Result<Self, CaptureError> {
        let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
        if gbuffers.iter().all(GBuffer::is_empty) {
            return Err(CaptureError::NothingVisible(capture.folder.clone()));
        }
        let gain = exposure.map_or(1.0, |exposure| gain(capture, &gbuffers, exposure));
        let size = texture_size.solved(capture);
        let map_size = texture_size.maps(size);
        Ok(Self { capture, space: space.exposed(gain), gain, gbuffers, size, map_size })
    }

    /// The training views as a texture's texels find themselves in them.
    pub fn projections(&self) -> Vec<Projection<'_>> {
        Projection::of_views(&self.capture.train, &self.gbuffers)
    }

    /// Whether a training view shows a texel, for every texel of an atlas.
    pub fn seen(&self, atlas: &Atlas) -> Vec<bool> {
        per_texel(atlas, &self.projections(), |_| true)
    }

    /// The samples of the full pictures, for textures of side `size`.
    pub fn samples(&self, weights: Option<&ViewWeightConfig>, size: usize) -> Samples {
        self.space.training(&self.capture.train, &self.gbuffers, weights, size)
    }

    /// The samples of the pictures averaged over 2 x 2 pixels, for textures of side `size`.
    pub fn half_samples(&self, weights: Option<&ViewWeightConfig>, size: usize) -> Samples {
        let views: Vec<View> = self.capture.train.par_iter().map(View::half).collect();
        let gbuffers = GBuffer::of_views(&self.capture.mesh, &views);
        let weights = weights.cloned().map(|mut weights| {
            weights.depth_blur *= 0.5;
            weights
        });
        self.space.training(&views, &gbuffers, weights.as_ref(), size)
    }
}

/// The factor that brings the mean luminance of the training pictures, where they show the mesh, to `exposure`; 1 if
/// they are black.
fn gain(capture: &Capture, gbuffers: &[GBuffer], exposure: f32) -> f32 {
    let luminance = |view: &View, pixel: usize| -> f64 {
        let colour = &view.image.data[CHANNELS * pixel..][..CHANNELS];
        colour.iter().zip(LUMINANCE).map(|(value, weight)| f64::from(value * weight)).sum()
    };
    let views = capture.train.iter().zip(gbuffers);
    let of_view = |(view, gbuffer): (&View, &GBuffer)| -> f64 {
        gbuffer.pixels.iter().map(|pixel| luminance(view, *pixel as usize)).sum()
    };
    let count: usize = gbuffers.iter().map(GBuffer::len).sum();
    let mean = (views.map(of_view).sum::<f64>() / count.max(1) as f64) as f32;
    if exposure > 0.0 && mean > 0.0 { exposure / mean } else { 1.0 }
}
