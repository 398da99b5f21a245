//! The roughness of regions, by how highlights on the found relief change from view to view. Relief that is not yet in
//! the normals would be taken for roughness, so that it is measured once the heights are found.

use super::context::SolveContext;
use super::deviated_highlights::DeviatedHighlights;
use super::lighting::Lighting;
use super::regression::Regression;
use super::stage::State;
use crate::transport::CHANNELS;

/// Factor on the roughness for its derivative.
const ROUGHER: f32 = 1.1;

/// Measures the roughness in [`Lighting::region_terms`] under the normals of `state`, whose textures have the
/// final size. It stays as it is without regions, or if the light was not solved for with its highlights.
pub(super) fn roughness(context: &SolveContext, state: &State, lighting: &mut Lighting) {
    let config = &context.config.reflectance;
    if config.roughness_rounds == 0 || !lighting.explained {
        return;
    }
    let sizes = [state.size, lighting.state.size];
    let (Some(mut terms), [Some(regions), Some(coarse_regions)]) =
        (lighting.region_terms.clone(), sizes.map(|size| context.regions_on(size)))
    else {
        return;
    };
    let fine = context.fine();
    let samples = &fine.samples.thinned_in_runs(config.roughness_samples);
    let sharp = fine.deviation.textures(&state.deviation).sharp;
    let sharp = samples.taps.sample::<3>(&sharp);
    for _ in 0..config.roughness_rounds {
        let Some(highlights) =
            DeviatedHighlights::new(context, lighting, samples, config.roughness_light_exponent)
        else {
            return;
        };
        let predicted = highlights.at(samples, &sharp);
        let rougher = highlights.rougher(ROUGHER).at(samples, &sharp);
        let change = |c: usize, i: usize| rougher.get(c, i) - predicted.get(c, i);
        let slope = |i: usize| std::array::from_fn(|c| change(c, i) / ROUGHER.ln());
        let rows = |i: usize| [predicted.sample::<CHANNELS>(i, 0), slope(i)];
        let shown = |i: usize| samples.target.sample(i, 0);
        let regression = Regression::new(samples, &samples.weight, rows, shown);
        terms.update_roughness(config, lighting.evenness(), &regression, &regions);
        lighting.take_terms(terms.clone(), &coarse_regions);
    }
}
