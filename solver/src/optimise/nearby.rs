//! What the pictures leave around every sample: what of it is too coarse for relief, and what is too much.

use glam::Vec3;

use super::relief::SLOPES;
use crate::convolution::Shape;
use crate::gbuffer::{GBuffer, blurred};
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// What skin's relief (radians) and the detail of its albedo (relative) usually amount to.
const RELIEF: f32 = 0.05;
const PAINT: f32 = 0.03;
/// Standard deviation of the neighbourhood in which residuals are compared with what these explain,
/// pixels.
const NEIGHBOURHOOD: f32 = 3.0;

/// The share of `left` around every sample that relief and paint of the usual strength would explain, at
/// most 1: the rest is what the model gets wrong, along shadow edges and hairlines and in the ears.
/// `floor` is the radiance that always counts as explained.
pub(super) fn trust_in(
    samples: &Samples,
    views: &[GBuffer],
    slopes: &Planes,
    left: &Planes,
    floor: f32,
) -> Planes {
    let squares = Planes::from_fn(samples.len(), |i| {
        let (s, left): ([f32; SLOPES], [f32; 3]) = (slopes.sample(i, 0), left.sample(i, 0));
        let usual = |c: usize| {
            let bend = Vec3::from_slice(&s) + Vec3::from_slice(&s[3 + 3 * c..]);
            // Half of a bend's square lies along the slope.
            0.5 * RELIEF * RELIEF * bend.length_squared()
                + (PAINT * s[12 + c]).powi(2)
                + floor * floor
        };
        [left.iter().map(|z| z * z).sum(), (0..3).map(usual).sum(), 0.0]
    });
    let around = around(samples, views, &squares, |_| NEIGHBOURHOOD);
    Planes::from_fn(samples.len(), |i| {
        let [left, usual]: [f32; 2] = around.sample(i, 0);
        [(usual / left.max(f32::MIN_POSITIVE)).min(1.0)]
    })
}

/// `residual` (3 rows) less its own blur over the covered pixels, by a share of the side of a square as large
/// as these; 0 keeps all.
pub(super) fn without_coarse(
    samples: &Samples,
    views: &[GBuffer],
    residual: &Planes,
    share: f32,
) -> Planes {
    if share == 0.0 {
        return residual.clone();
    }
    let sigma = |view: &GBuffer| share * (view.len() as f32).sqrt();
    let coarse = around(samples, views, residual, sigma);
    Planes::from_fn(samples.len(), |i| {
        let (fine, coarse): ([f32; 3], [f32; 3]) = (residual.sample(i, 0), coarse.sample(i, 0));
        std::array::from_fn::<f32, 3, _>(|c| fine[c] - coarse[c])
    })
}

/// Of two residuals (3 rows) mostly the smaller one, sample by sample: each weighted by the other's mean
/// square around the sample.
pub(super) fn smaller(samples: &Samples, views: &[GBuffer], a: Planes, b: &Planes) -> Planes {
    let square = |of: &Planes, i: usize| of.sample::<3>(i, 0).iter().map(|z| z * z).sum::<f32>();
    let squares = Planes::from_fn(samples.len(), |i| [square(&a, i), square(b, i), 0.0]);
    let around = around(samples, views, &squares, |_| NEIGHBOURHOOD);
    Planes::from_fn(samples.len(), |i| {
        let [by_a, by_b]: [f32; 2] = around.sample(i, 0);
        let share = by_b / (by_a + by_b).max(f32::MIN_POSITIVE);
        std::array::from_fn::<f32, 3, _>(|c| share * a.get(c, i) + (1.0 - share) * b.get(c, i))
    })
}

/// Three rows of values, blurred over the covered pixels of every view by `sigma` pixels of its.
fn around(
    samples: &Samples,
    views: &[GBuffer],
    values: &Planes,
    sigma: impl Fn(&GBuffer) -> f32,
) -> Planes {
    // The values and the cover of every view.
    let shape = |view: &GBuffer| Shape { width: view.width, height: view.height, channels: 4 };
    let mut pictures: Vec<Vec<f32>> =
        views.iter().map(|view| vec![0.0; 4 * view.width * view.height]).collect();
    for (i, (view, pixel)) in samples.view_index.iter().zip(&samples.pixel).enumerate() {
        let [a, b, c]: [f32; 3] = values.sample(i, 0);
        pictures[*view as usize][4 * *pixel as usize..][..4].copy_from_slice(&[a, b, c, 1.0]);
    }
    for (picture, view) in pictures.iter_mut().zip(views) {
        *picture = blurred(picture, shape(view), sigma(view));
    }
    Planes::from_fn(samples.len(), |i| {
        let (view, pixel) = (samples.view_index[i], samples.pixel[i]);
        let sums = &pictures[view as usize][4 * pixel as usize..][..4];
        let cover = sums[3].max(f32::MIN_POSITIVE);
        std::array::from_fn::<f32, 3, _>(|row| sums[row] / cover)
    })
}
