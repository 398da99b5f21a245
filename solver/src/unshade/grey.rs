//! The prior on grey shading, which resolves the ambiguity of a tint of the light and a tint of the albedo.

use rayon::prelude::*;

use crate::transport::CHANNELS;

/// Weight of the squared deviation of the mean shading from grey.
const MEAN: f64 = 1.0;
/// Weight of the mean absolute deviation of each texel's shading from grey.
const TEXEL: f64 = 0.001;

/// Returns the penalty on a shading, R, G, B per texel, and adds its gradient to `gradient`.
pub(super) fn grey_prior(shading: &[f32], gradient: &mut [f32]) -> f64 {
    let (texels, _) = shading.as_chunks::<CHANNELS>();
    let count = texels.len() as f64;
    let sums: Vec<[f64; CHANNELS]> = texels
        .par_chunks(1 << 12)
        .map(|part| std::array::from_fn(|c| part.iter().map(|texel| f64::from(texel[c])).sum()))
        .collect();
    let means: [f64; CHANNELS] =
        std::array::from_fn(|c| sums.iter().map(|sum| sum[c]).sum::<f64>() / count);
    let mean = means.iter().sum::<f64>() / CHANNELS as f64;
    let off = means.map(|m| m / mean - 1.0);
    let pull = off.iter().zip(means).map(|(off, m)| off * m).sum::<f64>() / mean;
    let by_mean =
        off.map(|off| (2.0 * MEAN * (off - pull / CHANNELS as f64) / (mean * count)) as f32);
    let scale = (TEXEL / (CHANNELS as f64 * count)) as f32;
    let parts: Vec<f64> = gradient
        .par_chunks_mut(CHANNELS << 12)
        .zip(texels.par_chunks(1 << 12))
        .map(|(gradient, texels)| {
            let mut sum = 0.0;
            for (gradient, texel) in gradient.chunks_exact_mut(CHANNELS).zip(texels) {
                let grey = texel.iter().sum::<f32>() / CHANNELS as f32;
                let signs = texel.map(|s| if s == grey { 0.0 } else { (s - grey).signum() });
                let mean_sign = signs.iter().sum::<f32>() / CHANNELS as f32;
                // A texel without light has no colour.
                let inverse = if grey > 0.0 { 1.0 / grey } else { 0.0 };
                for c in 0..CHANNELS {
                    sum += f64::from((texel[c] - grey).abs() * inverse);
                    // The divisor is treated as a constant.
                    gradient[c] += by_mean[c] + scale * (signs[c] - mean_sign) * inverse;
                }
            }
            sum
        })
        .collect();
    MEAN * off.iter().map(|off| off * off).sum::<f64>()
        + TEXEL * parts.iter().sum::<f64>() / (CHANNELS as f64 * count)
}
