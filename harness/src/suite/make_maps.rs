//! Turns a capture into maps, whichever way a method of the suite does it.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

use indicatif::HumanDuration;
use scoring::score;

use super::error::RunError;
use super::method::MethodKind;
use super::preflight::Ready;
use super::program::{Place, Usage};
use super::sources::SOLVER_SOURCES;
use super::tools::Tools;

/// Ends what is said of a step that knows better than its share how long the rest takes.
pub const TIME_LEFT: &str = " left";

/// Writes the maps of a place from its capture.
pub(super) fn make_maps(
    ready: &Ready,
    place: Place,
    tools: &Tools,
    progress: &mut dyn FnMut(u64, u64, &str),
) -> Result<Option<Usage>, RunError> {
    let Place { capture, maps, .. } = place;
    let Ready { method, files, .. } = ready;
    match (&method.kind, files) {
        (MethodKind::Baseline { baseline, texture_size }, _) => {
            baseline.make(capture, maps, *texture_size)?;
        }
        (MethodKind::Competitor { competitor, settings }, _) => {
            competitor.make(settings, capture, maps, tools, progress)?;
        }
        (MethodKind::Fields { config, backend }, _) => {
            let config = solver::Config::from_toml(config)?;
            let backend = backend.open()?;
            let capture = capture::Capture::open(capture)?;
            solve(&*backend, &capture, &config, maps, tools, &mut |step| {
                progress(step.iteration as u64, step.total as u64, &in_words(step));
            })?;
        }
        (MethodKind::Program(program), Some(files)) => {
            return program.run(&method.id, files, &place, &tools.interrupt, progress).map(Some);
        }
        (MethodKind::LabelMeans, _) => score::label_mean_maps(capture, maps)?,
        (MethodKind::Oracle | MethodKind::Program(_), _) => score::oracle_maps(capture, maps)?,
    }
    Ok(None)
}

/// The configuration that a preset's name or a file's path stands for. What has a folder or an ending in it, or is
/// a file here, is a path.
pub fn solver_config(given: &str) -> Result<solver::Config, RunError> {
    let path = Path::new(given);
    if !path.is_file() && path.extension().is_none() && path.components().count() < 2 {
        return Ok(solver::Config::preset(given)?);
    }
    let path = path.to_path_buf();
    match fs::read_to_string(&path) {
        Ok(text) => {
            solver::Config::from_toml(&text).map_err(|reason| RunError::ConfigFile { path, reason })
        }
        Err(reason) => Err(RunError::File { path, reason }),
    }
}

/// Our own solver. An interrupt leaves maps of what there is, and a checkpoint beside them; it is an
/// error nevertheless, so that nobody takes them for finished.
pub fn solve(
    backend: &dyn solver::Backend,
    capture: &capture::Capture,
    config: &solver::Config,
    maps: &Path,
    tools: &Tools,
    hear: &mut dyn FnMut(&solver::Progress),
) -> Result<solver::Solution, RunError> {
    let solution =
        solver::solve_into(backend, maps, SOLVER_SOURCES, capture, config, &mut |step| {
            if tools.interrupt.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            hear(step);
            ControlFlow::Continue(())
        })?;
    match solution.record.interrupted {
        Some(place) => Err(RunError::Stopped { place, maps: maps.to_path_buf() }),
        None => Ok(solution),
    }
}

/// Text beside a progress bar.
pub fn in_words(step: &solver::Progress) -> String {
    format!(
        "{} {}/{}, loss {:.5}, {}{TIME_LEFT}",
        step.stage,
        step.step,
        step.steps,
        step.loss,
        HumanDuration(Duration::from_secs_f64(step.seconds_left.max(0.0)))
    )
}
