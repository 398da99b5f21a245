//! The order of the stages, from a capture to a solution.

use std::ops::ControlFlow;
use std::time::Instant;

use rayon::prelude::*;

use super::normalise::Scales;
use super::stage::{Diffuse, Relief, Stage, State, WarmUp, layers};
use crate::backend::Backend;
use crate::backend::cpu::Cpu;
use crate::capture::{Camera, Capture, View};
use crate::config::{Config, TextureRule, TextureSize};
use crate::error::{CaptureError, SolveError};
use crate::fill;
use crate::gbuffer::{Atlas, GBuffer};
use crate::maps::Maps;
use crate::model::deviation::{Bend, Deviation};
use crate::model::networks::Networks;
use crate::model::samples::{SampleSpace, Samples};
use crate::picture::{GrayImage, Picture};
use crate::projection::{Projection, per_texel};
use crate::semantic;
use crate::solution::{Record, Solution, StageRecord, Timing, ViewLayers};

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

type Callback<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + 'a;

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

    let (views, reduced);
    if config.warm_up.half_resolution {
        views = capture.train.par_iter().map(View::half).collect::<Vec<_>>();
        reduced = GBuffer::of_views(mesh, &views);
    } else {
        (views, reduced) = (capture.train.clone(), gbuffers.clone());
    }
    let ratio = if config.warm_up.half_resolution { 0.5 } else { 1.0 };
    let mut weights = config.view_weights.clone();
    weights.depth_blur *= ratio;
    let samples = space.training(&views, &reduced, &weights, config.warm_up.texture_size);
    if samples.is_empty() {
        return Err(CaptureError::NothingVisible(capture.folder.clone()).into());
    }
    let mut state = initial_state(capture, &gbuffers, config);
    run.lap("preparation");
    state.networks = run.best_start(config, &samples, &state)?;
    run.stage(&mut WarmUp::new(config, &samples, &state), &mut state)?;
    drop(samples);

    let pixels = gbuffers.iter().map(GBuffer::len).sum();
    let size = texture_size(config.fine_tuning.texture_size, pixels);
    state.resize(size);
    let samples = space.training(&capture.train, &gbuffers, &config.view_weights, size);
    let deviation = Deviation::new(config, size);
    for round in 1..=config.fine_tuning.rounds {
        let mut relief = Relief::new(config, &samples, &deviation, &state, backend, round);
        run.stage(&mut relief, &mut state)?;
        drop(relief);
        let mut diffuse = Diffuse::new(config, &samples, &deviation, &state, backend, round);
        run.stage(&mut diffuse, &mut state)?;
    }

    let projections = Projection::of_views(&capture.train, &gbuffers);
    let seen = per_texel(&Atlas::new(mesh, size), &projections, |_| true);
    fill_unseen(&mut state, &seen);
    let shading = layers(&samples, &deviation, &state, backend);
    let shading = (0..samples.len()).map(|i| shading.get(0, i)).collect();
    let covered = state.specular.iter().zip(&seen).filter(|(_, seen)| **seen);
    let specular = covered.map(|(value, _)| *value).collect();
    let scales = Scales::new(&config.normalisation, shading, specular);
    let views = withheld_views(capture, &space, &deviation, &state, backend);

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

/// The bookkeeping of a solve.
struct Run<'a, 'b> {
    backend: &'a dyn Backend,
    progress: &'a mut Callback<'b>,
    final_share: f32,
    done: usize,
    total: usize,
    stages: Vec<StageRecord>,
    timing: Timing,
    lap: Instant,
}

impl<'a, 'b> Run<'a, 'b> {
    fn new(config: &Config, backend: &'a dyn Backend, progress: &'a mut Callback<'b>) -> Self {
        let (fine, first) = (&config.fine_tuning, &config.initialisation);
        let trials = if first.starts > 1 { first.starts * first.start_iterations } else { 0 };
        Self {
            backend,
            progress,
            final_share: config.adam.final_share,
            done: 0,
            total: trials + config.warm_up.iterations + 2 * fine.rounds * fine.iterations,
            stages: vec![],
            timing: Timing::default(),
            lap: Instant::now(),
        }
    }

    fn lap(&mut self, what: &str) {
        let now = Instant::now();
        let seconds = now.duration_since(self.lap).as_secs_f64();
        self.timing.seconds.insert(what.to_owned(), seconds.into());
        self.lap = now;
    }

    /// The initial weights from which a short warm-up comes furthest.
    fn best_start(
        &mut self,
        config: &Config,
        samples: &Samples,
        state: &State,
    ) -> Result<Networks, SolveError> {
        let first = &config.initialisation;
        let mut trial = config.clone();
        trial.warm_up.iterations = first.start_iterations;
        let mut best = (f64::INFINITY, state.networks.clone());
        for start in 0..if first.starts > 1 { first.starts } else { 0 } {
            let networks = Networks::new(&config.networks, config.seed + start as u64);
            let mut state = State { networks: networks.clone(), ..state.clone() };
            let mut warm_up = WarmUp::new(&trial, samples, &state);
            let losses = self.steps(&format!("start {}", start + 1), &mut warm_up, &mut state)?;
            let tail = &losses[losses.len() - losses.len().div_ceil(10)..];
            let loss = tail.iter().sum::<f64>() / tail.len() as f64;
            if loss < best.0 {
                best = (loss, networks);
            }
        }
        self.lap("starts");
        Ok(best.1)
    }

    fn stage(&mut self, stage: &mut dyn Stage, state: &mut State) -> Result<(), SolveError> {
        let name = stage.name();
        let loss = self.steps(&name, stage, state)?;
        self.lap(&name);
        self.stages.push(StageRecord { name, loss });
        Ok(())
    }

    /// Does a stage's steps and returns the losses.
    fn steps(
        &mut self,
        name: &str,
        stage: &mut dyn Stage,
        state: &mut State,
    ) -> Result<Vec<f64>, SolveError> {
        let iterations = stage.iterations();
        let mut losses = Vec::with_capacity(iterations);
        for iteration in 1..=iterations {
            let share = share(self.final_share, iteration, iterations);
            let loss = stage.step(state, self.backend, share);
            if !loss.is_finite() {
                return Err(SolveError::NotFinite { stage: name.to_owned(), iteration, loss });
            }
            losses.push(loss);
            self.done += 1;
            let (iteration, total) = (self.done, self.total);
            let progress = Progress { stage: name, iteration, total, loss };
            if (self.progress)(&progress).is_break() {
                return Err(SolveError::Interrupted);
            }
        }
        Ok(losses)
    }
}

/// The share of the learning rate: whole at first, then falling geometrically to `last` over the
/// final 40 % of a stage.
fn share(last: f32, iteration: usize, iterations: usize) -> f32 {
    let progress = iteration as f32 / iterations as f32;
    last.powf(((progress - 0.6) / 0.4).max(0.0))
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
