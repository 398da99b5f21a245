//! The colour of a light from the colour of its highlights.
//!
//! A tint of the light and one of the skin look alike in diffuse shading, and skin's first colour has
//! the highlights in it. But what varies from view to view in one place is no diffuse shading: it has
//! the colour of the light alone (the dichromatic model).

use crate::model::samples::Samples;
use crate::transport::CHANNELS;

/// What differs more between two channels is no tint of a light.
const MOST: f64 = 2.0;

/// Sums over the samples of a texel.
#[derive(Clone, Copy, Default)]
struct Sums {
    weight: f64,
    /// Of every channel: predicted, shown, their product, and predicted squared.
    moments: [[f64; 4]; CHANNELS],
    view: u32,
    /// Whether more than one view sees it.
    shared: bool,
}

/// By what factor R, G and B of the highlights that samples show differ from the predicted ones, as
/// far as they vary within a texel that several views see; 1 if nothing does, or if they differ beyond
/// [`MOST`]. Both in linear radiance; what is shown may hold what views agree on.
pub(super) fn tint(
    samples: &Samples,
    predicted: &[[f32; CHANNELS]],
    shown: impl Fn(usize) -> [f32; CHANNELS],
) -> [f32; CHANNELS] {
    let mut texels = vec![Sums::default(); samples.taps.size() * samples.taps.size()];
    for (i, predicted) in predicted.iter().enumerate() {
        let (weight, view) = (f64::from(samples.weight.get(0, i)), samples.view_index[i]);
        let sums = &mut texels[samples.taps.nearest(i)];
        sums.shared |= sums.weight > 0.0 && sums.view != view;
        (sums.weight, sums.view) = (sums.weight + weight, view);
        for ((moments, p), s) in sums.moments.iter_mut().zip(predicted).zip(shown(i)) {
            let (p, s) = (f64::from(*p), f64::from(s));
            let terms = [p, s, p * s, p * p];
            moments.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * term);
        }
    }
    let mut covariances = [[0.0; 2]; CHANNELS];
    for Sums { weight, moments, .. } in texels.iter().filter(|sums| sums.shared) {
        for (covariance, [p, s, both, squared]) in covariances.iter_mut().zip(moments) {
            covariance[0] += both - p * s / weight;
            covariance[1] += squared - p * p / weight;
        }
    }
    let tint = covariances.map(|[both, squared]| both / squared);
    let (least, largest) = tint.iter().fold((f64::MAX, 0.0f64), |(a, b), t| (a.min(*t), b.max(*t)));
    // Without highlights they are not numbers.
    let sound = tint.iter().all(|tint| *tint > 0.0) && largest < MOST * least;
    if sound { tint.map(|tint| tint as f32) } else { [1.0; CHANNELS] }
}
