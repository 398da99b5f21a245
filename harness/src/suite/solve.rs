//! Our own solver, on a capture.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

use indicatif::HumanDuration;

use super::error::RunError;
use super::sources::SOLVER_SOURCES;
use crate::synth::Tools;

/// Ends the text of a step that has its own estimate of the time left.
pub const TIME_LEFT: &str = " left";

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
    report: &mut dyn FnMut(&solver::Progress),
) -> Result<solver::Solution, RunError> {
    let solution =
        solver::solve_into(backend, maps, SOLVER_SOURCES, capture, config, &mut |step| {
            if tools.interrupt.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            report(step);
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
