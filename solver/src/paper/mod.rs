//! The published method: Rainer, Bridgeman, Ghosh, *Neural Shading Fields for Efficient Facial Inverse Rendering*
//! (2023), sections 3 to 5.

pub mod diffuse;
pub mod fields;
mod normalise;
pub mod normals;
#[cfg(test)]
mod tests;
pub mod warm_up;

use capture::gbuffer::{Atlas, GBuffer};
use capture::mean_texture::coverage;
use capture::{Camera, Capture, Mesh, View};
use formats::cancel;
use formats::maps::Maps;
use formats::picture::Picture;

use self::diffuse::diffuse;
use self::fields::ShadingFields;
use self::normalise::scales;
use self::normals::{Normals, Relief};
use self::warm_up::{starts, steps_after_start, warm_up};
use crate::config::PaperConfig;
use crate::maps::{self, Snapshot, stage_maps};
use crate::model::deviation::Deviation;
use crate::model::deviation_textures::DeviationTextures;
use crate::model::networks::Networks;
use crate::model::samples::{SampleSpace, Samples};
use crate::run::error::SolveError;
use crate::run::progress::LayerSink;
use crate::run::{Extent, Run, Work};
use crate::scene::Scene;
use crate::semantic;
use crate::solution::{Results, ViewLayers};

/// Recovers maps from a capture: warm-up, then alternately normals with specular albedo and diffuse albedo.
pub(crate) fn solve(
    capture: &Capture,
    config: &PaperConfig,
    run: &mut Run,
    layer_sink: Option<&mut LayerSink>,
) -> Result<Results, SolveError> {
    let space = sample_space(&capture.mesh, config);
    let scene = Scene::new(capture, space, None, config.fine_tuning.texture_size)?;
    let initial = semantic_initialisation(&scene, config);
    run.record_time("preparation");
    let mut fields = {
        let samples = warm_up_samples(&scene, config);
        warm_up(run, config, &samples, &initial)?
    };
    let mut snapshots = vec![
        Snapshot::new("warm-up")
            .diffuse(&fields.diffuse, fields.size)
            .specular(&fields.specular, fields.size),
    ];
    fields = fields.resized(scene.size);
    let samples = scene.samples(config.depth_weights(), scene.size);
    let deviation = Deviation::new(config, scene.size);
    for round in 1..=config.fine_tuning.rounds {
        if run.is_interrupted() {
            break;
        }
        let name = format!("normals and specular {round}");
        let relief: Relief = run.stage(&name, |run, name| {
            let mut fit = Normals::new(config, &samples, &deviation, &fields, run.backend);
            run.fit(name, &mut fit)?;
            Ok(fit.relief)
        })?;
        fields = ShadingFields { deviation: relief.deviation, specular: relief.specular, ..fields };
        let sharp = deviation.textures(&fields.deviation).sharp;
        let snapshot = Snapshot::new(&name).specular(&fields.specular, fields.size);
        snapshots.push(snapshot.deviation(&sharp, fields.size));
        let name = format!("diffuse {round}");
        let albedo: Vec<f32> = run.stage(&name, |run, name| {
            let mut fit = diffuse(config, &samples, &deviation, &fields, run.backend);
            run.fit(name, &mut fit)?;
            Ok(fit.albedo)
        })?;
        fields = ShadingFields { diffuse: albedo, ..fields };
        snapshots.push(Snapshot::new(&name).diffuse(&fields.diffuse, fields.size));
    }
    assemble(&scene, config, run, &samples, fields, snapshots, layer_sink)
}

/// The steps and costs of the stages, measured on two cores with AVX-512. The order is that of the [`Run::stage`]
/// calls.
pub(crate) fn plan(config: &PaperConfig, extent: &Extent) -> Vec<Work> {
    let square = |side: usize| (side * side) as f64;
    let Extent { pixels, texture_size: size, .. } = *extent;
    let few = if config.warm_up.half_resolution { 0.25 } else { 1.0 } * pixels as f64;
    let work = |sample: f64, samples: f64, texel: f64, side: usize, steps: usize| Work {
        preparation: 0.0,
        step: 1e-9 * (sample * samples + texel * square(side)),
        steps,
    };
    let warm_up = |steps| work(73.0, few, 67.0, config.warm_up.texture_size, steps);
    let steps = config.fine_tuning.iterations;
    let round =
        [work(60.0, pixels as f64, 25.0, size, steps), work(6.0, pixels as f64, 6.0, size, steps)];
    let maps = square(config.fine_tuning.texture_size.maps(size)) + pixels as f64;
    let mut plan = vec![warm_up(config.initialisation.start_iterations); starts(config)];
    plan.push(warm_up(steps_after_start(config)));
    plan.extend(round.repeat(config.fine_tuning.rounds));
    plan.push(Work { preparation: 1e-6 * maps, ..Work::default() });
    plan
}

/// The conversion of pictures to samples for networks of this configuration.
pub fn sample_space(mesh: &Mesh, config: &PaperConfig) -> SampleSpace {
    let f0 = config.rendering.fresnel.then_some(config.skin.f0);
    SampleSpace::default()
        .with_network_inputs(mesh, config.networks.position_scale, f0)
        .with_perturbed_pictures(config.rendering.rounding_seed)
}

fn warm_up_samples(scene: &Scene, config: &PaperConfig) -> Samples {
    let (weights, size) = (config.depth_weights(), config.warm_up.texture_size);
    match config.warm_up.half_resolution {
        true => scene.samples_at_half_resolution(weights, size),
        false => scene.samples(weights, size),
    }
}

/// The initial textures (section 5.3): the mean colour of every labelled region, and its grey.
fn semantic_initialisation(scene: &Scene, config: &PaperConfig) -> ShadingFields {
    let size = config.warm_up.texture_size;
    let unlabelled: Vec<View>;
    let views = if config.initialisation.semantic {
        &scene.capture.train
    } else {
        let strip = |view: &View| View { labels: None, ..view.clone() };
        unlabelled = scene.capture.train.iter().map(strip).collect();
        &unlabelled
    };
    let (mesh, weights) = (&scene.capture.mesh, &config.view_weights);
    let albedo = semantic::initial_diffuse_albedo(mesh, views, &scene.gbuffers, weights, size, &[]);
    let diffuse = albedo.data;
    let grey: Vec<f32> = diffuse.chunks_exact(3).map(|rgb| rgb.iter().sum::<f32>() / 3.0).collect();
    let brightest = grey.iter().fold(f32::MIN_POSITIVE, |m, g| m.max(*g));
    let scale = config.initialisation.specular_maximum / brightest;
    ShadingFields {
        networks: Networks::new(&config.networks, config.seed),
        size,
        specular: grey.iter().map(|grey| grey * scale).collect(),
        deviation: vec![0.0; diffuse.len()],
        diffuse,
    }
}

/// Returns maps, withheld views and records; after an interrupt, from the current fields.
fn assemble(
    scene: &Scene,
    config: &PaperConfig,
    run: &mut Run,
    samples: &Samples,
    fields: ShadingFields,
    snapshots: Vec<Snapshot>,
    layer_sink: Option<&mut LayerSink>,
) -> Result<Results, SolveError> {
    let (mesh, size) = (&scene.capture.mesh, scene.size);
    let seen = scene.seen(&Atlas::new(mesh, size));
    let fields = ShadingFields {
        diffuse: maps::fill_unseen(fields.diffuse, 3, &seen),
        specular: maps::fill_unseen(fields.specular, 1, &seen),
        deviation: maps::fill_unseen(fields.deviation, 3, &seen),
        ..fields
    };
    let deviation = Deviation::new(config, size);
    let shading = fields.layers(samples, &deviation, run.backend);
    let shading = (0..samples.len()).map(|i| shading.get(0, i)).collect();
    let covered = fields.specular.iter().zip(&seen).filter(|(_, seen)| **seen);
    let scales = scales(&config.normalisation, shading, covered.map(|(a, _)| *a).collect());
    let stages = match config.records.stages {
        true => stage_maps(snapshots, scales, scene),
        false => vec![],
    };
    let synthesise = |camera: &Camera| synthesise(scene, camera, &deviation, &fields, run);
    let views = scene.capture.withheld.iter().map(synthesise).collect();
    if let Some(sink) = layer_sink.filter(|_| config.records.layers) {
        let train = scene.capture.train.iter();
        train.map(|view| synthesise(&view.camera)).try_for_each(|view| sink(&view))?;
    }
    let fields = fields.resized(scene.map_size);
    let atlas = Atlas::new(mesh, scene.map_size);
    let DeviationTextures { sharp, blurred } =
        Deviation::new(config, scene.map_size).textures(&fields.deviation);
    let seen = scene.seen(&atlas);
    let picture = |channels, data| Some(maps::square(data, channels, scene.map_size));
    let maps = Maps {
        diffuse_albedo: picture(3, maps::scaled(&fields.diffuse, scales.diffuse)),
        specular_albedo: picture(1, maps::scaled(&fields.specular, scales.specular)),
        diffuse_normal: picture(3, maps::bent_normals(&atlas, &blurred)),
        specular_normal: picture(3, maps::bent_normals(&atlas, &sharp)),
        coverage: Some(coverage(&seen)),
        ..Maps::default()
    };
    Ok(Results {
        diffuse_albedo_std: None,
        maps,
        lights: vec![],
        views,
        stages,
        scales,
        texture_size: size,
        samples: samples.len(),
    })
}

/// Renders a view by the networks.
fn synthesise(
    scene: &Scene,
    camera: &Camera,
    deviation: &Deviation,
    fields: &ShadingFields,
    run: &Run,
) -> ViewLayers {
    cancel::check();
    let gbuffer = GBuffer::new(&scene.capture.mesh, camera, None);
    // The shading by networks does not depend on the frame.
    let samples = scene.space.withheld(&gbuffer, 0, fields.size);
    let shading = fields.layers(&samples, deviation, run.backend);
    let albedo = fields.albedo(&samples);
    let channels = ViewLayers::CHANNELS.len();
    let mut picture = Picture::new(camera.width, camera.height, channels);
    for (i, pixel) in samples.pixel.iter().enumerate() {
        let [shading, specular]: [f32; 2] = shading.sample(i, 0);
        let out = &mut picture.data[*pixel as usize * channels..][..channels];
        for (channel, albedo) in albedo.sample::<3>(i, 0).into_iter().enumerate() {
            let whole = albedo * shading + specular;
            out[channel] = whole;
            out[3 + channel] = whole - specular;
            out[6 + channel] = specular;
        }
    }
    ViewLayers { name: camera.name.clone(), picture }
}
