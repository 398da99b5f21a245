//! The default method: explicit light transport on the known mesh. docs/method.md has the formulas.

mod albedo;
mod assemble;
mod confidence;
mod deviation_penalty;
mod explicit;
mod first_colours;
mod grey;
mod height_solve;
mod inpainting;
mod light;
mod lighting;
mod linear_colour;
mod neighbourhood;
mod recolour;
mod region_terms;
mod regression;
mod relief;
mod relief_highlights;
mod roughness;
#[cfg(test)]
mod tests;
mod tint;
mod two_fold;
mod vectors;

use capture::Capture;

use self::albedo::{FullPictures, fit_albedo};
use self::assemble::{Estimates, assemble};
use self::first_colours::FirstColours;
use self::light::{LightEstimate, fit_light, fit_light_and_albedo, refit_light_and_albedo};
use self::lighting::Lighting;
use self::region_terms::RegionTerms;
use self::relief::fit_relief;
use self::roughness::measure_roughness;
use crate::config::{TransportConfig, UnshadeConfig};
use crate::model::samples::SampleSpace;
use crate::run::error::SolveError;
use crate::run::progress::LayerSink;
use crate::run::{Extent, Run, Work};
use crate::scene::Scene;
use crate::semantic::regions::FaceRegions;
use crate::solution::Results;
use crate::transport::{Sky, Transport};

/// Recovers maps from a capture.
pub(crate) fn solve(
    capture: &Capture,
    config: &UnshadeConfig,
    run: &mut Run,
    layer_sink: Option<&mut LayerSink>,
) -> Result<Results, SolveError> {
    let space = SampleSpace::new(&capture.mesh, 1.0).rounded(config.rendering.rounding_seed);
    let exposure = Some(config.rendering.exposure);
    let scene = Scene::new(capture, space, exposure, config.maps.texture_size)?;
    let (cast, chart) = (&config.transport, config.transport.texture_size);

    let face = FaceRegions::new(&scene, config);
    let regions = face.on(&scene, chart);
    let albedo = face.mean_albedo(&scene, chart);
    run.record_time("regions");

    let far = Transport::with_nearness(&capture.mesh, &Sky::even(cast.rows), cast, config.seed);
    run.record_time("rays");
    let samples = scene.half_samples(None, chart);
    let (labelled_skin, skin) = (&face.labelled_skin, &face.skin);
    let colours =
        FirstColours { samples: &samples, regions: &regions, labelled_skin, skin, albedo: &albedo };
    let expected = RegionTerms::expected(scene.gain * config.skin.reflectance, skin, &regions);
    let mut light = LightEstimate::even(far.cells(), cast.bounce_albedo, expected);
    for round in 1..=config.light.rounds {
        light = run.stage(&format!("light {round}"), |run| {
            fit_light(run, config, &far, &colours, &light, round)
        })?;
    }

    let near = if run.is_interrupted() { far } else { at_distance(capture, config, &light, far) };
    run.record_time("rays at the light's distance");
    let joint = run.stage("joint, grey light", |run| {
        fit_light_and_albedo(run, config, &near, &colours, &light)
    })?;
    let joint = run.stage("joint", |run| {
        refit_light_and_albedo(run, config, &near, &colours, &light, &joint)
    })?;
    drop(samples);
    let terms = &joint.terms.clone();
    let lighting = Lighting::new(config, &near, &regions, &light, joint);

    let relief =
        run.stage("relief", |run| fit_relief(run, &config.relief, &scene, &lighting, terms))?;
    let samples = scene.samples(None, scene.size);
    let regions = face.on(&scene, scene.size);
    let pictures = FullPictures { samples: &samples, face: &face, regions: &regions };
    let albedo =
        run.stage("albedo", |run| fit_albedo(run, config, &pictures, &lighting, terms, &relief))?;
    let measured_terms = &run.stage("roughness", |run| {
        if run.is_interrupted() {
            return Ok(terms.clone());
        }
        let config = &config.roughness;
        Ok(measure_roughness(run.backend, config, &lighting, &samples, &regions, &relief, terms))
    })?;
    run.record_time("roughness");
    let (lighting, face, samples) = (&lighting, &face, samples.len());
    let estimates = Estimates { lighting, face, terms, measured_terms, relief, albedo, samples };
    assemble(run, &scene, config, estimates, layer_sink)
}

/// The transport from the light's distance, with bounces off the face's own reflectance.
fn at_distance(
    capture: &Capture,
    config: &UnshadeConfig,
    light: &LightEstimate,
    far: Transport,
) -> Transport {
    // Its memory is needed.
    drop(far);
    let sky = Sky::even(config.transport.rows).at(light.nearness);
    let cast = TransportConfig { bounce_albedo: light.bounce_albedo, ..config.transport.clone() };
    Transport::new(&capture.mesh, &sky, &cast, config.seed)
}

/// The steps and costs of the stages, measured on two cores with AVX-512.
pub(crate) fn plan(config: &UnshadeConfig, extent: &Extent) -> Vec<Work> {
    let square = |side: usize| (side * side) as f64;
    let Extent { views, pixels, texture_size: size } = *extent;
    let (all, few) = (pixels as f64, 0.25 * pixels as f64);
    let cast = &config.transport;
    let cells = (2 * cast.rows * cast.rows) as f64;
    let entries = cells * square(cast.texture_size);
    let rays = 45e-9 * entries * square(cast.rays_per_cell_side);
    let followed = cells * few.min(config.light.samples as f64);
    let light = |preparation: f64, steps: usize| Work {
        preparation: preparation + 25e-9 * followed,
        step: 1e-9 * (0.4 * followed + 0.1 * entries),
        steps,
    };
    let work = |sample: f64, texel: f64, side: f64, steps: usize| Work {
        preparation: 0.0,
        step: 1e-9 * (sample * all + texel * side * side),
        steps,
    };
    let heights = size as f64 * f64::from(config.relief.texture_scale);
    let rounds = 1..=config.light.rounds;
    let mut plan: Vec<Work> = rounds
        .map(|round| light(if round == 1 { rays } else { 0.0 }, config.light.steps_of(round)))
        .collect();
    plan.push(light(rays, config.joint.grey_steps));
    plan.push(light(0.0, config.joint.steps));
    plan.push(work(25.0, 15.0, heights, relief::steps(&config.relief, size, views)));
    plan.push(work(6.0, 6.0, size as f64, config.albedo.steps));
    let roughness =
        2e-6 * all.min(config.roughness.samples as f64) * config.roughness.rounds as f64;
    plan.push(Work { preparation: roughness, ..Work::default() });
    let maps = square(config.maps.texture_size.maps(size)) + all;
    plan.push(Work { preparation: 1e-6 * maps, ..Work::default() });
    plan
}
