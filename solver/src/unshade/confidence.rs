//! The confidence in the albedo of a texel: high where it is visible, lit, and has small residuals.

use crate::model::blur::Blur;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::CHANNELS;

/// Residual, relative to the colour, at which the confidence falls to 1 / e.
const MISFIT: f32 = 0.1;
/// Standard deviation of the blur of the sums over samples, texels.
const BLUR: f32 = 1.5;
/// Relative standard deviations of the albedo after one factor where there is no confidence, of skin and of other
/// regions: 68 % of the errors of the tuning faces lie within the deviations of [`deviation`].
const UNKNOWN_SKIN: f32 = 0.12;
const UNKNOWN_ELSEWHERE: f32 = 0.4;

/// The weight of the pictures against the albedo prior in every texel of the samples' texture, 0 to 1: q / (1 + q),
/// where q is the sum of weight x S_d over that of a prior of this weight. `shading` has S_d of R, G, B.
pub(super) fn picture_weight(prior_weight: f32, samples: &Samples, shading: &Planes) -> Vec<f32> {
    let size = samples.taps.size();
    let lights = Planes::from_fn(samples.len(), |i| {
        let shading: [f32; CHANNELS] = shading.sample(i, 0);
        [samples.weight.get(0, i) * shading.iter().sum::<f32>() / 3.0]
    });
    let pull =
        (size * size) as f32 / (samples.len().max(1) as f32 * prior_weight.max(f32::MIN_POSITIVE));
    blurred::<1>(samples, &lights).iter().map(|light| pull * light / (1.0 + pull * light)).collect()
}

/// The confidence in every texel of the samples' texture, 0 to 1: [`picture_weight`] x exp(-r / [`MISFIT`]), r being
/// the mean absolute residual over the mean colour. The target of `samples` has no highlights, `pictures` have them;
/// `diffuse` is the albedo at every sample.
pub(super) fn confidence(
    prior_weight: f32,
    samples: &Samples,
    pictures: &Planes,
    shading: &Planes,
    diffuse: &Planes,
) -> Vec<f32> {
    let parts = Planes::from_fn(samples.len(), |i| {
        let [shading, albedo, target]: [[f32; CHANNELS]; 3] =
            [shading, diffuse, &samples.target].map(|planes| planes.sample(i, 0));
        let picture: [f32; CHANNELS] = pictures.sample(i, 0);
        let weight = samples.weight.get(0, i) / 3.0;
        let sum = |value: &dyn Fn(usize) -> f32| weight * (0..CHANNELS).map(value).sum::<f32>();
        [sum(&|c| (albedo[c] * shading[c] - target[c]).abs()), sum(&|c| picture[c].abs())]
    });
    let sums = blurred::<2>(samples, &parts);
    let explained =
        |[misfit, colour]: &[f32; 2]| (-misfit / colour.max(f32::MIN_POSITIVE) / MISFIT).exp();
    let weights = picture_weight(prior_weight, samples, shading);
    sums.as_chunks::<2>().0.iter().zip(weights).map(|(sums, q)| q * explained(sums)).collect()
}

/// The relative standard deviation of the albedo of a texel with this confidence: it falls in proportion, in all lights
/// and on all of the tuning faces.
pub(super) fn deviation(confidence: f32, is_skin: bool) -> f32 {
    (1.0 - confidence) * if is_skin { UNKNOWN_SKIN } else { UNKNOWN_ELSEWHERE }
}

/// The blurred sums over the samples of every texel.
fn blurred<const N: usize>(samples: &Samples, parts: &Planes) -> Vec<f32> {
    Blur::new(samples.taps.size(), N, BLUR).apply(&samples.taps.gather::<N>(parts, 0))
}
