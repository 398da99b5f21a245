//! Protocols of other benchmarks to the letter, what is odd in them included, so that a score here
//! can stand beside one there. Each prepares both pictures in its own way; what comes out is a
//! squared error per pixel whose mean over the region is theirs.

use super::Pair;
use super::colour::{luminance, srgb};
use super::pair::triple;

/// The publication whose protocol is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Protocol {
    /// Stanford-ORB's PSNR-H: one factor per channel, linear values up to 4, the exposure that makes
    /// the truth's mean that of its sRGB values.
    OrbHdr,
    /// Stanford-ORB's PSNR-L: one factor per channel, sRGB values.
    OrbLdr,
    /// Stanford-ORB's PSNR of an albedo: one factor per channel, linear values up to 1.
    OrbAlbedo,
    /// The relit PSNR of objects-with-lighting: exposure and colour balance are searched.
    ObjectsWithLighting,
    /// NeRFactor's PSNR of an albedo: one factor per channel, luma of values to the power 1 / 2.2.
    NerfactorAlbedo,
}

/// The gamma of objects-with-lighting and NeRFactor.
const GAMMA: f64 = 2.2;

impl Protocol {
    /// A squared error for each pixel of the region.
    pub(super) fn errors(self, pair: &Pair) -> Vec<f64> {
        let pixels = pair.region().pixels();
        let p: Vec<[f64; 3]> = pixels.iter().map(|i| triple(pair.predicted(*i))).collect();
        let g: Vec<[f64; 3]> = pixels.iter().map(|i| triple(pair.true_values(*i))).collect();
        let (width, height) = pair.region().size();
        // Stanford-ORB and NeRFactor divide by the whole frame, whose background is right.
        let frame_fraction = p.len() as f64 / (width * height) as f64;
        match self {
            Self::OrbHdr => orb(p, g, frame_fraction, 4.0, true, |value| value),
            Self::OrbLdr => orb(p, g, frame_fraction, 1.0, false, srgb),
            Self::OrbAlbedo => orb(p, g, frame_fraction, 1.0, false, |value| value),
            Self::ObjectsWithLighting => objects_with_lighting(p, &g),
            Self::NerfactorAlbedo => nerfactor(p, g, frame_fraction),
        }
    }
}

fn orb(
    mut p: Vec<[f64; 3]>,
    mut g: Vec<[f64; 3]>,
    frame_fraction: f64,
    maximum: f64,
    expose: bool,
    curve: fn(f64) -> f64,
) -> Vec<f64> {
    g.iter_mut().flatten().for_each(|value| *value = value.max(0.0));
    let sum = |of: &dyn Fn(f64) -> f64| g.iter().flatten().map(|value| of(*value)).sum::<f64>();
    let linear = sum(&|value| value.clamp(0.0, 1.0));
    if expose && linear * frame_fraction / (3 * g.len()) as f64 > 1e-8 {
        let factor = sum(&srgb) / linear;
        p.iter_mut().chain(&mut g).flatten().for_each(|value| *value *= factor);
    }
    for c in 0..3 {
        let factor = channel_factor(&p, &g, c, 1e-6);
        p.iter_mut().for_each(|pixel| pixel[c] *= factor);
    }
    let seen = |value: f64| curve(value.clamp(0.0, maximum));
    let grey = 0.5;
    let mean = |square: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..g.len())
            .map(|i| frame_fraction / 3.0 * (0..3).map(|c| square(i, c)).sum::<f64>())
            .collect()
    };
    let found = mean(&|i, c| (seen(p[i][c]) - seen(g[i][c])).powi(2));
    // No score is below that of a picture of grey.
    let floor = mean(&|i, c| (grey - seen(g[i][c])).powi(2));
    if found.iter().sum::<f64>() > floor.iter().sum::<f64>() { floor } else { found }
}

/// <p, g> / <p, p> of a channel; of one that is all but black the mean of g.
fn channel_factor(p: &[[f64; 3]], g: &[[f64; 3]], c: usize, threshold: f64) -> f64 {
    let square: f64 = p.iter().map(|p| p[c] * p[c]).sum();
    if square <= threshold {
        return g.iter().map(|g| g[c]).sum::<f64>() / g.len() as f64;
    }
    p.iter().zip(g).map(|(p, g)| p[c] * g[c]).sum::<f64>() / square
}

/// The truth is an 8-bit picture of power 1 / 2.2. Where it is not overexposed, the exposure with
/// the least mean absolute error is searched, then each channel's factor from .5 to 2.
///
/// A factor before the power is its power after it, so that the power is taken once.
fn objects_with_lighting(mut p: Vec<[f64; 3]>, g: &[[f64; 3]]) -> Vec<f64> {
    let power = |value: f64| value.max(0.0).powf(1.0 / GAMMA);
    let eight = |value: f64| (power(value).min(1.0) * 255.0).round() / 255.0;
    let g: Vec<[f64; 3]> = g.iter().map(|pixel| pixel.map(eight)).collect();
    let fitted: Vec<usize> = (0..g.len()).filter(|i| g[*i].iter().all(|v| *v < 1.0)).collect();
    let darkest = fitted
        .iter()
        .map(|i| p[*i].iter().copied().fold(f64::INFINITY, f64::min))
        .filter(|value| *value > 0.0)
        .fold(f64::INFINITY, f64::min);
    p.iter_mut().flatten().for_each(|value| *value = power(*value));
    if darkest.is_finite() {
        let channels = |of: &[[f64; 3]]| {
            [0, 1, 2].map(|c| fitted.iter().map(|i| of[*i][c]).collect::<Vec<f64>>())
        };
        let (powers, truths) = (channels(&p), channels(&g));
        let error = |c: usize, factor: f64| absolute_error(&powers[c], &truths[c], factor);
        let max_stops = (0.95_f64.powf(GAMMA) / darkest).log2();
        let all = |stops: f64| (0..3).map(|c| error(c, power(stops.exp2()))).sum();
        let exposure = power(argmin(all, -10.0, max_stops).exp2());
        for c in 0..3 {
            let balance = argmin(|factor| error(c, exposure * power(factor)), 0.5, 2.0);
            let factor = exposure * power(balance);
            p.iter_mut().for_each(|pixel| pixel[c] *= factor);
        }
    }
    let square = |(p, g): (&[f64; 3], &[f64; 3])| {
        (0..3).map(|c| (p[c].min(1.0) - g[c]).powi(2)).sum::<f64>() / 3.0
    };
    p.iter().zip(&g).map(square).collect()
}

/// The sum of |min(p factor, 1) - g|, in lanes that a processor adds at once.
fn absolute_error(p: &[f64], g: &[f64], factor: f64) -> f64 {
    const LANES: usize = 8;
    let error = |p: f64, g: f64| ((p * factor).min(1.0) - g).abs();
    let (chunks_p, chunks_g) = (p.chunks_exact(LANES), g.chunks_exact(LANES));
    let rest = chunks_p.remainder().iter().zip(chunks_g.remainder());
    let rest: f64 = rest.map(|(p, g)| error(*p, *g)).sum();
    let mut lanes = [0.0; LANES];
    for (p, g) in chunks_p.zip(chunks_g) {
        for (lane, sum) in lanes.iter_mut().enumerate() {
            *sum += error(p[lane], g[lane]);
        }
    }
    lanes.iter().sum::<f64>() + rest
}

/// Minimises a function: the best of a scan, then a golden-section search around it.
fn argmin(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    const STEPS: usize = 32;
    let at = |step: usize| low + (high - low) * step as f64 / STEPS as f64;
    let best = (0..=STEPS)
        .map(|step| (step, function(at(step))))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(step, _)| step);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (at(best.saturating_sub(1)), at((best + 1).min(STEPS)));
    let inner = |a: f64, b: f64| [b - golden * (b - a), a + golden * (b - a)];
    let [mut left, mut right] = inner(a, b).map(|x| (x, function(x)));
    for _ in 0..40 {
        if left.1 < right.1 {
            (b, right) = (right.0, left);
            let x = inner(a, b)[0];
            left = (x, function(x));
        } else {
            (a, left) = (left.0, right);
            let x = inner(a, b)[1];
            right = (x, function(x));
        }
    }
    0.5 * (a + b)
}

/// Both stand on white and lie within the truth's range; luma is of values to the power 1 / 2.2.
fn nerfactor(mut p: Vec<[f64; 3]>, g: Vec<[f64; 3]>, frame_fraction: f64) -> Vec<f64> {
    let background = if frame_fraction < 1.0 { 1.0 } else { f64::NEG_INFINITY };
    let top = g.iter().flatten().copied().fold(background, f64::max);
    let bottom = g.iter().flatten().copied().fold(top, f64::min);
    for c in 0..3 {
        let factor = channel_factor(&p, &g, c, 0.0);
        p.iter_mut().for_each(|pixel| pixel[c] *= factor);
    }
    let luma = |pixel: &[f64; 3]| luminance(pixel.iter().map(|v| v.max(0.0).powf(1.0 / GAMMA)));
    let square = |(p, g): (&[f64; 3], &[f64; 3])| {
        frame_fraction * (luma(&p.map(|value| value.clamp(bottom, top))) - luma(g)).powi(2)
    };
    p.iter().zip(&g).map(square).collect()
}
