//! What a step has to do at least: floating-point operations, and bytes from and to memory if every
//! value is read once and written once. Divided by what the machine reaches, they are its floors.

use serde::Serialize;
use solver::Config;

/// Bytes of a value, of a sample's place in the textures, and of a value that Adam moves: it, its two
/// moments, each read and written.
const VALUE: f64 = 4.0;
const PLACE: f64 = 12.0;
const MOVED: f64 = 6.0 * VALUE;

/// Work of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Floating-point operations, a multiply-add being two.
    pub flops: f64,
    /// From and to memory.
    pub bytes: f64,
}

/// Products of the networks: forward, to the weights and to the inputs of every layer but the first.
fn products(config: &Config) -> [f64; 3] {
    let n = &config.networks;
    let (width, outputs) = (n.width as f64, n.outputs as f64);
    let first = 3.0 * width;
    let rest = (n.hidden_layers as f64 - 1.0) * width * width + width * outputs;
    [first + rest, first + rest, rest].map(|products| 2.0 * products)
}

/// A warm-up step: three networks with their gradients; positions, two directions, Fresnel factor,
/// colour and weight of every pixel (14 values); four values per texel.
pub fn warm_up(config: &Config, pixels: usize, size: usize) -> Cost {
    let per_pixel = 3.0 * products(config).iter().sum::<f64>();
    cost(per_pixel, 14.0, pixels, 4.0, size)
}

/// A step on normals and specular albedo: two networks and their gradients by the inputs; light
/// vector, normal, view, Fresnel factor, colour, weight, diffuse albedo (22 values); four values per
/// texel, of which three pass through a blur and its transpose.
pub fn normals(config: &Config, pixels: usize, size: usize) -> Cost {
    let [forward, ..] = products(config);
    let mut cost = cost(2.0 * 2.0 * forward, 22.0, pixels, 4.0, size);
    let taps = 2.0 * (3.0 * config.fine_tuning.deviation_blur * size as f32).ceil() + 1.0;
    cost.flops += 2.0 * 2.0 * 2.0 * f64::from(taps) * 3.0 * (size * size) as f64;
    cost
}

/// A step on the diffuse albedo: S_d, specular layer, colour and weight (8 values if S_d has colours).
pub fn diffuse(pixels: usize, size: usize) -> Cost {
    cost(60.0, 8.0, pixels, 3.0, size)
}

fn cost(flops: f64, values: f64, pixels: usize, moved: f64, size: usize) -> Cost {
    let (pixels, texels) = (pixels as f64, (size * size) as f64);
    Cost {
        flops: flops * pixels,
        bytes: (values * VALUE + PLACE) * pixels + moved * MOVED * texels,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::synthetic::paper;

    #[test]
    fn the_published_networks_have_the_published_counts() {
        let config = paper();
        assert_eq!(warm_up(&config, 1, 0).flops, 7488.0);
        assert_eq!(normals(&config, 1, 0).flops, 3456.0);
        assert_eq!(warm_up(&config, 10, 0).bytes, 680.0);
        assert_eq!(diffuse(0, 2).bytes, 288.0);
    }
}
