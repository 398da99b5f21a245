//! The colours of hair, brows and lips under the light that skin has shown. They begin as mean colours of the
//! pictures, shadow and all; skin of every label begins in one colour.

use super::first_colours::FirstColours;
use super::region_terms::RegionTerms;
use crate::backend::Backend;
use crate::config::SkinConfig;
use crate::model::planes::Planes;
use crate::transport::{CHANNELS, Transport};

/// The `albedo` with the one colour in every region other than skin that explains its pictures without highlights, in
/// the mean, under `light` (R, G, B per cell). Without named skin the albedo stays.
pub(super) fn recoloured(
    backend: &dyn Backend,
    config: &SkinConfig,
    transport: &Transport,
    colours: &FirstColours,
    light: &[f32],
    terms: &RegionTerms,
    mut albedo: Vec<f32>,
) -> Vec<f32> {
    let FirstColours { samples, regions, skin, .. } = *colours;
    if skin.is_empty() {
        return albedo;
    }
    let region = |i: usize| regions[samples.taps.nearest(i)];
    let highlights = backend.highlights(
        &transport.skin_highlights(config, light),
        samples,
        &samples.normal,
        &Planes::from_fn(samples.len(), |i| terms.of(region(i)).channels()),
    );
    let shading = samples.taps.sample::<CHANNELS>(&transport.shading(light));
    // Per region and channel: sums of the observed colour, and of that of a white surface.
    let mut sums = [[[0.0_f64; 2]; CHANNELS]; 256];
    for i in 0..samples.len() {
        let weight = samples.weight.get(0, i);
        for (c, sums) in sums[usize::from(region(i))].iter_mut().enumerate() {
            let observed = samples.target.get(c, i) - highlights.get(c, i);
            sums[0] += f64::from(weight * observed);
            sums[1] += f64::from(weight * shading.get(c, i));
        }
    }
    for (texel, region) in albedo.chunks_exact_mut(CHANNELS).zip(regions) {
        let sums = &sums[usize::from(*region)];
        let known = sums.iter().all(|[observed, white]| *observed > 0.0 && *white > 0.0);
        if known && !skin.contains(region) {
            texel.iter_mut().zip(sums).for_each(|(a, [observed, white])| {
                *a = (observed / white) as f32;
            });
        }
    }
    albedo
}
