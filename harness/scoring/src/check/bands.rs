//! The pattern of a coloured map: what is left when its slow changes (shading, exposure, the tint
//! of a light) are taken away, so that an albedo can be compared with photographs.

use super::reduced::{Reduced, SIDE, median};
use crate::metrics::gaussian;

/// Widths of what is taken away, texels: pores and the edges of lips; brows and cheeks.
const SIGMAS: [f64; 2] = [2.0, 6.0];
/// Deviations beyond so many standard deviations say no more: highlights, shadow edges.
const CLIP: f64 = 3.0;
/// Share of the median below which a value is noise.
const DARK: f64 = 1e-3;
/// Fewest texels that say something, as a fraction of the map.
const MIN_FRACTION: f64 = 0.02;

/// Planes of unit variance: luminance and red over blue, each in two bands.
pub(super) struct Bands {
    planes: Vec<Vec<f64>>,
    mask: Vec<bool>,
}

impl Bands {
    /// The bands of a three-channel map where `mask` holds and it has values.
    pub fn of(map: &Reduced, values: &[f32], valid: &[bool], mask: &[bool]) -> Self {
        let mask: Vec<bool> = mask.iter().zip(valid).map(|(mask, valid)| *mask && *valid).collect();
        let texels = || (0..SIDE * SIDE).filter(|texel| mask[*texel]);
        let greens = texels().map(|texel| values[texel * map.channels + 1].abs());
        let floor = (median(greens).unwrap_or(0.0) * DARK).max(f64::MIN_POSITIVE);
        let log = |texel: usize, channel: usize| {
            f64::from(values[texel * map.channels + channel]).max(floor).ln()
        };
        let inside: Vec<f64> = mask.iter().map(|mask| f64::from(u8::from(*mask))).collect();
        let plane = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..SIDE * SIDE).map(|texel| if mask[texel] { of(texel) } else { 0.0 }).collect()
        };
        let luminance = plane(&|t| (log(t, 0) + log(t, 1) + log(t, 2)) / 3.0);
        let chroma = plane(&|t| log(t, 0) - log(t, 2));
        let mut planes = Vec::new();
        for sigma in SIGMAS {
            let blur = |plane: &[f64]| gaussian(plane, SIDE, SIDE, sigma, (3.0 * sigma) as usize);
            let weight = blur(&inside);
            for plane in [&luminance, &chroma] {
                let mean = blur(plane);
                let mut band: Vec<f64> = (0..SIDE * SIDE)
                    .map(|t| if mask[t] { plane[t] - mean[t] / weight[t].max(1e-9) } else { 0.0 })
                    .collect();
                let count = texels().count().max(1) as f64;
                let deviation = (band.iter().map(|v| v * v).sum::<f64>() / count).sqrt();
                // A constant has no pattern, whatever rounding leaves of it.
                let scale = if deviation > 1e-5 { deviation.recip() } else { 0.0 };
                band.iter_mut().for_each(|v| *v = (*v * scale).clamp(-CLIP, CLIP));
                planes.push(band);
            }
        }
        Self { planes, mask }
    }

    /// Mean correlation of the bands of two maps where both have values, -1 to 1; 0 where there
    /// is too little to say.
    pub fn correlation(&self, other: &Self) -> f64 {
        let mask: Vec<usize> = both(&self.mask, &other.mask);
        let pairs = self.planes.iter().zip(&other.planes);
        mean(pairs.map(|(a, b)| pearson(&mask, |t| a[t], |t| b[t])), self.planes.len())
    }

    /// [`Self::correlation`] of the parts that are not their own mirror image in u: faces are
    /// nearly so, and lights need not be.
    pub fn asymmetry(&self, other: &Self) -> f64 {
        let mirror = |t: usize| t - t % SIDE + (SIDE - 1 - t % SIDE);
        let mut mask = both(&self.mask, &other.mask);
        mask.retain(|t| self.mask[mirror(*t)] && other.mask[mirror(*t)]);
        let odd = |plane: &[f64], t: usize| plane[t] - plane[mirror(t)];
        let pairs = self.planes.iter().zip(&other.planes);
        mean(pairs.map(|(a, b)| pearson(&mask, |t| odd(a, t), |t| odd(b, t))), self.planes.len())
    }

    /// Correlation of the colour alone (red over blue).
    pub fn chroma_correlation(&self, other: &Self) -> f64 {
        let mask = both(&self.mask, &other.mask);
        let pairs = self.planes.iter().zip(&other.planes).skip(1).step_by(2);
        mean(pairs.map(|(a, b)| pearson(&mask, |t| a[t], |t| b[t])), SIGMAS.len())
    }
}

fn both(a: &[bool], b: &[bool]) -> Vec<usize> {
    (0..a.len()).filter(|texel| a[*texel] && b[*texel]).collect()
}

fn mean(values: impl Iterator<Item = f64>, count: usize) -> f64 {
    values.sum::<f64>() / count.max(1) as f64
}

/// 0 where one of them is constant or too little is known.
fn pearson(texels: &[usize], a: impl Fn(usize) -> f64, b: impl Fn(usize) -> f64) -> f64 {
    if (texels.len() as f64) < MIN_FRACTION * (SIDE * SIDE) as f64 {
        return 0.0;
    }
    let count = texels.len() as f64;
    let mean = |of: &dyn Fn(usize) -> f64| texels.iter().map(|t| of(*t)).sum::<f64>() / count;
    let (mean_a, mean_b) = (mean(&a), mean(&b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for t in texels {
        let (a, b) = (a(*t) - mean_a, b(*t) - mean_b);
        ab += a * b;
        aa += a * a;
        bb += b * b;
    }
    let scale = (aa * bb).sqrt();
    if scale > 1e-9 { ab / scale } else { 0.0 }
}
