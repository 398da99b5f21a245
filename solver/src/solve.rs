//! A solve of either method, with its checkpoint, its record and its files.

use std::collections::BTreeMap;
use std::path::Path;

use capture::{Camera, Capture, LightFrame, View};
use formats::atomic::{self, Folder};
use formats::maps::MapsError;
use formats::picture::Picture;

use crate::backend::Backend;
use crate::config::Config;
use crate::memory::{self, Estimate};
use crate::run::checkpoint::Checkpoint;
use crate::run::error::SolveError;
use crate::run::progress::{Callback, Options};
use crate::run::{Extent, Run, Work};
use crate::solution::{Record, Solution, ViewLayers};
use crate::{exposure, paper, unshade};

/// Runs [`solve_on`] and writes the folder `maps`. A checkpoint next to it (`<maps>.checkpoint`) lets the same call
/// continue after an interrupt, to the same bytes. `program` identifies the program: checkpoints of other programs and
/// backends are ignored.
pub fn solve_into(
    backend: &dyn Backend,
    maps: &Path,
    program: &str,
    capture: &Capture,
    config: &Config,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    // First, so that a folder that cannot be written is refused before the work.
    atomic::refuse_overlap(maps, &[&capture.folder]).map_err(MapsError::from)?;
    atomic::require_space(maps, bytes_on_disk(capture, config)).map_err(MapsError::from)?;
    let folder = Folder::begin(maps).map_err(MapsError::from)?;
    let checkpoint = Checkpoint::beside(maps, program);
    let kept = checkpoint.folder().to_path_buf();
    let mut layers = |view: &ViewLayers| view.write_layers(folder.path());
    let options = Options { checkpoint: Some(checkpoint), layers: Some(&mut layers) };
    let solution = match solve_on(backend, capture, config, options, progress) {
        Ok(solution) => solution,
        Err(error) => {
            folder.abandon();
            return Err(error);
        }
    };
    solution.write_into(folder.path())?;
    folder.commit().map_err(MapsError::from)?;
    if solution.record.interrupted.is_none() {
        Checkpoint::remove(&kept);
    }
    Ok(solution)
}

/// Estimates the seconds of a solve of this extent on two cores with AVX-512, where the costs of its stages were
/// measured.
pub fn seconds_on_two_cores(config: &Config, extent: &Extent) -> f64 {
    plan(config, extent).iter().map(Work::seconds).sum()
}

/// The highlights of every training view, as a fast solve of a capture predicts them, and whether it was interrupted.
fn highlights(
    backend: &dyn Backend,
    capture: &Capture,
    progress: &mut Callback,
) -> Result<(Vec<Picture>, bool), SolveError> {
    let config = Config::from_toml("base = \"fast\"\n[records]\nlayers = true\n")?;
    let mut highlights = BTreeMap::new();
    let mut sink = |view: &ViewLayers| {
        let Picture { width, height, channels, data } = &view.picture;
        let specular = data.chunks_exact(*channels).flat_map(|pixel| &pixel[6..9]).copied();
        let picture =
            Picture { width: *width, height: *height, channels: 3, data: specular.collect() };
        highlights.insert(view.name.clone(), picture);
        Ok(())
    };
    let options = Options { checkpoint: None, layers: Some(&mut sink) };
    let solution = solve_on(backend, capture, &config, options, progress)?;
    let empty = |camera: &Camera| Picture::new(camera.width, camera.height, 3);
    let of_view = |view: &View| highlights.remove(&view.camera.name).unwrap_or(empty(&view.camera));
    let pictures = capture.train.iter().map(of_view).collect();
    Ok((pictures, solution.record.interrupted.is_some()))
}

/// The steps and costs of the stages.
fn plan(config: &Config, extent: &Extent) -> Vec<Work> {
    match config {
        Config::Unshade(config) => unshade::plan(config, extent),
        Config::Paper(config) => paper::plan(config, extent),
    }
}

/// The approximate size of a maps folder on the disk, uncompressed: maps of 11 channels, and nine for every withheld
/// view; of every training view as well, in halves, if its layers are written.
fn bytes_on_disk(capture: &Capture, config: &Config) -> u64 {
    let pixels = |camera: &Camera| (camera.width * camera.height) as u64;
    let withheld: u64 = capture.withheld.iter().map(pixels).sum();
    let train: u64 = capture.train.iter().map(|view| pixels(&view.camera)).sum();
    let size = config.texture_size();
    let side = size.maps(size.solved(capture)) as u64;
    let layers = if config.records().layers { train * 9 * 2 } else { 0 };
    side * side * 11 * 4 + withheld * 9 * 4 + layers
}

/// Decomposes a capture into maps. `progress` is called after every step (on a device: after every submission) and may
/// stop the solve, which then makes maps of the current estimates and sets [`crate::Record::interrupted`].
///
/// Equal capture, configuration and backend give equal solutions for any number of threads.
pub fn solve_on(
    backend: &dyn Backend,
    capture: &Capture,
    config: &Config,
    options: Options<'_>,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    config.validate()?;
    if matches!(config, Config::Paper(_)) && !capture.truth.parts.is_empty() {
        return Err(SolveError::GivenToOther);
    }
    if let (Config::Paper(_), Some(lights)) = (config, capture.lights.beyond_one_still_light()) {
        return Err(SolveError::SeveralLights {
            lights,
            method: "the published method (paper, paper-tuned)",
        });
    }
    let estimate = Estimate::new(capture, config);
    estimate.fits(memory::available())?;
    let mut is_whole = true;
    let (capture, gains) = exposure::evened_without_highlights(capture, |even| {
        let (pictures, interrupted) = highlights(backend, even, progress)?;
        is_whole = !interrupted;
        Ok(pictures)
    })?;
    let capture = &*capture;
    let _kept = memory::KeepFreedMemory::begin();
    let Estimate { views, pixels, texture_size, .. } = estimate;
    let has_changing_light = capture.lights.beyond_one_still_light().is_some();
    let plan = plan(config, &Extent { views, pixels, texture_size, has_changing_light });
    let final_decay = match config {
        // Constant learning rates.
        Config::Unshade(_) => 1.0,
        Config::Paper(config) => config.adam.final_decay,
    };
    // Gains without all highlights differ from those of the same call that is not interrupted.
    let checkpoint = options.checkpoint.filter(|_| is_whole);
    let checkpoint = checkpoint.map(|checkpoint| checkpoint.of(capture, config, backend));
    let mut run = Run::new(plan, final_decay, backend, checkpoint, progress);
    let results = match config {
        Config::Unshade(config) => unshade::solve(capture, config, &mut run, options.layers)?,
        Config::Paper(config) => paper::solve(capture, config, &mut run, options.layers)?,
    };
    run.record_time("maps and views");
    let interrupted = run.interrupted();
    let (stages, timing) = run.into_log();
    let record = Record {
        solver: "unshade".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: config.seed(),
        config: config.clone(),
        backend: backend.name(),
        input: capture.hash().to_owned(),
        given: capture.truth.parts.iter().map(ToString::to_string).collect(),
        interrupted,
        light_distance: results.lights.first().and_then(|light| light.distance),
        light_frame: (capture.lights.frame == LightFrame::Camera).then_some("camera"),
        lights: if capture.lights.groups() > 1 { capture.lights.names.clone() } else { vec![] },
        gains,
        texture_size: results.texture_size,
        samples: results.samples,
        diffuse_scale: results.scales.diffuse,
        specular_scale: results.scales.specular,
        stages,
    };
    let crate::solution::Results { maps, diffuse_albedo_std, lights, views, stages, .. } = results;
    Ok(Solution { maps, diffuse_albedo_std, lights, views, stages, record, timing })
}
