//! The light and how far it is, by the highlights that it makes on skin, and what each region mirrors of it.

use super::context::{SolveContext, TransportSetup};
use super::error::SolveError;
use super::halves::{Halves, mean};
use super::highlights::{Found, Highlights};
use super::light_estimate::{LightEstimate, bounce_albedo};
use super::lighting::evenness;
use super::stage::State;
use super::stage_runner::StageRunner;
use crate::config::Config;
use crate::model::planes::Planes;
use crate::transport::{Transport, contrast};

/// Light and distance again, the albedo held, from those that the networks' highlights led to, as [`Halves`]; by skin
/// alone if the capture names it, since the rest has but the mean colours of the pictures. One `round` of
/// several, from 1: after each, the regions' reflectance by their highlights; after the last, the colour of the
/// light by them. The number of steps that are not taken: without regions nothing predicts highlights.
pub(super) fn distance(
    runner: &mut StageRunner,
    context: &SolveContext,
    mut state: State,
    light_estimate: &mut LightEstimate,
    round: usize,
) -> Result<usize, SolveError> {
    let t = &context.config.transport;
    let iterations = distance_steps(context.config, round);
    let transport = context.far_transport();
    let size = transport.size();
    let (Some(region_terms), Some(regions)) =
        (&mut light_estimate.region_terms, context.regions_on(size))
    else {
        return Ok(iterations);
    };
    state.resize(size);
    let mut samples = context.pictures().samples(&context.space, size);
    let weight = samples.thinned(t.highlight_samples).weight;
    let skin = context.skin();
    if !skin.is_empty() {
        let of_skin = |i: usize| skin.contains(&regions[samples.taps.nearest(i)]);
        let weight = |i: usize| if of_skin(i) { samples.weight.get(0, i) } else { 0.0 };
        samples.weight = Planes::from_fn(samples.len(), |i| [weight(i)]);
    }
    let skin_specular = region_terms.texture(&regions);
    let nearness = light_estimate.setup.nearness;
    let of = |log_light| Found { log_light, nearness, skin_specular: &skin_specular };
    let found = of(&light_estimate.log_light);
    let started = match &light_estimate.halves {
        Some(halves) => halves.each_ref().map(|half| of(half)),
        None => [found; 2],
    };
    let (config, name) = (context.config, format!("distance {round}"));
    let halves = Halves::new(config, transport, &samples, &state, started, name, iterations);
    let Some(mut halves) = halves else { return Ok(iterations) };
    runner.stage(&mut halves, &mut state)?;
    let (lights, nearness) = halves.best();
    // For the peak, which reflectances are relative to, by the light that the halves began with.
    let whole = Highlights::new(config, transport, &samples, &state, found);
    let Some(mut stage) = whole else { return Ok(0) };
    (stage.log_light, stage.nearness) = (mean(&lights), vec![nearness]);
    light_estimate.doubt = Some(doubt(transport, &lights, nearness));
    light_estimate.halves = Some(lights);
    let config = &context.config.reflectance;
    if config.rounds > 0 {
        let evenness = evenness(contrast(t.rows, &stage.light()), t.even_contrast);
        let regression = stage.regression(&state, &weight, Some(&context.config.model_error));
        region_terms.update(config, evenness, &regression, &regions);
    }
    if t.tint && round == config.rounds() {
        light_estimate.tint = stage.take_tint(&state);
        let texels = state.diffuse.iter_mut().zip(light_estimate.tint.iter().cycle());
        texels.for_each(|(albedo, tint)| *albedo /= tint);
    }
    light_estimate.setup = TransportSetup {
        nearness: stage.nearness[0] * transport.near(),
        bounce_albedo: bounce_albedo(transport, &stage.light(), &state.diffuse),
    };
    light_estimate.log_light = stage.log_light;
    Ok(0)
}

/// See [`LightEstimate::doubt`].
fn doubt(transport: &Transport, log_lights: &[Vec<f32>; 2], nearness: f32) -> f32 {
    let [a, b] = log_lights.each_ref().map(|log_light| {
        let light: Vec<f32> = log_light.iter().map(|light| light.exp()).collect();
        transport.shading_nearer(&light, nearness).0
    });
    let (apart, sum) = a.iter().zip(&b).fold((0.0, 0.0), |(apart, sum), (a, b)| {
        (apart + f64::from((a - b).abs()), sum + f64::from(a + b))
    });
    if sum > 0.0 { (apart / sum) as f32 } else { 0.0 }
}

/// The steps of a round of [`distance`], from 1.
pub(super) fn distance_steps(config: &Config, round: usize) -> usize {
    let (steps, rounds) = (config.transport.distance, config.reflectance.rounds());
    steps * round / rounds - steps * (round - 1) / rounds
}
