//! Metrics that look at a pixel's neighbourhood. They read the whole picture, so that outside
//! the region both pictures should agree (`black_outside`).

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8};

use super::Pair;
use super::filter::gaussian;

/// Standard deviation of the split into low and high frequencies, as a share of the width:
/// 8 texels of a 512² map.
const SPLIT: f64 = 1.0 / 64.0;

/// SSIM map (Wang et al. 2004) of the sRGB values, mean over the channels: Gaussian window of
/// 11x11 and sigma 1.5, K = .01, .03, range 1, population covariance.
pub(super) fn ssim(pair: &Pair) -> Vec<f64> {
    let (width, height) = (pair.truth.width, pair.truth.height);
    let channels = pair.truth.channels;
    let mut total = vec![0.0; width * height];
    for channel in 0..channels {
        let [x, y] = [0, 1].map(|which| -> Vec<f64> {
            pair.srgb()[which].iter().skip(channel).step_by(channels).copied().collect()
        });
        let product = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let product: Vec<f64> = a.iter().zip(b).map(|(a, b)| a * b).collect();
            gaussian(&product, width, height, 1.5, 5)
        };
        let [xx, yy, xy] = [product(&x, &x), product(&y, &y), product(&x, &y)];
        let [mx, my] = [&x, &y].map(|v| gaussian(v, width, height, 1.5, 5));
        let (c1, c2) = (0.01_f64.powi(2), 0.03_f64.powi(2));
        for (i, total) in total.iter_mut().enumerate() {
            let (a, b) = (mx[i], my[i]);
            let structure = 2.0 * (xy[i] - a * b) + c2;
            let contrast = xx[i] - a * a + yy[i] - b * b + c2;
            *total += (2.0 * a * b + c1) * structure / ((a * a + b * b + c1) * contrast);
        }
    }
    let mean = |i: &usize| total[*i] / channels as f64;
    pair.region.pixels().iter().map(mean).collect()
}

/// LDR-FLIP map (Andersson et al. 2020) of 8-bit sRGB pictures at 67.02 pixels per degree.
pub(super) fn flip(pair: &Pair) -> Vec<f64> {
    let (width, height) = (pair.truth.width, pair.truth.height);
    let [test, truth] = [0, 1].map(|which| {
        let bytes: Vec<u8> =
            pair.srgb()[which].iter().map(|value| (value * 255.0).round() as u8).collect();
        FlipImageRgb8::with_data(width as u32, height as u32, &bytes)
    });
    let map = nv_flip::flip(truth, test, DEFAULT_PIXELS_PER_DEGREE).to_vec();
    pair.region.pixels().iter().map(|i| f64::from(map[*i])).collect()
}

/// High-pass log luminance of prediction and truth, interleaved.
pub(super) fn high_pass(pair: &Pair) -> Vec<f64> {
    let [x, y] = pair.log_luminances();
    let [low_x, low_y] = means_of(pair, [x, y], split(pair));
    (0..x.len()).flat_map(|i| [x[i] - low_x[i], y[i] - low_y[i]]).collect()
}

/// Log luminance of prediction and truth between Gaussian means of `sigma` and of twice that,
/// interleaved.
pub(super) fn band(pair: &Pair, sigma: f64) -> Vec<f64> {
    let [x, y] = pair.log_luminances();
    let [[fine_x, fine_y], [coarse_x, coarse_y]] =
        [sigma, 2.0 * sigma].map(|sigma| means_of(pair, [x, y], sigma));
    (0..x.len()).flat_map(|i| [fine_x[i] - coarse_x[i], fine_y[i] - coarse_y[i]]).collect()
}

/// Low-pass difference of the log luminances.
pub(super) fn low_pass_error(pair: &Pair) -> Vec<f64> {
    let [x, y] = pair.log_luminances();
    let difference: Vec<f64> = x.iter().zip(y).map(|(x, y)| x - y).collect();
    let [low] = means_of(pair, [&difference], split(pair));
    low
}

/// Between low and high frequencies, texels.
fn split(pair: &Pair) -> f64 {
    SPLIT * pair.region.size().0 as f64
}

/// Gaussian means over the pixels of the region alone.
fn means_of<const N: usize>(pair: &Pair, values: [&[f64]; N], sigma: f64) -> [Vec<f64>; N] {
    let (width, height) = pair.region.size();
    let pixels = pair.region.pixels();
    let radius = (3.0 * sigma).ceil() as usize;
    let spread = |of: &dyn Fn(usize) -> f64| {
        let mut picture = vec![0.0; width * height];
        pixels.iter().enumerate().for_each(|(slot, i)| picture[*i] = of(slot));
        gaussian(&picture, width, height, sigma, radius)
    };
    let weight = spread(&|_| 1.0);
    values.map(|values| {
        let sum = spread(&|slot| values[slot]);
        pixels.iter().map(|i| sum[*i] / weight[*i]).collect()
    })
}
