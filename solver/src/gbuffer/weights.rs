//! How much an observation counts: the form factor of the paper (section 5.3), after Unstructured
//! Lumigraph Rendering: cosine between view and normal, times the inverse of the blurred depth
//! derivative.
//!
//! With g the magnitude of the depth's gradient by central differences (metres per pixel) and d/f
//! the metres a pixel spans at depth d, the slope is s = min(g / (d/f), [`EDGE_SLOPE`]), and
//! [`EDGE_SLOPE`] where a neighbour is not covered (silhouette, occluder, edge of the mask). With s̄
//! the slope blurred by a Gaussian over the covered pixels,
//! w = max(cos, 0) / (1 + [`FALLOFF`] · s̄), which is in 0 to 1 and does not depend on the unit of
//! length. The paper names the factors but neither their scale nor the blur; these are ours.

use super::GBuffer;
use crate::convolution::{Shape, convolve, gaussian};

/// Default standard deviation of the blur, in pixels of the full picture.
pub const BLUR_SIGMA_PX: f32 = 2.0;
/// The slope of a silhouette, and the largest one: the surface turned away by 84 degrees.
pub const EDGE_SLOPE: f32 = 10.0;
/// How fast the weight falls with the slope.
pub const FALLOFF: f32 = 1.0;

/// Cosine between view and normal, not less than 0, per sample.
pub fn cosine_weights(gbuffer: &GBuffer) -> Vec<f32> {
    let pairs = gbuffer.normals.iter().zip(&gbuffer.view_dirs);
    pairs.map(|(normal, view)| normal.dot(*view).clamp(0.0, 1.0)).collect()
}

/// The form factor per sample, 0 to 1; the blur's standard deviation is in pixels.
pub fn view_weights(gbuffer: &GBuffer, blur_sigma_px: f32) -> Vec<f32> {
    let slope = gbuffer.spread(&slopes(gbuffer), 0.0);
    let covered = gbuffer.spread(&vec![1.0; gbuffer.len()], 0.0);
    let shape = Shape { width: gbuffer.width, height: gbuffer.height, channels: 1 };
    let slope = blurred(&slope, shape, blur_sigma_px);
    let covered = blurred(&covered, shape, blur_sigma_px);
    let cosines = cosine_weights(gbuffer);
    let mean = |pixel: &u32| slope[*pixel as usize] / covered[*pixel as usize];
    cosines
        .iter()
        .zip(&gbuffer.pixels)
        .map(|(cos, pixel)| cos / (1.0 + FALLOFF * mean(pixel)))
        .collect()
}

/// Magnitude of the depth's gradient over the width of a pixel, capped, per sample.
fn slopes(gbuffer: &GBuffer) -> Vec<f32> {
    let (width, height) = (gbuffer.width, gbuffer.height);
    let depth = gbuffer.spread(&gbuffer.depths, f32::INFINITY);
    let slope = |(pixel, here): (&u32, &f32)| {
        let (x, y) = (*pixel as usize % width, *pixel as usize / width);
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            return EDGE_SLOPE;
        }
        let at = |x: usize, y: usize| depth[y * width + x];
        let across = (at(x + 1, y) - at(x - 1, y)) / 2.0;
        let down = (at(x, y + 1) - at(x, y - 1)) / 2.0;
        // Two uncovered neighbours give inf - inf; min passes over NaN, so this is an edge too.
        (across.hypot(down) * gbuffer.focal / here).min(EDGE_SLOPE)
    };
    gbuffer.pixels.iter().zip(&gbuffer.depths).map(slope).collect()
}

/// Gaussian blur to three standard deviations, not normalised; nothing comes in from outside the
/// picture.
pub(crate) fn blurred(picture: &[f32], shape: Shape, sigma: f32) -> Vec<f32> {
    let line = shape.width * shape.channels;
    let read = |row: usize, out: &mut [f32]| out.copy_from_slice(&picture[row * line..][..line]);
    convolve(&gaussian(sigma), shape, read, |_, _| {})
}
