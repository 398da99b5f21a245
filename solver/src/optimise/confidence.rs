//! How far the albedo of a texel may be trusted: it was seen, in light, and what was seen is
//! explained.

use crate::config::TransportConfig;
use crate::model::blur::Blur;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// Trust in every texel of the samples' texture, 0 to 1: q / (1 + q) x exp(-r / `confidence_misfit`). q
/// weighs the pull of the pictures (the sum of weight x S_d) against that of the prior of weight
/// `refinement_prior`; r is the mean absolute residual over the mean colour. The target of `samples` is without
/// highlights, `pictures` are with them; `shading` has S_d of R, G, B, `diffuse` the albedo at every sample.
pub(super) fn confidence(
    config: &TransportConfig,
    samples: &Samples,
    pictures: &Planes,
    shading: &Planes,
    diffuse: &Planes,
) -> Vec<f32> {
    let (size, prior) = (samples.taps.size(), config.refinement_prior);
    let parts = Planes::from_fn(samples.len(), |i| {
        let [shading, albedo, target]: [[f32; 3]; 3] =
            [shading, diffuse, &samples.target].map(|planes| planes.sample(i, 0));
        let picture: [f32; 3] = pictures.sample(i, 0);
        let weight = samples.weight.get(0, i) / 3.0;
        let sum = |value: &dyn Fn(usize) -> f32| weight * (0..3).map(value).sum::<f32>();
        [
            sum(&|c| shading[c]),
            sum(&|c| (albedo[c] * shading[c] - target[c]).abs()),
            sum(&|c| picture[c].abs()),
        ]
    });
    let sums =
        Blur::new(size, 3, config.confidence_blur).apply(&samples.taps.gather::<3>(&parts, 0));
    let pull = (size * size) as f32 / (samples.len().max(1) as f32 * prior.max(f32::MIN_POSITIVE));
    let trust = |[light, misfit, colour]: &[f32; 3]| {
        let q = pull * light;
        let r = misfit / colour.max(f32::MIN_POSITIVE);
        q / (1.0 + q) * (-r / config.confidence_misfit).exp()
    };
    sums.as_chunks::<3>().0.iter().map(trust).collect()
}
