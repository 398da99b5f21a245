//! Dependence of a texel's confidence on its observations.

use super::*;
use crate::model::planes::Planes;
use crate::unshade::confidence::confidence;

#[test]
fn confidence_needs_light_and_agreement() {
    let samples = samples(16);
    let confidence = |samples: &Samples, shading: &Planes, albedo: &Planes| {
        confidence(1.0, samples, &samples.target, shading, albedo)
    };
    let albedo = Planes::from_fn(samples.len(), |_| [0.5f32; 3]);
    let shading = |light: f32| Planes::from_fn(samples.len(), move |_| [light; 3]);
    let target = |off: f32| {
        let mut samples = samples.clone();
        samples.target = Planes::from_fn(samples.len(), |_| [0.5 + off; 3]);
        samples
    };
    let mean = |values: Vec<f32>| values.iter().sum::<f32>() / values.len() as f32;
    let good = mean(confidence(&target(0.0), &shading(1.0), &albedo));
    let dim = Planes::from_fn(samples.len(), |_| [5.0f32; 3]);
    let dim = mean(confidence(&target(0.0), &shading(0.1), &dim));
    let wrong = mean(confidence(&target(0.2), &shading(1.0), &albedo));
    assert!(good > 0.1 && good <= 1.0, "{good}");
    assert!(dim < 0.5 * good, "{dim} {good}");
    assert!(wrong < 0.5 * good, "{wrong} {good}");
}
