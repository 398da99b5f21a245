//! The least work of a step: its arithmetic, and the bytes from and to memory if every value is read once
//! and written once. Divided by the rates that a machine reaches, they are the floors of its time.
//!
//! Arithmetic is counted twice: the products of networks and blurs alone; and all operations, where one
//! operation on a vector takes the place of one multiply-add. Operations other than products are counted as
//! the solver's kernels do them at their best level; the constants below list their parts.

use serde::Serialize;
use solver::config::PaperConfig;
use solver::model::pyramid::Pyramid;

use super::kind::Kind;
use super::synthetic::paper;

/// Bytes of a value, of a sample's place in the textures, and of a value that Adam moves: it, its two
/// moments, each read and written.
const VALUE: f64 = 4.0;
const PLACE: f64 = 12.0;
const MOVED: f64 = 6.0 * VALUE;

// Operations, a multiply-add being one.
/// Limits, the exponent and the rest, a polynomial of degree 7.
const EXP: f64 = 13.0;
/// With its derivative: e^-|x|, a reciprocal, a polynomial of degree 9.
const SOFTPLUS: f64 = 30.0;
/// Model, loss, and their gradients by both shadings and four albedos.
const COMPOSE: f64 = 39.0;
/// Two bent normals, a reflection, and the adjoint.
const DIRECTIONS: f64 = 42.0 + 50.0;
/// A texture's value at a sample, and its gradient to four texels.
const SAMPLED: f64 = 4.0 + 6.0;
/// A value that Adam moves.
const ADAM: f64 = 11.0;
/// A value's part in the prior: two roots, and their gradients by three texels.
const PRIOR: f64 = 20.0;
/// A value that a pyramid halves and interpolates back: two and a half and three operations along a row, one
/// along a column.
const PYRAMID: f64 = 6.5;
/// A value that is scaled by what the weights inside the texture sum to.
const SCALED: f64 = 1.0;
/// tanh of a deviation, and its derivative.
const TANH: f64 = EXP + 4.0 + 3.0;

/// Work of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Floating-point operations of products of matrices and kernels, a multiply-add being two.
    pub flops: f64,
    /// All operations, in the same unit: each is two, as a multiply-add.
    pub operations: f64,
    /// From and to memory.
    pub bytes: f64,
}

impl Cost {
    /// The work of one step.
    pub fn of(kind: Kind, pixels: usize, size: usize) -> Self {
        match kind {
            Kind::WarmUp => warm_up(&paper(), pixels, size),
            Kind::Normals => normals(&paper(), pixels, size),
            Kind::Diffuse => diffuse(pixels, size),
        }
    }
}

/// Multiply-adds of a network: forward, to the weights and to the inputs of every layer but the first.
fn products(config: &PaperConfig) -> [f64; 3] {
    let n = &config.networks;
    let (width, outputs) = (n.width as f64, n.outputs as f64);
    let first = 3.0 * width;
    let rest = (n.hidden_layers as f64 - 1.0) * width * width + width * outputs;
    [first + rest, first + rest, rest]
}

/// Neurons of a network's hidden layers, and its outputs.
fn neurons(config: &PaperConfig) -> [f64; 2] {
    let n = &config.networks;
    [(n.hidden_layers * n.width) as f64, n.outputs as f64]
}

/// A warm-up step: three networks with their gradients; positions, two directions, Fresnel factor,
/// colour and weight of every pixel (14 values); four values per texel.
fn warm_up(config: &PaperConfig, pixels: usize, size: usize) -> Cost {
    let [hidden, outputs] = neurons(config);
    // ReLU, its gate, and the sums for the biases.
    let networks = 3.0 * (3.0 * hidden + outputs);
    let shading = outputs * (EXP + 2.0 * SOFTPLUS + 2.0 + 7.0);
    let sample = networks + shading + COMPOSE + 4.0 * SAMPLED;
    let texel = 4.0 * ADAM + 3.0 * PRIOR;
    let products = 3.0 * products(config).iter().sum::<f64>();
    cost([products, sample, 14.0], pixels, [0.0, texel, 4.0], size)
}

/// A step on normals and specular albedo: two networks and their gradients by the inputs; light
/// vector, normal, view, Fresnel factor, colour, weight, diffuse albedo (22 values); four values per
/// texel, of which three pass through a blur and its transpose, as the blur's pyramid takes them.
fn normals(config: &PaperConfig, pixels: usize, size: usize) -> Cost {
    let [forward, ..] = products(config);
    let [hidden, outputs] = neurons(config);
    let shading = outputs * (2.0 * SOFTPLUS + 2.0 + 4.0);
    let sample = 2.0 * 2.0 * hidden + shading + COMPOSE + DIRECTIONS + 7.0 * SAMPLED;
    let pyramid = Pyramid::new(size, config.fine_tuning.deviation_blur * size as f32);
    // Values of the levels, of which each has a quarter of the last one's.
    let coarse = 0.25f64.powi(pyramid.levels() as i32);
    let halved = (1.0 - coarse) / 0.75;
    let blurs = 2.0 * 2.0 * pyramid.taps() as f64 * coarse;
    let texel = 4.0 * ADAM + 3.0 * (TANH + 2.0 * (PYRAMID * halved + SCALED));
    cost([2.0 * 2.0 * forward, sample, 22.0], pixels, [3.0 * blurs, texel, 4.0], size)
}

/// A step on the diffuse albedo: S_d, specular layer, colour and weight (8 values if S_d has colours).
fn diffuse(pixels: usize, size: usize) -> Cost {
    // Per channel: model, residual and loss; its part of the gradient.
    let sample = 3.0 * (SAMPLED + 6.0);
    cost([0.0, sample, 8.0], pixels, [0.0, 3.0 * (ADAM + PRIOR), 3.0], size)
}

/// Cost of `samples` samples and `size`² texels; `sample` and `texel` are the multiply-adds of products,
/// other operations, and values read or moved of each.
fn cost(sample: [f64; 3], samples: usize, texel: [f64; 3], size: usize) -> Cost {
    let (samples, texels) = (samples as f64, (size * size) as f64);
    let all = |place: usize| samples * sample[place] + texels * texel[place];
    Cost {
        flops: 2.0 * all(0),
        operations: 2.0 * (all(0) + all(1)),
        bytes: (sample[2] * VALUE + PLACE) * samples + texel[2] * MOVED * texels,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_networks_have_the_published_counts() {
        let config = paper();
        assert_eq!(warm_up(&config, 1, 0).flops, 7488.0);
        assert_eq!(normals(&config, 1, 0).flops, 3456.0);
        assert_eq!(warm_up(&config, 10, 0).bytes, 680.0);
        assert_eq!(diffuse(0, 2).bytes, 288.0);
        assert_eq!(warm_up(&config, 1, 0).operations, 9582.0);
        assert_eq!(normals(&config, 1, 0).operations, 5170.0);
    }
}
