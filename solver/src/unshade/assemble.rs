//! Maps, views and records from what has been estimated.

use capture::Camera;
use capture::gbuffer::{Atlas, GBuffer};
use formats::cancel;
use formats::maps::Maps;
use formats::picture::Picture;

use super::albedo::{AlbedoEstimate, Layers};
use super::lighting::Lighting;
use super::region_terms::RegionTerms;
use super::relief::Relief;
use crate::config::{SkinConfig, UnshadeConfig};
use crate::maps::{self, Scales, Snapshot, stage_maps};
use crate::model::texture::resample;
use crate::run::Run;
use crate::run::error::SolveError;
use crate::run::progress::LayerSink;
use crate::scene::Scene;
use crate::semantic::regions::FaceRegions;
use crate::solution::{RecoveredLight, Results, ViewLayers};
use crate::transport::CHANNELS;

/// Everything that maps and views are made of.
pub(super) struct Estimates<'a> {
    pub lighting: &'a Lighting<'a>,
    pub face: &'a FaceRegions,
    /// With the lobes under which the light was found: it has taken up a part of what differs from them.
    pub terms: &'a RegionTerms,
    /// With the measured roughness.
    pub measured_terms: &'a RegionTerms,
    pub relief: Relief,
    pub albedo: AlbedoEstimate,
    /// The number of samples of the full pictures.
    pub samples: usize,
}

/// Maps, withheld views and records.
pub(super) fn assemble(
    run: &Run,
    scene: &Scene,
    config: &UnshadeConfig,
    estimates: Estimates,
    layer_sink: Option<&mut LayerSink>,
) -> Result<Results, SolveError> {
    let Estimates { lighting, face, terms, measured_terms, relief, albedo, samples } = estimates;
    let (mesh, size, map_size) = (&scene.capture.mesh, scene.size, scene.map_size);
    let seen = scene.seen(&Atlas::new(mesh, size));
    let diffuse = maps::fill_unseen(albedo.albedo, CHANNELS, &seen);
    let relief = Relief { deviation: maps::fill_unseen(relief.deviation, 3, &seen), size };
    let exposure = scene.gain * measured_terms.exposure(&config.reflectance);
    let scales = Scales { diffuse: lighting.peak / exposure, specular: 1.0 };
    let stages = match config.records.stages {
        true => {
            let snapshots = vec![
                Snapshot::new("joint").diffuse(&lighting.albedo, lighting.size()),
                Snapshot::new("relief").deviation(&relief.deviation, size),
                Snapshot::new("albedo").diffuse(&diffuse, size),
            ];
            stage_maps(snapshots, scales, scene)
        }
        false => vec![],
    };
    let blurred = relief.blurred();
    let synthesise = |camera: &Camera| {
        cancel::check();
        let gbuffer = GBuffer::new(mesh, camera, None);
        let samples = scene.space.withheld(&gbuffer, size);
        let layers = Layers::new(run, lighting, terms, &relief, &blurred, &samples);
        let albedo = samples.taps.sample::<CHANNELS>(&diffuse);
        let channels = ViewLayers::CHANNELS.len();
        let mut picture = Picture::new(camera.width, camera.height, channels);
        for (i, pixel) in samples.pixel.iter().enumerate() {
            let out = &mut picture.data[*pixel as usize * channels..][..channels];
            for c in 0..CHANNELS {
                let diffuse = albedo.get(c, i) * layers.shading.get(c, i) / scene.gain;
                let specular = layers.highlights.get(c, i) / scene.gain;
                (out[c], out[3 + c], out[6 + c]) = (diffuse + specular, diffuse, specular);
            }
        }
        ViewLayers { name: camera.name.clone(), picture }
    };
    let views = scene.capture.withheld.iter().map(synthesise).collect();
    if let Some(sink) = layer_sink.filter(|_| config.records.layers) {
        let train = scene.capture.train.iter();
        train.map(|view| synthesise(&view.camera)).try_for_each(|view| sink(&view))?;
    }

    let atlas = Atlas::new(mesh, map_size);
    let seen = scene.seen(&atlas);
    let picture = |channels, data| Some(maps::square(data, channels, map_size));
    let relief = relief.resized(map_size);
    let diffuse = resample(&diffuse, size, CHANNELS, map_size);
    let confidence = resample(&albedo.confidence, size, 1, map_size);
    let confidence = confidence.iter().zip(&seen).map(|(c, seen)| if *seen { *c } else { 0.0 });
    let terms: Vec<_> =
        face.on(scene, map_size).iter().map(|region| measured_terms.of(*region)).collect();
    let lobes = terms.iter().flat_map(|term| {
        let SkinConfig { roughness: [a, b], weights: [of_a, of_b], .. } =
            term.lobes_of(&config.skin);
        [a, b, of_a / (of_a + of_b)]
    });
    let maps = Maps {
        diffuse_albedo: picture(CHANNELS, maps::scaled(&diffuse, scales.diffuse)),
        specular_albedo: picture(1, terms.iter().map(|t| t.reflectance / exposure).collect()),
        diffuse_normal: picture(3, maps::bent_normals(&atlas, &relief.blurred())),
        specular_normal: picture(3, maps::bent_normals(&atlas, &relief.deviation)),
        confidence: picture(1, confidence.collect()),
        roughness: picture(3, lobes.collect()).filter(|_| config.roughness.rounds > 0),
        coverage: Some(maps::coverage(&seen)),
    };
    let light = RecoveredLight {
        radiance: maps::scaled(&lighting.light.radiance, scene.gain.recip()),
        ..lighting.light.clone()
    };
    Ok(Results { maps, light: Some(light), views, stages, scales, texture_size: size, samples })
}
