//! Shading of a block of samples and its adjoint: activations, products with the light vector,
//! composition with the albedos, L1 loss.

use super::lanes::{self, Lanes};
use crate::model::planes::{BLOCK, Row};

/// Replaces z by e^z.
#[inline(always)]
pub fn exponentials<S: Lanes>(rows: &mut [Row]) {
    for row in rows {
        let mut at = 0;
        while at < BLOCK {
            for (k, value) in lanes::exp(load::<S, TURNS>(row, at)).into_iter().enumerate() {
                value.store(row, at + k * S::WIDTH);
            }
            at += TURNS * S::WIDTH;
        }
    }
}

/// Replaces z by softplus(z), and writes its derivative to `slopes`.
#[inline(always)]
pub fn softplus<S: Lanes>(rows: &mut [Row], slopes: &mut [Row]) {
    for (row, slopes) in rows.iter_mut().zip(slopes) {
        let mut at = 0;
        while at < BLOCK {
            let (values, derivatives) = lanes::softplus(load::<S, TURNS>(row, at));
            for (k, (value, slope)) in values.into_iter().zip(derivatives).enumerate() {
                value.store(row, at + k * S::WIDTH);
                slope.store(slopes, at + k * S::WIDTH);
            }
            at += TURNS * S::WIDTH;
        }
    }
}

/// Interleaved vectors, which hide the latency of each other's operations.
const TURNS: usize = 4;

#[inline(always)]
fn load<S: Lanes, const T: usize>(row: &Row, at: usize) -> [S; T] {
    let mut values = [S::splat(0.0); T];
    for (k, value) in values.iter_mut().enumerate() {
        *value = S::load(row, at + k * S::WIDTH);
    }
    values
}

/// out = sum of a x b over rows.
#[inline(always)]
pub fn dot<S: Lanes>(a: &[Row], b: &[Row], out: &mut Row) {
    let mut at = 0;
    while at < BLOCK {
        let mut sum = S::splat(0.0);
        for (a, b) in a.iter().zip(b) {
            sum = S::load(a, at).mul_add(S::load(b, at), sum);
        }
        sum.store(out, at);
        at += S::WIDTH;
    }
}

/// A kernel's shading = sum of light x softplus(z) over rows; replaces z by the gradient with respect to z.
#[inline(always)]
pub fn kernel<S: Lanes>(light: &[Row], kernel: &mut [Row], shading: &mut Row) {
    // AVX-512 has registers for more rows at once.
    if S::WIDTH == 16 {
        kernel_in_turns::<S, 8>(light, kernel, shading);
    } else {
        kernel_in_turns::<S, TURNS>(light, kernel, shading);
    }
}

#[inline(always)]
fn kernel_in_turns<S: Lanes, const T: usize>(light: &[Row], kernel: &mut [Row], shading: &mut Row) {
    let mut at = 0;
    while at < BLOCK {
        let mut sums = [S::splat(0.0); T];
        for (light, z) in light.iter().zip(&mut *kernel) {
            let (values, slopes) = lanes::softplus(load::<S, T>(z, at));
            for (k, (value, slope)) in values.into_iter().zip(slopes).enumerate() {
                let light = S::load(light, at + k * S::WIDTH);
                sums[k] = light.mul_add(value, sums[k]);
                light.mul(slope).store(z, at + k * S::WIDTH);
            }
        }
        for (k, sum) in sums.into_iter().enumerate() {
            sum.store(shading, at + k * S::WIDTH);
        }
        at += T * S::WIDTH;
    }
}

/// Multiplies rows by a factor.
#[inline(always)]
pub fn times<S: Lanes>(rows: &mut [Row], factor: &Row) {
    for row in rows {
        let mut at = 0;
        while at < BLOCK {
            S::load(row, at).mul(S::load(factor, at)).store(row, at);
            at += S::WIDTH;
        }
    }
}

/// Replaces the outputs of all three networks by the gradients before their last activations.
#[inline(always)]
pub fn vector_gradients<S: Lanes>(
    by_shading: &[Row; 2],
    slopes: &[Vec<Row>; 2],
    light: &mut [Row],
    diffuse: &mut [Row],
    specular: &mut [Row],
) {
    let [diffuse_shading, specular_shading] = by_shading;
    for (k, light) in light.iter_mut().enumerate() {
        let mut at = 0;
        while at < BLOCK {
            let (by_diffuse, by_specular) =
                (S::load(diffuse_shading, at), S::load(specular_shading, at));
            let (slope_diffuse, slope_specular) =
                (S::load(&slopes[0][k], at), S::load(&slopes[1][k], at));
            let (l, d) = (S::load(light, at), S::load(&diffuse[k], at));
            let by_light = by_diffuse.mul_add(d, by_specular.mul(S::load(&specular[k], at)));
            l.mul(by_light).store(light, at);
            by_diffuse.mul(l).mul(slope_diffuse).store(&mut diffuse[k], at);
            by_specular.mul(l).mul(slope_specular).store(&mut specular[k], at);
            at += S::WIDTH;
        }
    }
}

/// Colours and weights of a block's pixels.
pub struct Pixels<'a> {
    /// Diffuse R, G, B.
    pub albedo: &'a [Row],
    pub specular: &'a Row,
    pub fresnel: &'a Row,
    pub target: &'a [Row],
    pub weight: &'a Row,
    /// One over the number of terms of the mean.
    pub scale: f32,
}

/// Gradients with respect to the two shadings and the albedos of a block.
pub struct PixelGradient {
    pub shading: [Row; 2],
    pub albedo: [Row; 4],
}

/// The loss of A_d S_d + F A_s S_s against the target: mean of weight x |residual|. The derivative
/// of |x| at 0 is 0.
#[inline(always)]
pub fn compose<S: Lanes>(pixels: &Pixels, shading: &[Row; 2], gradient: &mut PixelGradient) -> f64 {
    let zero = S::splat(0.0);
    let mut loss = zero;
    let mut at = 0;
    while at < BLOCK {
        let (diffuse, specular) = (S::load(&shading[0], at), S::load(&shading[1], at));
        let (fresnel, weight) = (S::load(pixels.fresnel, at), S::load(pixels.weight, at));
        let strength = fresnel.mul(S::load(pixels.specular, at));
        let highlight = strength.mul(specular);
        let push = weight.mul(S::splat(pixels.scale));
        let (mut by_highlight, mut by_diffuse) = (zero, zero);
        for channel in 0..3 {
            let albedo = S::load(&pixels.albedo[channel], at);
            let target = S::load(&pixels.target[channel], at);
            let residual = albedo.mul_add(diffuse, highlight).sub(target);
            loss = weight.mul_add(residual.abs(), loss);
            let sign = push.where_positive(residual).sub(push.where_positive(zero.sub(residual)));
            by_highlight = by_highlight.add(sign);
            by_diffuse = sign.mul_add(albedo, by_diffuse);
            sign.mul(diffuse).store(&mut gradient.albedo[channel], at);
        }
        by_diffuse.store(&mut gradient.shading[0], at);
        by_highlight.mul(strength).store(&mut gradient.shading[1], at);
        by_highlight.mul(fresnel).mul(specular).store(&mut gradient.albedo[3], at);
        at += S::WIDTH;
    }
    let mut row = Row::ZERO;
    loss.store(&mut row, 0);
    row.0[..S::WIDTH].iter().map(|lane| f64::from(*lane)).sum::<f64>() * f64::from(pixels.scale)
}
