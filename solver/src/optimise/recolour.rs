//! The colours of hair, brows and lips under the light that skin has shown. They begin as mean colours
//! of the pictures, shadow and all; skin of every label begins in one colour.

use super::context::SolveContext;
use super::region_terms::RegionTerms;
use super::stage::{State, layers};
use crate::model::deviation::Deviation;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{CHANNELS, Transport};

/// Gives every region that is no skin, in the diffuse albedo of `state`, the one colour that explains
/// what the samples show of it besides highlights, in the mean, under `light` (R, G, B per cell). Without
/// [`SolveContext::skin_regions`] the albedo stays.
pub(super) fn recolour(
    context: &SolveContext,
    transport: &Transport,
    samples: &Samples,
    light: &[f32],
    skin_specular: Option<&RegionTerms>,
    state: &mut State,
) {
    let skin = context.skin_regions();
    if skin.is_empty() {
        return;
    }
    let Some(regions) = context.regions_on(state.size) else { return };
    let predicted = skin_specular.and_then(|skin_specular| {
        let term = |i: usize| skin_specular.of(regions[samples.taps.nearest(i)]).channels();
        Some(context.backend.highlights(
            &transport.skin_highlights(&context.config.skin, light)?,
            samples,
            &samples.normal,
            &Planes::from_fn(samples.len(), term),
        ))
    });
    let highlights = predicted.unwrap_or_else(|| {
        let deviation = Deviation::new(context.config, state.size);
        let layers = layers(samples, &deviation, state, context.backend);
        Planes::from_fn(samples.len(), |i| [layers.get(1, i); CHANNELS])
    });
    let shading = samples.taps.sample::<CHANNELS>(&transport.shading(light));
    // Per region and channel: sums of the seen colour, and of that of a white surface.
    let mut sums = [[[0.0_f64; 2]; CHANNELS]; 256];
    for i in 0..samples.len() {
        let weight = samples.weight.get(0, i);
        let sums = &mut sums[usize::from(regions[samples.taps.nearest(i)])];
        for (c, sums) in sums.iter_mut().enumerate() {
            let seen = samples.target.get(c, i) - highlights.get(c, i);
            sums[0] += f64::from(weight * seen);
            sums[1] += f64::from(weight * shading.get(c, i));
        }
    }
    for (texel, region) in state.diffuse.chunks_exact_mut(CHANNELS).zip(regions) {
        let sums = &sums[usize::from(region)];
        let known = sums.iter().all(|[seen, white]| *seen > 0.0 && *white > 0.0);
        if known && !skin.contains(&region) {
            texel.iter_mut().zip(sums).for_each(|(a, [seen, white])| *a = (seen / white) as f32);
        }
    }
}
