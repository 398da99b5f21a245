//! The linear model of the height problem: the change of a sample's colour with its unknowns.

use crate::model::planes::{BLOCK, Row};
use crate::simd::widened;

/// Rows of the sampled unknowns: specular and diffuse deviation, albedo.
pub(super) const UNKNOWNS: usize = 9;
/// Rows of the derivatives of a sample's colour: with respect to n_s (3, the same in every channel), n_d (3 of R, then
/// of G and B) and the diffuse albedo (the diffuse layer, R, G, B).
pub(super) const SLOPES: usize = 15;
/// Least squared norm of a diffuse layer's colour, by which is divided.
const LEAST_SQUARE: f32 = 1e-12;

/// The change of a sample's colour with slopes `s` by its unknowns `q`.
#[inline(always)]
pub(super) fn explained(s: &[f32; SLOPES], q: &[f32; UNKNOWNS]) -> [f32; 3] {
    let highlight = s[0] * q[0] + s[1] * q[1] + s[2] * q[2];
    std::array::from_fn(|c| {
        let slope = &s[3 + 3 * c..];
        let shading = slope[0] * q[3] + slope[1] * q[4] + slope[2] * q[5];
        shading + highlight + s[12 + c] * q[6 + c]
    })
}

/// Removes the share `share` of the component of a colour difference `z` along the diffuse layer, which is mostly an
/// error of that layer: bounce light, shadows, the albedo. A symmetric matrix between the identity (0) and a projection
/// (1).
#[inline(always)]
pub(super) fn without_diffuse_share(z: [f32; 3], s: &[f32; SLOPES], share: f32) -> [f32; 3] {
    let [r, g, b] = [s[12], s[13], s[14]];
    let square = (r * r + g * g + b * b).max(LEAST_SQUARE);
    let along = share * (r * z[0] + g * z[1] + b * z[2]) / square;
    [z[0] - along * r, z[1] - along * g, z[2] - along * b]
}

/// The transpose of [`explained`].
#[inline(always)]
pub(super) fn transposed(s: &[f32; SLOPES], z: [f32; 3]) -> [f32; UNKNOWNS] {
    let all = z[0] + z[1] + z[2];
    let mut q = [0.0; UNKNOWNS];
    for k in 0..3 {
        q[k] = s[k] * all;
        q[3 + k] = s[3 + k] * z[0] + s[6 + k] * z[1] + s[9 + k] * z[2];
        q[6 + k] = s[12 + k] * z[k];
    }
    q
}

widened! {
    /// The normal equations' matrix times the unknowns of a block of samples.
    pub(super) fn normal_block(
        slopes: &[Row; SLOPES],
        weight: &[Row; 1],
        share: f32,
        q: &[Row; UNKNOWNS],
        out: &mut [Row; UNKNOWNS],
    ) {
        for lane in 0..BLOCK {
            let s = std::array::from_fn(|row| slopes[row].0[lane]);
            let q = std::array::from_fn(|row| q[row].0[lane]);
            let colour = without_diffuse_share(explained(&s, &q), &s, share);
            let by = transposed(&s, colour.map(|z| weight[0].0[lane] * z));
            for row in 0..UNKNOWNS {
                out[row].0[lane] = by[row];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: [f32; SLOPES] =
        [0.3, -0.2, 0.5, 0.1, 0.4, -0.6, 0.7, -0.1, 0.2, 0.9, 0.3, -0.4, 0.6, 0.3, 0.2];

    #[test]
    fn transposes() {
        let q = std::array::from_fn(|row| 0.2 * row as f32 - 0.7);
        let z = [0.5, -1.5, 0.8];
        let by_colour: f32 = explained(&S, &q).iter().zip(z).map(|(a, b)| a * b).sum();
        let by_unknowns: f32 = transposed(&S, z).iter().zip(q).map(|(a, b)| a * b).sum();
        assert!((by_colour - by_unknowns).abs() < 1e-6, "{by_colour} {by_unknowns}");
    }

    #[test]
    fn a_share_along_the_diffuse_layer_is_removed() {
        let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        let skin = [S[12], S[13], S[14]];
        assert!(near(without_diffuse_share(skin, &S, 0.6), skin.map(|x| 0.4 * x)));
        // Orthogonal to the colour of skin.
        let other = [0.3, -0.6, 0.0];
        assert!(near(without_diffuse_share(other, &S, 0.6), other));
        assert_eq!(without_diffuse_share([0.1, 0.2, 0.3], &S, 0.0), [0.1, 0.2, 0.3]);
        assert_eq!(without_diffuse_share([0.1, 0.2, 0.3], &[0.0; SLOPES], 0.6), [0.1, 0.2, 0.3]);
    }
}
