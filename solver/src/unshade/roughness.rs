//! The roughness of regions, by the view-to-view change of highlights on the found relief. Relief that is not yet in
//! the normals would be taken for roughness, so that it is measured once the heights are found.

use super::lighting::Lighting;
use super::region_terms::RegionTerms;
use super::regression::Regression;
use super::relief::Relief;
use crate::backend::Backend;
use crate::config::RoughnessConfig;
use crate::model::samples::Samples;
use crate::transport::CHANNELS;

/// Factor on the roughness for its derivative.
const ROUGHER: f32 = 1.1;
/// Exponent of the cosine lobe through which the light is seen: next to none, since lamps are often smaller than the
/// cells that stand for them, and skin would seem sharper than it is.
const LIGHT_EXPONENT: i32 = 512;

/// The terms with the roughness that the samples show; `regions` are those of the samples' texture.
pub(super) fn measure_roughness(
    backend: &dyn Backend,
    config: &RoughnessConfig,
    lighting: &Lighting,
    samples: &Samples,
    regions: &[u8],
    relief: &Relief,
    terms: &RegionTerms,
) -> RegionTerms {
    let samples = &samples.thinned_in_runs(config.samples);
    let sharp = samples.taps.sample::<3>(&relief.deviation);
    let round = |terms: RegionTerms, _| {
        let highlights = lighting.highlights(backend, &terms, samples, LIGHT_EXPONENT);
        let predicted = highlights.at(samples, &sharp);
        let rougher = highlights.rougher(ROUGHER).at(samples, &sharp);
        let change = |c: usize, i: usize| rougher.get(c, i) - predicted.get(c, i);
        let slope = |i: usize| std::array::from_fn(|c| change(c, i) / ROUGHER.ln());
        let rows = |i: usize| [predicted.sample::<CHANNELS>(i, 0), slope(i)];
        let observed = |i: usize| samples.target.sample(i, 0);
        let regression = Regression::new(samples, &samples.weight, rows, observed);
        terms.with_roughness(config, lighting.evenness(), &regression, regions)
    };
    (0..config.rounds).fold(terms.clone(), round)
}
