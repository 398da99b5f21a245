//! The colours of hair, brows and lips under the light that was fitted to skin. Before, they are mean colours of the
//! pictures, which include shadows.

use super::explicit::exp;
use super::illuminations::by_parts;
use super::light::JointEstimate;
use super::light_fit_data::LightFitData;
use crate::backend::Backend;
use crate::config::SkinConfig;
use crate::model::planes::Planes;
use crate::transport::{CHANNELS, LIGHT_EXPONENT, Transport};

/// Gives every region other than skin the one albedo that explains its mean picture without highlights under the light
/// of the estimate; skin as well if the light is known. Without named skin the albedo does not change.
pub(super) fn recoloured(
    backend: &dyn Backend,
    config: &SkinConfig,
    transport: &Transport,
    data: &LightFitData,
    mut estimate: JointEstimate,
) -> JointEstimate {
    let LightFitData { known, samples, regions, face, .. } = *data;
    if face.skin.is_empty() && !known.has_light() {
        return estimate;
    }
    let illuminations = data.illuminations.around(transport);
    let light = exp(&estimate.log_light);
    let region = |i: usize| regions[samples.taps.nearest(i)];
    let terms = Planes::from_fn(samples.len(), |i| estimate.terms.of(region(i)).channels());
    let (parts, peak) = (illuminations.parts(samples), illuminations.peak(transport, &light));
    let highlights = by_parts::<CHANNELS>(&parts, samples.len(), |_, part| {
        let light = illuminations.light(&light, part.illumination, 0.0);
        let highlights = transport.skin_highlights(config, &light, peak, LIGHT_EXPONENT);
        let samples = part.samples(samples);
        backend.highlights(&highlights, &samples, &samples.normal, &part.planes(&terms))
    });
    let shading = by_parts::<CHANNELS>(&parts, samples.len(), |_, part| {
        let light = illuminations.light(&light, part.illumination, 0.0);
        part.samples(samples).taps.sample::<CHANNELS>(&transport.shading(&light))
    });
    // Per region and channel: the sums of the observed radiance and of the radiance of a white surface.
    let mut sums = [[[0.0_f64; 2]; CHANNELS]; 256];
    for i in 0..samples.len() {
        let weight = samples.weight.get(0, i);
        for (c, sums) in sums[usize::from(region(i))].iter_mut().enumerate() {
            let observed = samples.target.get(c, i) - highlights.get(c, i);
            sums[0] += f64::from(weight * observed);
            sums[1] += f64::from(weight * shading.get(c, i));
        }
    }
    for (texel, region) in estimate.albedo.chunks_exact_mut(CHANNELS).zip(regions) {
        let sums = &sums[usize::from(*region)];
        let seen = sums.iter().all(|[observed, white]| *observed > 0.0 && *white > 0.0);
        if seen && (known.has_light() || !face.skin.contains(region)) {
            texel.iter_mut().zip(sums).for_each(|(a, [observed, white])| {
                *a = (observed / white) as f32;
            });
        }
    }
    estimate
}
