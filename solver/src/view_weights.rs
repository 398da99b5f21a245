//! Weights of pixels: the form factor of the paper (section 5.3), after Unstructured Lumigraph Rendering: cosine
//! between view and normal, times the inverse of the blurred depth derivative.
//!
//! With g the magnitude of the depth's gradient by central differences (metres per pixel) and d/f the metres a pixel
//! spans at depth d, the slope is s = min(g / (d/f), `edge_slope`), and `edge_slope` where a neighbour is not covered
//! (silhouette, occluder, edge of the mask). With s̄ the slope blurred by a Gaussian over the covered pixels, w =
//! max(cos, 0) / (1 + `slope_falloff` · s̄), which is in 0 to 1 and does not depend on the unit of length. The paper
//! names the factors but neither their scale nor the blur; these are ours.

use capture::gbuffer::GBuffer;

use crate::config::ViewWeightConfig;
use crate::convolution::{Shape, convolve, gaussian};

/// Cosine between view and normal, not less than 0, per sample.
pub fn cosine_weights(gbuffer: &GBuffer) -> Vec<f32> {
    let pairs = gbuffer.normals.iter().zip(&gbuffer.view_dirs);
    pairs.map(|(normal, view)| normal.dot(*view).clamp(0.0, 1.0)).collect()
}

/// The form factor per sample, 0 to 1.
pub fn view_weights(gbuffer: &GBuffer, config: &ViewWeightConfig) -> Vec<f32> {
    let ViewWeightConfig { depth_blur, edge_slope, slope_falloff, .. } = *config;
    let slope = gbuffer.spread(&slopes(gbuffer, edge_slope), 0.0);
    let covered = gbuffer.spread(&vec![1.0; gbuffer.len()], 0.0);
    let shape = Shape { width: gbuffer.width, height: gbuffer.height, channels: 1 };
    let slope = blurred(&slope, shape, depth_blur);
    let covered = blurred(&covered, shape, depth_blur);
    let cosines = cosine_weights(gbuffer);
    let mean = |pixel: &u32| slope[*pixel as usize] / covered[*pixel as usize];
    cosines
        .iter()
        .zip(&gbuffer.pixels)
        .map(|(cos, pixel)| cos / (1.0 + slope_falloff * mean(pixel)))
        .collect()
}

/// Magnitude of the depth's gradient over the width of a pixel, capped, per sample.
fn slopes(gbuffer: &GBuffer, edge_slope: f32) -> Vec<f32> {
    let (width, height) = (gbuffer.width, gbuffer.height);
    let depth = gbuffer.spread(&gbuffer.depths, f32::INFINITY);
    let slope = |(pixel, here): (&u32, &f32)| {
        let (x, y) = (*pixel as usize % width, *pixel as usize / width);
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            return edge_slope;
        }
        let at = |x: usize, y: usize| depth[y * width + x];
        let across = (at(x + 1, y) - at(x - 1, y)) / 2.0;
        let down = (at(x, y + 1) - at(x, y - 1)) / 2.0;
        // Two uncovered neighbours give inf - inf; min ignores NaN, so this is an edge too.
        (across.hypot(down) * gbuffer.focal / here).min(edge_slope)
    };
    gbuffer.pixels.iter().zip(&gbuffer.depths).map(slope).collect()
}

/// A Gaussian blur to three standard deviations, not normalised; zero outside the picture.
pub(crate) fn blurred(picture: &[f32], shape: Shape, sigma: f32) -> Vec<f32> {
    let line = shape.width * shape.channels;
    let read = |row: usize, out: &mut [f32]| out.copy_from_slice(&picture[row * line..][..line]);
    convolve(&gaussian(sigma), shape, read, |_, _| {})
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::testing;

    fn config(depth_blur: f32) -> ViewWeightConfig {
        ViewWeightConfig { depth_blur, ..ViewWeightConfig::default() }
    }

    #[test]
    fn weights_are_the_form_factor() {
        let camera = testing::camera("a", Vec3::new(0.0, 0.0, 2.0), 64);
        let facing = GBuffer::new(&testing::square(), &camera, None);
        let weights = facing.spread(&view_weights(&facing, &config(1.0)), 0.0);
        assert!(weights.iter().all(|weight| (0.0..=1.0).contains(weight)));
        let middle = weights[32 * 64 + 32];
        assert!((middle - 1.0).abs() < 1e-3, "a facing plane has no slope: {middle}");
        // Away from the edges a slanted plane has the slope of its tilt: its depth changes by
        // tan(tilt) per metre across, at its centre.
        let tilted = testing::camera("b", Vec3::new(2.0, 0.0, 2.0), 128);
        let slanted = GBuffer::new(&testing::square(), &tilted, None);
        let index = slanted.pixels.iter().position(|pixel| *pixel == 64 * 128 + 64).unwrap();
        let cosine = cosine_weights(&slanted)[index];
        assert!((cosine - 0.5_f32.sqrt()).abs() < 5e-3, "{cosine}");
        let expected = cosine / (1.0 + config(1.0).slope_falloff);
        let weight = view_weights(&slanted, &config(1.0))[index];
        assert!((weight - expected).abs() < 0.02 * expected, "{weight} {expected}");
        let edge = (0..64).find(|x| weights[32 * 64 + x] > 0.0).unwrap();
        assert!(weights[32 * 64 + edge] < 0.3, "the silhouette counts little");
    }

    #[test]
    fn the_number_of_threads_changes_no_weight() {
        let camera = testing::camera("a", Vec3::new(0.4, 0.3, 3.0), 50);
        let gbuffer = GBuffer::new(&testing::dome(30), &camera, None);
        let weights = view_weights(&gbuffer, &config(1.5));
        for threads in 1..=3 {
            assert_eq!(
                testing::on_threads(threads, || view_weights(&gbuffer, &config(1.5))),
                weights
            );
        }
    }
}
