//! The default method: explicit light transport on the known mesh. docs/method.md has the formulas.

mod albedo;
mod assemble;
mod confidence;
mod deviation_penalty;
mod explicit;
mod explicit_fits;
mod grey;
mod height_solve;
mod illuminations;
mod inpainting;
mod known;
mod light;
mod light_fit_data;
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
use self::illuminations::Illuminations;
use self::known::Known;
use self::light::{JointEstimate, LightEstimate, fit_joint, fit_light};
use self::light_fit_data::LightFitData;
use self::lighting::Lighting;
use self::recolour::recoloured;
use self::region_terms::RegionTerms;
use self::relief::{Relief, fit_relief};
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

/// Further rounds of the joint fit under lights that change from frame to frame. Each begins from the distance that the
/// one before has found.
const CHANGING_LIGHT_ROUNDS: usize = 6;

/// Recovers maps from a capture.
pub(crate) fn solve(
    capture: &Capture,
    config: &UnshadeConfig,
    run: &mut Run,
    layer_sink: Option<&mut LayerSink>,
) -> Result<Results, SolveError> {
    let space = SampleSpace::default().with_perturbed_pictures(config.rendering.rounding_seed);
    let target_luminance = Some(config.rendering.exposure);
    let scene = Scene::new(capture, space, target_luminance, config.maps.texture_size)?;
    let known = Known::new(&capture.truth, scene.picture_scale);
    let config = &known.configured(config);
    let coarse_size = config.transport.texture_size;

    let face = FaceRegions::new(&scene, config);
    let coarse_regions = face.region_map(&scene, coarse_size);
    let region_colours = face.mean_colours(&scene, &coarse_regions);
    run.record_time("regions");

    let sky = Sky::lat_long(config.transport.rows);
    let far = Transport::with_nearness(&capture.mesh, &sky, &config.transport, config.seed);
    let (trained, rows) = (capture.train.len(), config.transport.rows);
    let illuminations = Illuminations::new(&capture.lights, trained, rows, far.centre());
    run.record_time("rays");
    let pictures = scene.halved(light_halvings(scene.pixels(), config.light.samples));
    let coarse_samples =
        scene.space.training(&pictures.views, &pictures.gbuffers, None, coarse_size);
    drop(pictures);
    let data = LightFitData {
        known,
        illuminations: &illuminations,
        samples: &coarse_samples,
        face: &face,
        regions: &coarse_regions,
        region_colours: &region_colours,
    };
    let reflectance = scene.picture_scale * config.skin.reflectance;
    let terms = RegionTerms::prior(reflectance, &face.skin, &coarse_regions);
    let terms = known.terms(terms, config, coarse_size);
    let cells = illuminations.groups() * far.cells();
    let mut light = LightEstimate::uniform(cells, config.transport.bounce_albedo, terms);
    for round in 1..=config.light.rounds {
        light = run.stage_from(&format!("light {round}"), light, |run, name, light| {
            fit_light(run, name, config, &far, &data, &light, round)
        })?;
    }

    let transport = |nearness: f32, cast: fn(_: &_, _: &_, _: &_, _) -> _| {
        let sky = sky.clone().at(nearness);
        let bounces =
            TransportConfig { bounce_albedo: light.bounce_albedo, ..config.transport.clone() };
        cast(&capture.mesh, &sky, &bounces, config.seed)
    };
    let mut near = if run.is_interrupted() {
        far
    } else {
        // Both transports do not fit into memory.
        drop(far);
        transport(light.nearness_per_metre, Transport::new)
    };
    run.record_time("rays at the light's distance");
    let start = JointEstimate::new(&light, &region_colours);
    let grey = run.stage_from("joint, grey light", start, |run, name, start| {
        let start = recoloured(run.backend, &config.skin, &near, &data, start);
        fit_joint(run, name, config, &near, &data, start, true)
    })?;
    let mut joint = run.stage_from("joint", grey, |run, name, grey| {
        fit_joint(run, name, config, &near, &data, grey, false)
    })?;
    if capture.lights.beyond_one_still_light().is_some() {
        drop(near);
        for round in 1..=CHANGING_LIGHT_ROUNDS {
            joint = run.stage_from(&format!("joint {round}"), joint, |run, name, joint| {
                let near = transport(joint.nearness_per_metre, Transport::with_nearness);
                fit_joint(run, name, config, &near, &data, joint, false)
            })?;
        }
        near = transport(joint.nearness_per_metre, Transport::new);
        run.record_time("rays at the light's distance");
    }
    let illuminations = illuminations.at(joint.nearness_per_metre);
    drop(coarse_samples);
    let lighting = Lighting::new(config, &near, &illuminations, &coarse_regions, &light, &joint);

    let relief = run.stage("relief", |run, name| match known.deviations(&scene) {
        Some([deviation, diffuse]) => {
            Ok(Relief { size: scene.size, deviation, diffuse: Some(diffuse) })
        }
        None if run.is_interrupted() => Ok(Relief::none(scene.size)),
        None => fit_relief(run, name, &config.relief, &scene, &lighting, &joint),
    })?;
    let full_samples = scene.samples(None, scene.size);
    let full_regions = face.region_map(&scene, scene.size);
    let pictures =
        FullPictures { known, samples: &full_samples, face: &face, regions: &full_regions };
    let final_albedo = run.stage("albedo", |run, name| {
        fit_albedo(run, name, config, &pictures, &lighting, &joint, &relief)
    })?;
    let terms = joint.terms.clone();
    let measured_terms = run.stage_from("roughness", terms, |run, _, terms| {
        let config = &config.roughness;
        Ok(measure_roughness(run.backend, config, &lighting, &pictures, &relief, &terms))
    })?;
    run.record_time("roughness");
    let estimates = Estimates {
        known,
        lighting: &lighting,
        face: &face,
        joint: &joint,
        measured_terms: &measured_terms,
        relief,
        final_albedo,
        sample_count: full_samples.len(),
    };
    assemble(run, &scene, config, estimates, layer_sink)
}

/// How often the pictures are halved for the light fits: once, and on as long as `samples` of their `pixels` are left.
/// Larger pictures then have less noise at the same number of samples.
fn light_halvings(pixels: usize, samples: usize) -> usize {
    (2..).find(|halvings| pixels >> (2 * halvings) < samples.max(1)).unwrap_or(2) - 1
}

/// The steps and costs of the stages, measured on two cores with AVX-512. The order is that of the [`Run::stage`] calls
/// in [`solve`], with the maps at the end.
pub(crate) fn plan(config: &UnshadeConfig, extent: &Extent) -> Vec<Work> {
    let square = |side: usize| (side * side) as f64;
    let Extent { views, pixels, texture_size: size, has_changing_light } = *extent;
    let (full_samples, coarse_samples) = (pixels as f64, 0.25 * pixels as f64);
    let transport = &config.transport;
    let cells = (2 * transport.rows * transport.rows) as f64;
    let entries = cells * square(transport.texture_size);
    let rays = 45e-9 * entries * square(transport.rays_per_cell_side);
    let highlights = cells * coarse_samples.min(config.light.samples as f64);
    let light = |preparation: f64, steps: usize| Work {
        preparation: preparation + 25e-9 * highlights,
        step: 1e-9 * (0.4 * highlights + 0.1 * entries),
        steps,
    };
    let work = |sample: f64, texel: f64, side: f64, steps: usize| Work {
        preparation: 0.0,
        step: 1e-9 * (sample * full_samples + texel * side * side),
        steps,
    };
    let heights = size as f64 * f64::from(config.relief.texture_scale);
    let rounds = 1..=config.light.rounds;
    let mut plan: Vec<Work> = rounds
        .map(|round| light(if round == 1 { rays } else { 0.0 }, config.light.steps_of(round)))
        .collect();
    plan.push(light(rays, config.joint.grey_steps));
    plan.push(light(0.0, config.joint.steps));
    let rounds = if has_changing_light { CHANGING_LIGHT_ROUNDS } else { 0 };
    plan.extend((0..rounds).map(|_| light(rays, config.joint.steps)));
    plan.push(work(25.0, 15.0, heights, relief::steps(&config.relief, size, views)));
    plan.push(work(6.0, 6.0, size as f64, config.albedo.steps));
    let roughness =
        2e-6 * full_samples.min(config.roughness.samples as f64) * config.roughness.rounds as f64;
    plan.push(Work { preparation: roughness, ..Work::default() });
    let maps = square(config.maps.texture_size.maps(size)) + full_samples;
    plan.push(Work { preparation: 1e-6 * maps, ..Work::default() });
    plan
}
