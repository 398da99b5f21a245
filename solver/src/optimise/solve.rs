//! The order of the steps, from a capture to a solution.

use std::path::Path;

use capture::{Camera, Capture};
use formats::atomic::{self, Folder};
use formats::maps::MapsError;

use super::checkpoint::Checkpoint;
pub use super::clock::Extent;
use super::clock::Work;
use super::context::SolveContext;
use super::error::SolveError;
use super::finish::{finish, finishing};
use super::found::Solve;
use super::progress::{Callback, Options};
use super::stage_runner::StageRunner;
use super::steps::Step;
use crate::backend::Backend;
use crate::config::{Config, map_size, texture_size};
use crate::memory::{self, Estimate};
use crate::solution::{Solution, ViewLayers};

/// [`solve_on`] into the folder `maps`, with a checkpoint beside it (`<maps>.checkpoint`) from which
/// the same call goes on after an interrupt, to the same bytes. `program` tells apart programs that
/// would not: a checkpoint of another one is not used, nor of another backend.
pub fn solve_into(
    backend: &dyn Backend,
    maps: &Path,
    program: &str,
    capture: &Capture,
    config: &Config,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    // Now, so that what cannot be written is known before the work.
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

/// Seconds that a solve of this extent takes on two cores with AVX-512, where the costs of its steps were measured.
pub fn seconds_on_two_cores(config: &Config, extent: &Extent) -> f64 {
    work(config, extent).iter().map(Work::seconds).sum()
}

/// The cost of each step, and of what comes after them.
fn work(config: &Config, extent: &Extent) -> Vec<Work> {
    let mut work: Vec<Work> =
        Step::all(config).iter().map(|step| step.work(config, extent)).collect();
    work.push(finishing(config, extent));
    work
}

/// About what a maps folder takes on the disk, uncompressed: maps of 11 channels, and nine for every
/// withheld view; of every training view as well, in halves, if its layers are kept.
fn bytes_on_disk(capture: &Capture, config: &Config) -> u64 {
    let pixels = |camera: &Camera| (camera.width * camera.height) as u64;
    let withheld: u64 = capture.withheld.iter().map(pixels).sum();
    let train: u64 = capture.train.iter().map(|view| pixels(&view.camera)).sum();
    let solved = texture_size(config.fine_tuning.texture_size, capture);
    let layers = if config.records.layers { train * 9 * 2 } else { 0 };
    let side = map_size(config.fine_tuning.texture_size, solved) as u64;
    side * side * 11 * 4 + withheld * 9 * 4 + layers
}

/// Decomposes a capture into maps. `progress` is called after every step (a device that takes in whole
/// stages: every submission) and may stop the solve, which then makes maps of what it has and says so
/// in [`crate::Record::interrupted`].
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
    Estimate::new(capture, config).fits(memory::available())?;
    let _kept = memory::KeepFreedMemory::begin();
    let mut context = SolveContext::new(backend, capture, config);
    let steps = Step::all(config);
    let work = work(config, &context.extent());
    let mut runner = StageRunner::new(config, work, backend, progress);
    let checkpoint = options.checkpoint.map(|checkpoint| checkpoint.of(capture, config, backend));
    let mut solve = match checkpoint.and_then(|checkpoint| runner.resume(checkpoint)) {
        Some(solve) => solve,
        None => {
            let solve = Solve::new(&context)?;
            runner.lap("preparation");
            runner.save(&solve);
            solve
        }
    };
    for step in &steps[solve.finished.min(steps.len())..] {
        step.take(&mut context, &mut runner, &mut solve)?;
        if config.records.stages {
            solve.snapshots.extend(step.snapshot(&context, &solve));
        }
        if runner.cut().is_some() {
            break;
        }
        solve.finished += 1;
        runner.next_part();
        runner.save(&solve);
    }
    finish(&context, runner, solve, options.layers)
}
