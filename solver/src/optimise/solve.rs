//! The order of the stages, from a capture to a solution.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::normalise::Scales;
use super::relief::ReliefSolve;
use super::run::Run;
use super::stage::{Diffuse, Relief, State, WarmUp, layers};
use super::transported::{light_and_albedo, refined};
use crate::backend::Backend;
use crate::backend::cpu::Cpu;
use crate::capture::{Camera, Capture, View};
use crate::config::{Config, TextureRule, TextureSize, ViewWeightConfig};
use crate::error::{CaptureError, SolveError};
use crate::fill;
use crate::gbuffer::{Atlas, GBuffer};
use crate::maps::Maps;
use crate::model::deviation::{Bend, Deviation};
use crate::model::networks::Networks;
use crate::model::samples::{SampleSpace, Samples};
use crate::model::texture::resample;
use crate::picture::{GrayImage, Picture};
use crate::projection::{Projection, per_texel};
use crate::semantic;
use crate::solution::{Record, Solution, ViewLayers};

/// Where a solve stands.
#[derive(Clone, Debug)]
pub struct Progress<'a> {
    /// The stage at work.
    pub stage: &'a str,
    /// Steps done over all stages.
    pub iteration: usize,
    /// Steps of all stages.
    pub total: usize,
    /// The loss before the last step.
    pub loss: f64,
}

pub(super) type Callback<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + 'a;

/// Decomposes a capture into maps on the processor. `progress` is called after every step and may
/// stop the solve, which then ends in [`SolveError::Interrupted`].
///
/// The same capture and configuration give the same solution for any number of threads.
pub fn solve(
    capture: &Capture,
    config: &Config,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    solve_on(&Cpu::new(), capture, config, progress)
}

/// [`solve`] on a given backend.
pub fn solve_on(
    backend: &dyn Backend,
    capture: &Capture,
    config: &Config,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    config.validate()?;
    let mut run = Run::new(config, backend, progress);
    let mesh = &capture.mesh;
    let gbuffers = GBuffer::of_views(mesh, &capture.train);
    let space = SampleSpace::new(mesh, config);

    let pictures = WarmUpPictures::new(capture, &gbuffers, config);
    let samples = pictures.samples(&space, config.warm_up.texture_size);
    if samples.is_empty() {
        return Err(CaptureError::NothingVisible(capture.folder.clone()).into());
    }
    let mut state = initial_state(capture, &gbuffers, config);
    let initial = state.clone();
    run.lap("preparation");
    state.networks = run.best_start(config, &samples, &state)?;
    run.stage(&mut WarmUp::new(config, &samples, &state), &mut state)?;
    drop(samples);
    let lit = match config.transport.enabled {
        true => {
            let start = State { networks: state.networks.clone(), ..initial };
            Some(light_and_albedo(&mut run, config, mesh, &space, &pictures, start)?)
        }
        false => None,
    };
    drop(pictures);

    let warm = state.clone();
    let pixels = gbuffers.iter().map(GBuffer::len).sum();
    let size = texture_size(config.fine_tuning.texture_size, pixels);
    state.resize(size);
    let samples = space.training(&capture.train, &gbuffers, &config.view_weights, size);
    let deviation = Deviation::new(config, size);
    if config.height.enabled {
        let side = ((size as f32 * config.height.texture_share) as usize).max(16);
        let atlas = Atlas::new(mesh, side);
        let coarse = space.training(&capture.train, &gbuffers, &config.view_weights, side);
        let solve = ReliefSolve::new(config, backend, &coarse, &gbuffers, &atlas, &warm);
        let bend = run.relief(|step| solve.solve(&warm, step))?;
        state.deviation = resample(&bend, side, 3, size);
    }
    for round in 1..=config.fine_tuning.rounds {
        let mut relief = Relief::new(config, &samples, &deviation, &state, backend, round);
        run.stage(&mut relief, &mut state)?;
        drop(relief);
        let mut diffuse = Diffuse::new(config, &samples, &deviation, &state, backend, round);
        run.stage(&mut diffuse, &mut state)?;
    }

    let physical = match lit {
        Some(lit) => Some(refined(&mut run, config, &samples, &deviation, &state, lit)?),
        None => None,
    };

    let projections = Projection::of_views(&capture.train, &gbuffers);
    let seen = per_texel(&Atlas::new(mesh, size), &projections, |_| true);
    fill_unseen(&mut state, &seen);
    let shading = layers(&samples, &deviation, &state, backend);
    let shading = (0..samples.len()).map(|i| shading.get(0, i)).collect();
    let covered = state.specular.iter().zip(&seen).filter(|(_, seen)| **seen);
    let specular = covered.map(|(value, _)| *value).collect();
    let mut scales = Scales::new(&config.normalisation, shading, specular);
    let views = withheld_views(capture, &space, &deviation, &state, backend);
    if let Some(physical) = physical {
        scales.diffuse = physical.scale;
        state.diffuse = physical.diffuse;
        fill_unseen(&mut state, &seen);
    }

    let map_size = map_size(config.fine_tuning.texture_size, size);
    state.resize(map_size);
    let atlas = Atlas::new(mesh, map_size);
    let seen = per_texel(&atlas, &projections, |_| true);
    let maps = to_maps(&state, &Deviation::new(config, map_size), &atlas, &seen, scales);
    run.lap("maps and views");
    let record = Record {
        solver: "unshade".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: config.seed,
        config: config.clone(),
        backend: backend.name(),
        input: capture.hash().to_owned(),
        texture_size: size,
        samples: samples.len(),
        diffuse_scale: scales.diffuse,
        specular_scale: scales.specular,
        stages: run.stages,
    };
    Ok(Solution { maps, views, record, timing: run.timing })
}

/// The training pictures as the warm-up takes them.
pub(super) struct WarmUpPictures {
    views: Vec<View>,
    gbuffers: Vec<GBuffer>,
    weights: ViewWeightConfig,
}

impl WarmUpPictures {
    fn new(capture: &Capture, gbuffers: &[GBuffer], config: &Config) -> Self {
        let mut weights = config.view_weights.clone();
        if !config.warm_up.half_resolution {
            return Self { views: capture.train.clone(), gbuffers: gbuffers.to_vec(), weights };
        }
        weights.depth_blur *= 0.5;
        let views: Vec<View> = capture.train.par_iter().map(View::half).collect();
        let gbuffers = GBuffer::of_views(&capture.mesh, &views);
        Self { views, gbuffers, weights }
    }

    /// The usable pixels, for textures of side `size`.
    pub fn samples(&self, space: &SampleSpace, size: usize) -> Samples {
        space.training(&self.views, &self.gbuffers, &self.weights, size)
    }
}

/// The power of two nearest to one texel per pixel.
fn texture_size(size: TextureSize, pixels: usize) -> usize {
    match size {
        TextureSize::Side(texels) => texels,
        TextureSize::Rule(TextureRule::Auto) => {
            let exponent = (pixels.max(1) as f64).sqrt().log2().round() as u32;
            2usize.pow(exponent.clamp(7, 11))
        }
    }
}

/// Maps from few pixels are written larger than they were solved, for the sake of the mesh normal
/// in them.
fn map_size(size: TextureSize, solved: usize) -> usize {
    match size {
        TextureSize::Side(texels) => texels,
        TextureSize::Rule(TextureRule::Auto) => solved.max(512),
    }
}

fn initial_state(capture: &Capture, gbuffers: &[GBuffer], config: &Config) -> State {
    let size = config.warm_up.texture_size;
    let unlabelled: Vec<View>;
    let views = if config.initialisation.semantic {
        &capture.train
    } else {
        let strip = |view: &View| View { labels: None, ..view.clone() };
        unlabelled = capture.train.iter().map(strip).collect();
        &unlabelled
    };
    let diffuse = semantic::initial_diffuse_albedo(&capture.mesh, views, gbuffers, size).data;
    let grey: Vec<f32> = diffuse.chunks_exact(3).map(|rgb| rgb.iter().sum::<f32>() / 3.0).collect();
    let brightest = grey.iter().fold(f32::MIN_POSITIVE, |m, g| m.max(*g));
    let scale = config.initialisation.specular_maximum / brightest;
    State {
        networks: Networks::new(&config.networks, config.seed),
        size,
        specular: grey.iter().map(|grey| grey * scale).collect(),
        deviation: vec![0.0; diffuse.len()],
        diffuse,
    }
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
    let Bend { sharp, blurred } = deviation.textures(&state.deviation);
    let coverage = seen.iter().map(|seen| if *seen { 255 } else { 0 }).collect();
    Maps {
        diffuse_albedo: picture(3, scaled(&state.diffuse, scales.diffuse)),
        specular_albedo: picture(1, scaled(&state.specular, scales.specular)),
        diffuse_normal: picture(3, bent(&blurred)),
        specular_normal: picture(3, bent(&sharp)),
        coverage: Some(GrayImage { width: size, height: size, data: coverage }),
    }
}

/// The withheld views as the model sees them, in the pictures' exposure.
fn withheld_views(
    capture: &Capture,
    space: &SampleSpace,
    deviation: &Deviation,
    state: &State,
    backend: &dyn Backend,
) -> Vec<ViewLayers> {
    let synthesise = |camera: &Camera| {
        let gbuffer = GBuffer::new(&capture.mesh, camera, None);
        let samples = space.withheld(&gbuffer, state.size);
        let shading = layers(&samples, deviation, state, backend);
        let albedo = state.albedo(&samples);
        let channels = ViewLayers::CHANNELS.len();
        let mut picture = Picture::new(camera.width, camera.height, channels);
        for (i, pixel) in samples.pixel.iter().enumerate() {
            let [diffuse, specular]: [f32; 2] = shading.sample(i, 0);
            let out = &mut picture.data[*pixel as usize * channels..][..channels];
            for (channel, albedo) in albedo.sample::<3>(i, 0).into_iter().enumerate() {
                out[channel] = albedo * diffuse + specular;
                out[3 + channel] = albedo * diffuse;
                out[6 + channel] = specular;
            }
        }
        ViewLayers { name: camera.name.clone(), picture }
    };
    capture.withheld.iter().map(synthesise).collect()
}
