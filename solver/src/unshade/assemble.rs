//! Maps, views and records from the estimates.

use capture::Camera;
use capture::gbuffer::{Atlas, GBuffer};
use capture::mean_texture::coverage;
use formats::cancel;
use formats::maps::Maps;
use formats::picture::Picture;

use super::albedo::{AlbedoEstimate, SampledLayers};
use super::confidence::deviation;
use super::known::Known;
use super::light::JointEstimate;
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
use crate::solution::{Results, ViewLayers};
use crate::transport::{CHANNELS, SpecularTerm};

/// The estimates of all stages.
pub(super) struct Estimates<'a> {
    pub known: Known<'a>,
    pub lighting: &'a Lighting<'a>,
    pub face: &'a FaceRegions,
    /// Its terms have the usual lobes, which belong to the light: it has absorbed a part of the difference to the
    /// measured roughness. Views use these.
    pub joint: &'a JointEstimate,
    /// The terms with the measured roughness, for the maps.
    pub measured_terms: &'a RegionTerms,
    pub relief: Relief,
    pub final_albedo: AlbedoEstimate,
    /// The number of samples of the full pictures.
    pub sample_count: usize,
}

/// Returns maps, withheld views and records.
pub(super) fn assemble(
    run: &Run,
    scene: &Scene,
    config: &UnshadeConfig,
    estimates: Estimates,
    layer_sink: Option<&mut LayerSink>,
) -> Result<Results, SolveError> {
    let Estimates {
        known,
        lighting,
        face,
        joint,
        measured_terms,
        relief,
        final_albedo,
        sample_count,
    } = estimates;
    let (mesh, size, map_size) = (&scene.capture.mesh, scene.size, scene.map_size);
    let seen = scene.seen(&Atlas::new(mesh, size));
    let diffuse = maps::fill_unseen(final_albedo.albedo, CHANNELS, &seen);
    let relief = Relief { deviation: maps::fill_unseen(relief.deviation, 3, &seen), ..relief };
    let total_scale = scene.picture_scale * measured_terms.exposure_error(&config.reflectance);
    let scales = Scales { diffuse: lighting.peak / total_scale, specular: 1.0 };
    let stages = match config.records.stages {
        true => {
            let snapshots = vec![
                Snapshot::new("joint").diffuse(&joint.albedo, lighting.size()),
                Snapshot::new("relief").deviation(&relief.deviation, size),
                Snapshot::new("albedo").diffuse(&diffuse, size),
            ];
            stage_maps(snapshots, scales, scene)
        }
        false => vec![],
    };
    let blurred = relief.blurred();
    let synthesise = |(number, camera): (usize, &Camera)| {
        cancel::check();
        let gbuffer = GBuffer::new(mesh, camera, None);
        let samples = scene.space.withheld(&gbuffer, number, size);
        let layers = SampledLayers::new(run, lighting, &joint.terms, &relief, &blurred, &samples);
        let albedo = samples.taps.sample::<CHANNELS>(&diffuse);
        let channels = ViewLayers::CHANNELS.len();
        let mut picture = Picture::new(camera.width, camera.height, channels);
        for (i, pixel) in samples.pixel.iter().enumerate() {
            let out = &mut picture.data[*pixel as usize * channels..][..channels];
            for c in 0..CHANNELS {
                let diffuse = albedo.get(c, i) * layers.shading.get(c, i) / scene.picture_scale;
                let specular = layers.highlights.get(c, i) / scene.picture_scale;
                (out[c], out[3 + c], out[6 + c]) = (diffuse + specular, diffuse, specular);
            }
        }
        ViewLayers { name: camera.name.clone(), picture }
    };
    let train = scene.capture.train.iter().map(|view| &view.camera);
    let withheld = (train.len()..).zip(&scene.capture.withheld);
    let views = withheld.map(synthesise).collect();
    if let Some(sink) = layer_sink.filter(|_| config.records.layers) {
        train.enumerate().map(synthesise).try_for_each(|view| sink(&view))?;
    }

    let atlas = Atlas::new(mesh, map_size);
    let seen = scene.seen(&atlas);
    let picture = |channels, data| Some(maps::square(data, channels, map_size));
    let relief = relief.resized(map_size);
    let diffuse = resample(&diffuse, size, CHANNELS, map_size);
    let confidence = resample(&final_albedo.confidence, size, 1, map_size);
    let confidence = confidence.iter().zip(&seen).map(|(c, seen)| if *seen { *c } else { 0.0 });
    let confidence: Vec<f32> = confidence.collect();
    let regions = face.region_map(scene, map_size);
    let albedo = maps::scaled(&diffuse, scales.diffuse);
    let texels = albedo.as_chunks::<CHANNELS>().0.iter().zip(regions.iter().zip(&confidence));
    let deviations = texels.flat_map(|(albedo, (region, confidence))| {
        let relative = deviation(*confidence, face.skin.contains(region));
        albedo.map(|channel| relative * channel)
    });
    let diffuse_albedo_std = picture(CHANNELS, deviations.collect());
    let terms = known.terms(measured_terms.clone(), config, map_size).texture(&regions);
    let terms: Vec<_> =
        terms.as_chunks().0.iter().map(|channels| SpecularTerm::of(*channels)).collect();
    let lobes = terms.iter().flat_map(|term| {
        let SkinConfig { roughness: [a, b], weights: [of_a, of_b], .. } =
            term.lobes_of(&config.skin);
        [a, b, of_a / (of_a + of_b)]
    });
    let maps = Maps {
        diffuse_albedo: picture(CHANNELS, albedo),
        specular_albedo: picture(1, terms.iter().map(|t| t.reflectance / total_scale).collect()),
        diffuse_normal: picture(3, maps::bent_normals(&atlas, &relief.blurred())),
        specular_normal: picture(3, maps::bent_normals(&atlas, &relief.deviation)),
        confidence: picture(1, confidence),
        roughness: picture(3, lobes.collect()).filter(|_| config.roughness.rounds > 0),
        coverage: Some(coverage(&seen)),
    };
    Ok(Results {
        maps,
        diffuse_albedo_std,
        lights: lighting.recovered(scene.picture_scale),
        views,
        stages,
        scales,
        texture_size: size,
        samples: sample_count,
    })
}
