//! The end of a solve: maps, withheld views and the record of what has been found.

use capture::Camera;
use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::{Projection, per_texel};
use formats::maps::Maps;
use formats::picture::{GrayImage, Picture};
use formats::{cancel, fill};

use super::clock::{Extent, Work};
use super::context::SolveContext;
use super::error::SolveError;
use super::found::Solve;
use super::lighting::Highlights;
use super::normalise::Scales;
use super::pooled_specular;
use super::progress::LayerSink;
use super::refinement::refinement;
use super::snapshot::stage_maps;
use super::stage::{State, layers};
use super::stage_runner::StageRunner;
use crate::config::{Config, SkinConfig, map_size};
use crate::model::deviation::Deviation;
use crate::model::deviation_textures::DeviationTextures;
use crate::model::planes::Planes;
use crate::model::texture::resample;
use crate::solution::{Record, Solution, ViewLayers};

/// The work that this takes.
pub(super) fn finishing(config: &Config, extent: &Extent) -> Work {
    let side = map_size(config.fine_tuning.texture_size, extent.texture_size);
    Work { preparation: 1e-6 * (side * side + extent.pixels) as f64, ..Work::default() }
}

/// Makes a solution of what there is; after an interrupt that may be little, but it is valid.
/// The layers of the training views go to `layers`, if there is one and the configuration wants it.
pub(super) fn finish(
    context: &SolveContext,
    mut runner: StageRunner,
    mut solve: Solve,
    layer_sink: Option<&mut LayerSink>,
) -> Result<Solution, SolveError> {
    let SolveContext { backend, capture, config, size, .. } = *context;
    let mesh = &capture.mesh;
    // Does nothing unless an interrupt came before it.
    refinement(context, &mut runner, &mut solve)?;
    let Solve { mut state, diffuse_reflectance, lighting, snapshots, .. } = solve;
    state.resize(size);
    let (samples, deviation) = (&context.fine().samples, &context.fine().deviation);

    let projections = Projection::of_views(&capture.train, &context.gbuffers);
    let seen = per_texel(&Atlas::new(mesh, size), &projections, |_| true);
    fill_unseen(&mut state, &seen);
    let shading = layers(samples, deviation, &state, backend);
    let shading = (0..samples.len()).map(|i| shading.get(0, i)).collect();
    let covered = state.specular.iter().zip(&seen).filter(|(_, seen)| **seen);
    let specular = covered.map(|(value, _)| *value).collect();
    let mut scales = Scales::new(&config.normalisation, shading, specular);
    scales.diffuse /= context.gain;
    if config.normalisation.specular_skin > 0.0 {
        let regions = context.regions(&Atlas::new(mesh, size), &projections);
        let skin = pooled_specular::of_largest_region(regions.as_deref(), &seen, &state.specular);
        scales.specular = config.normalisation.specular_skin / skin.max(f32::MIN_POSITIVE);
    }
    let physical_scale =
        diffuse_reflectance.as_ref().map(|diffuse_reflectance| diffuse_reflectance.scale);
    let stages = stage_maps(snapshots, scales, physical_scale, mesh, &projections);
    let highlights = lighting.as_ref().and_then(|lighting| lighting.highlights(&state));
    let synthesise =
        |camera: &Camera| synthesised(camera, context, deviation, &state, highlights.as_ref());
    let views = capture.withheld.iter().map(synthesise).collect();
    if let Some(sink) = layer_sink.filter(|_| config.records.layers) {
        capture.train.iter().try_for_each(|view| sink(&synthesise(&view.camera)))?;
    }
    let region_terms = lighting.as_ref().and_then(|lighting| {
        let mut all = lighting.region_terms.clone()?;
        all.scale(1.0 / (context.gain * lighting.exposure));
        Some(all)
    });
    let light = lighting.map(|mut lighting| {
        lighting.light.radiance.iter_mut().for_each(|radiance| *radiance /= context.gain);
        lighting.light
    });
    let mut confidence = None;
    if let Some(diffuse_reflectance) = diffuse_reflectance {
        confidence = Some(diffuse_reflectance.confidence);
        scales.diffuse = diffuse_reflectance.scale;
        state.diffuse = diffuse_reflectance.diffuse;
        fill_unseen(&mut state, &seen);
    }

    let map_size = map_size(config.fine_tuning.texture_size, size);
    state.resize(map_size);
    let atlas = Atlas::new(mesh, map_size);
    let seen = per_texel(&atlas, &projections, |_| true);
    let mut roughness: Option<Vec<SkinConfig>> = None;
    if config.normalisation.specular_pooling > 0.0 {
        let config = &config.normalisation;
        let regions = context.regions(&atlas, &projections);
        let regions = regions.as_deref();
        state.specular = match (&region_terms, regions) {
            (Some(region_terms), Some(regions)) => {
                scales.specular = 1.0;
                let terms = || regions.iter().map(|region| region_terms.of(*region));
                roughness = Some(terms().map(|term| term.lobes_of(&context.config.skin)).collect());
                terms().map(|term| term.reflectance).collect()
            }
            _ => pooled_specular::pooled(config, &atlas, regions, &seen, &state.specular),
        };
    }
    let mut maps = to_maps(&state, &Deviation::new(config, map_size), &atlas, &seen, scales);
    maps.confidence = confidence.map(|confidence| Picture {
        width: map_size,
        height: map_size,
        channels: 1,
        data: resample(&confidence, size, 1, map_size)
            .iter()
            .zip(&seen)
            .map(|(trust, seen)| if *seen { *trust } else { 0.0 })
            .collect(),
    });
    if config.reflectance.roughness_rounds > 0 {
        maps.roughness = roughness.map(|lobes| roughness_map(&lobes, map_size));
    }
    runner.lap("maps and views");
    let interrupted = runner.cut().map(ToString::to_string);
    let (stage_records, timing) = runner.into_log();
    let record = Record {
        solver: "unshade".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: config.seed,
        config: config.clone(),
        backend: backend.name(),
        input: capture.hash().to_owned(),
        interrupted,
        light_distance: light.as_ref().and_then(|light| light.distance),
        texture_size: size,
        samples: samples.len(),
        diffuse_scale: scales.diffuse,
        specular_scale: scales.specular,
        stages: stage_records,
    };
    Ok(Solution { maps, light, views, stages, record, timing })
}

/// Both alphas, and the part of the first lobe.
fn roughness_map(lobes: &[SkinConfig], size: usize) -> Picture {
    let texel = |SkinConfig { roughness: [a, b], weights: [of_a, of_b], .. }: &SkinConfig| {
        [*a, *b, of_a / (of_a + of_b)]
    };
    let data = lobes.iter().flat_map(texel).collect();
    Picture { width: size, height: size, channels: 3, data }
}

/// Texels that no view sees take the values of the nearest one that is seen.
fn fill_unseen(state: &mut State, seen: &[bool]) {
    for (texture, channels) in
        [(&mut state.diffuse, 3), (&mut state.specular, 1), (&mut state.deviation, 3)]
    {
        let (width, height) = (state.size, state.size);
        let mut picture = Picture { width, height, channels, data: std::mem::take(texture) };
        fill::fill_from_nearest(&mut picture, seen);
        *texture = picture.data;
    }
}

fn to_maps(
    state: &State,
    deviation: &Deviation,
    atlas: &Atlas,
    seen: &[bool],
    scales: Scales,
) -> Maps {
    let size = state.size;
    let picture = |channels: usize, data: Vec<f32>| {
        Some(Picture { width: size, height: size, channels, data })
    };
    let scaled = |texture: &[f32], scale: f32| texture.iter().map(|value| value * scale).collect();
    let bent = |texture: &[f32]| {
        let normals = atlas.normals.iter().zip(texture.chunks_exact(3));
        normals.flat_map(|(n, d)| (n + glam::Vec3::from_slice(d)).normalize().to_array()).collect()
    };
    let DeviationTextures { sharp, blurred } = deviation.textures(&state.deviation);
    let coverage = seen.iter().map(|seen| if *seen { 255 } else { 0 }).collect();
    Maps {
        diffuse_albedo: picture(3, scaled(&state.diffuse, scales.diffuse)),
        specular_albedo: picture(1, scaled(&state.specular, scales.specular)),
        diffuse_normal: picture(3, bent(&blurred)),
        specular_normal: picture(3, bent(&sharp)),
        confidence: None,
        roughness: None,
        coverage: Some(GrayImage { width: size, height: size, data: coverage }),
    }
}

/// A view as the networks see it, in the pictures' exposure. Its highlights are those of the explicit
/// transport, if there are any; the sum stays the networks'.
fn synthesised(
    camera: &Camera,
    context: &SolveContext,
    deviation: &Deviation,
    state: &State,
    highlights: Option<&Highlights>,
) -> ViewLayers {
    cancel::check();
    let gbuffer = GBuffer::new(&context.capture.mesh, camera, None);
    let samples = context.space.withheld(&gbuffer, state.size);
    let shading = layers(&samples, deviation, state, context.backend);
    let highlights = highlights.map(|all| all.at(&samples, deviation, context.backend));
    let albedo = state.albedo(&samples);
    let channels = ViewLayers::CHANNELS.len();
    let mut picture = Picture::new(camera.width, camera.height, channels);
    for (i, pixel) in samples.pixel.iter().enumerate() {
        let [diffuse, specular]: [f32; 2] = shading.sample(i, 0);
        let out = &mut picture.data[*pixel as usize * channels..][..channels];
        for (channel, albedo) in albedo.sample::<3>(i, 0).into_iter().enumerate() {
            let whole = albedo * diffuse + specular;
            let out_of = |value: f32| value / context.gain;
            let part = |highlights: &Planes| highlights.get(0, i).min(whole).max(0.0);
            let specular = highlights.as_ref().map_or(specular, part);
            out[channel] = out_of(whole);
            out[3 + channel] = out_of(whole - specular);
            out[6 + channel] = out_of(specular);
        }
    }
    ViewLayers { name: camera.name.clone(), picture }
}
