//! The roughness of regions, from the view-to-view variation of highlights on the estimated relief. Unresolved relief
//! would appear as roughness, so the heights are fitted first.

use super::albedo::FullPictures;
use super::lighting::{Lighting, bent_shadings};
use super::region_terms::RegionTerms;
use super::regression::Regression;
use super::relief::Relief;
use crate::backend::Backend;
use crate::config::RoughnessConfig;
use crate::transport::CHANNELS;

/// Factor on the roughness in the finite difference of the derivative.
const ROUGHER: f32 = 1.1;
/// Exponent of the cosine lobe that filters the light: almost no filter. Lamps are often smaller than cells, and a
/// wider filter would reduce the estimated roughness further.
const NEARLY_UNFILTERED_EXPONENT: i32 = 512;

/// Returns the terms with the estimated roughness.
pub(super) fn measure_roughness(
    backend: &dyn Backend,
    config: &RoughnessConfig,
    lighting: &Lighting,
    pictures: &FullPictures,
    relief: &Relief,
    terms: &RegionTerms,
) -> RegionTerms {
    let samples = &pictures.samples.thinned_in_runs(config.samples);
    let sharp = samples.taps.sample::<3>(&relief.deviation);
    // Without several illuminations the diffuse radiance of a texel is constant.
    let basis = (!lighting.is_one()).then(|| {
        let soft = samples.taps.sample::<3>(&relief.blurred());
        bent_shadings(samples, &lighting.shading_with_derivative(samples), &soft)
    });
    let round = |terms: RegionTerms, _| {
        let highlights = lighting.highlights(backend, &terms, samples, NEARLY_UNFILTERED_EXPONENT);
        let predicted = highlights.at(samples, &sharp);
        let rougher = highlights.with_rougher_skin(ROUGHER).at(samples, &sharp);
        let change = |c: usize, i: usize| rougher.get(c, i) - predicted.get(c, i);
        let slope = |i: usize| std::array::from_fn(|c| change(c, i) / ROUGHER.ln());
        let rows = |i: usize| [predicted.sample::<CHANNELS>(i, 0), slope(i)];
        let observed = |i: usize| samples.target.sample(i, 0);
        let weight = &samples.weight;
        let regression = Regression::new(samples, weight, basis.as_ref(), rows, observed);
        terms.with_roughness(config, lighting.uniformity(), &regression, pictures.regions)
    };
    (0..config.rounds).fold(terms.clone(), round)
}
