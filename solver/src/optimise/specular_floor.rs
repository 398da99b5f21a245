//! The part of the highlights that all views share. No picture tells it from diffuse colour, so that the
//! networks leave it there, but the found light does, with the reflectance that skin is known to have.

use rayon::prelude::*;

use super::stage::State;
use crate::backend::Backend;
use crate::config::Config;
use crate::model::blur::Blur;
use crate::model::normals::DirectionScale;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::resample;
use crate::transport::{CHANNELS, SpecularTerm, Transport};

/// Whether highlights are predicted from the light.
pub(super) fn wanted(config: &Config) -> bool {
    config.transport.specular_floor && config.normalisation.specular_skin > 0.0
}

/// The specular floor, R, G, B per texel: the median over the views of what skin of the terms `specular`
/// (a texture of [`SpecularTerm`]) shows in `light` (R, G, B per cell) more than the networks do. Under an L1 loss that is what a
/// diffuse albedo takes up. Empty if the transport does not hold what is open.
pub(super) fn specular_floor(
    config: &Config,
    transport: &Transport,
    samples: &Samples,
    state: &State,
    backend: &dyn Backend,
    light: &[f32],
    specular: &[f32],
) -> Vec<f32> {
    let taps = &samples.taps;
    let Some(skin_highlights) = transport.skin_highlights(&config.skin, light) else {
        return vec![];
    };
    let (terms, _) = specular.as_chunks();
    let highlights = backend.highlights(
        &skin_highlights,
        samples,
        &samples.normal,
        &Planes::from_fn::<{ SpecularTerm::ROWS }>(samples.len(), |i| terms[taps.nearest(i)]),
    );
    let directions = DirectionScale::from(&config.networks).directions(samples, None);
    let known = backend.light(&state.networks, &samples.position);
    let shading = backend.shade(&state.networks, &known, &directions);
    let networks = taps.sample::<1>(&state.specular);
    let mut of: Vec<Vec<u32>> = vec![vec![]; terms.len()];
    (0..samples.len()).for_each(|i| of[taps.nearest(i)].push(i as u32));
    let texel = |of: &Vec<u32>| {
        let missing = |i: usize, channel: usize| {
            let found = samples.fresnel.get(0, i) * networks.get(0, i) * shading.get(1, i);
            (highlights.get(channel, i) - found, samples.weight.get(0, i))
        };
        let median =
            |channel| weighted_median(of.iter().map(|i| missing(*i as usize, channel)).collect());
        let [(r, weight), (g, _), (b, _)] = [0, 1, 2].map(median);
        [weight * r, weight * g, weight * b, weight]
    };
    let texels: Vec<[f32; 4]> = of.par_iter().map(texel).collect();
    let sums = Blur::new(taps.size(), 4, config.transport.specular_floor_blur)
        .apply(texels.as_flattened());
    let mean = |[r, g, b, weight]: &[f32; 4]| match *weight > 1e-6 {
        true => [r, g, b].map(|sum| sum / weight),
        false => [0.0; CHANNELS],
    };
    sums.as_chunks().0.iter().flat_map(mean).collect()
}

/// The pictures without a specular floor on a texture of side `size`.
pub(super) fn without_specular_floor(
    samples: &Samples,
    specular_floor: &[f32],
    size: usize,
) -> Planes {
    let specular_floor = resample(specular_floor, size, CHANNELS, samples.taps.size());
    let specular_floor = samples.taps.sample::<CHANNELS>(&specular_floor);
    Planes::from_fn::<CHANNELS>(samples.len(), |i| {
        let (target, specular_floor): ([f32; 3], [f32; 3]) =
            (samples.target.sample(i, 0), specular_floor.sample(i, 0));
        std::array::from_fn(|c| target[c] - specular_floor[c])
    })
}

/// The median of values with weights, and the sum of the weights; 0 of nothing.
fn weighted_median(mut values: Vec<(f32, f32)>) -> (f32, f32) {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f32 = values.iter().map(|(_, weight)| weight).sum();
    let mut below = 0.0;
    let middle = values.iter().find(|(_, weight)| {
        below += weight;
        below >= 0.5 * total
    });
    (middle.map_or(0.0, |(value, _)| *value), total)
}

#[cfg(test)]
mod tests {
    use super::weighted_median;

    #[test]
    fn the_median_is_where_half_of_the_weight_lies() {
        assert_eq!(weighted_median(vec![(3.0, 1.0), (1.0, 1.0), (2.0, 1.0)]), (2.0, 3.0));
        assert_eq!(weighted_median(vec![(3.0, 1.0), (1.0, 5.0), (2.0, 1.0)]), (1.0, 7.0));
        assert_eq!(weighted_median(vec![]), (0.0, 0.0));
    }
}
