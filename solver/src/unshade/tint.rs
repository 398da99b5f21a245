//! The colour of a light from the colour of its highlights.
//!
//! A tint of the light and one of the skin look alike in diffuse shading, and skin's first colour contains highlights.
//! Diffuse radiance does not depend on the view, so view-to-view variation at a texel is specular and has the colour of
//! the light (the dichromatic reflection model).

use super::regression::Regression;
use crate::transport::CHANNELS;

/// Largest plausible ratio of two channels' slopes.
const LARGEST_RATIO: f64 = 2.0;
/// Largest standard error of a slope over the slope.
const LARGEST_ERROR: f64 = 0.05;

impl Regression {
    /// Returns the slopes of R, G and B, or 1 if a slope is too uncertain.
    pub fn tint(&self) -> [f32; CHANNELS] {
        let slope = |channel: usize| match self.sums(|_| true, channel..channel + 1).slope() {
            Some((slope, error)) if error < LARGEST_ERROR * slope => slope,
            _ => 0.0,
        };
        let slopes = [0, 1, 2].map(slope);
        let least = slopes.into_iter().fold(f64::MAX, f64::min);
        let largest = slopes.into_iter().fold(0.0, f64::max);
        let sound = least > 0.0 && largest < LARGEST_RATIO * least;
        if sound { slopes.map(|slope| slope as f32) } else { [1.0; CHANNELS] }
    }
}

/// Divides R, G, B per texel by a tint of the light.
pub(super) fn without_tint(albedo: &[f32], tint: &[f32; CHANNELS]) -> Vec<f32> {
    albedo.iter().zip(tint.iter().cycle()).map(|(albedo, tint)| albedo / tint).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use capture::gbuffer::GBuffer;

    use super::*;
    use crate::model::samples::SampleSpace;
    use crate::model::samples::Samples;
    use crate::testing;

    /// Two views of a dome, and highlights that vary within its texels.
    pub fn scene() -> (Samples, Vec<[f32; CHANNELS]>) {
        let mesh = testing::dome(12);
        let shade = |p: glam::Vec3| (glam::Vec3::splat(0.5 + 0.1 * p.x), 1);
        let cameras = testing::rig(2, 48);
        let views: Vec<_> = cameras.iter().map(|c| testing::view(&mesh, c, shade)).collect();
        let gbuffers = GBuffer::of_views(&mesh, &views);
        let samples = SampleSpace::default().training(&views, &gbuffers, None, 16);
        let predicted = (0..samples.len())
            .map(|i| [1.0, 1.1, 1.3].map(|c: f32| c * (1.0 + (i as f32 * 12.9898).sin())))
            .collect();
        (samples, predicted)
    }

    fn measured(
        samples: &Samples,
        predicted: &[[f32; CHANNELS]],
        observed: impl Fn(usize) -> [f32; CHANNELS],
    ) -> [f32; CHANNELS] {
        let rows = |i: usize| [predicted[i], [0.0; CHANNELS]];
        Regression::new(samples, &samples.weight, None, rows, observed).tint()
    }

    /// `tint` of the prediction over a paint that differs from texel to texel.
    fn found_tint(
        samples: &Samples,
        predicted: &[[f32; CHANNELS]],
        tint: [f32; 3],
    ) -> [f32; CHANNELS] {
        let paint = |i: usize| samples.taps.nearest(i) as f32;
        measured(samples, predicted, |i| {
            std::array::from_fn(|c| paint(i) + tint[c] * predicted[i][c])
        })
    }

    #[test]
    fn view_independent_radiance_is_not_a_highlight() {
        let (samples, predicted) = scene();
        let found = found_tint(&samples, &predicted, [0.8, 1.0, 1.4]);
        let error = |(a, b): (f32, f32)| (a - b).abs();
        assert!(found.into_iter().zip([0.8, 1.0, 1.4]).map(error).all(|e| e < 1e-3), "{found:?}");
    }

    #[test]
    fn the_tint_is_one_without_evidence() {
        let (samples, predicted) = scene();
        let ones = [1.0; CHANNELS];
        assert_eq!(found_tint(&samples, &predicted, [0.5, 1.0, 1.2]), ones, "implausible ratio");
        assert_eq!(found_tint(&samples, &predicted, [-0.5, 1.0, 1.2]), ones, "negative");
        let none = vec![[0.0; CHANNELS]; samples.len()];
        assert_eq!(found_tint(&samples, &none, [0.8, 1.0, 1.4]), ones, "no highlights");
        let noise = |i: usize| [(i as f32 * 78.233).sin() * 30.0 + predicted[i][0]; CHANNELS];
        assert_eq!(measured(&samples, &predicted, noise), ones, "noise");
        let mut alone = samples.clone();
        alone.view_index.fill(0);
        assert_eq!(found_tint(&alone, &predicted, [0.8, 1.0, 1.4]), ones, "one view");
    }

    #[test]
    fn saturated_samples_are_left_out() {
        let (mut samples, predicted) = scene();
        let hit = |i: usize| i.is_multiple_of(3);
        samples.target = crate::model::planes::Planes::from_fn(samples.len(), |i| {
            let target: [f32; CHANNELS] = samples.target.sample(i, 0);
            if hit(i) { [2.0, target[1], target[2]] } else { target }
        });
        let red = |i: usize| if hit(i) { 0.0 } else { 0.8 * predicted[i][0] };
        let found = measured(&samples, &predicted, |i| [red(i), predicted[i][1], predicted[i][2]]);
        assert!((found[0] - 0.8).abs() < 1e-3, "{found:?}");
    }
}
