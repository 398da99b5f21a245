//! Whole solves of captures, everything included.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use capture::Capture;
use solver::config::{PaperConfig, TextureRule, TextureSize};
use solver::memory::Estimate;
use solver::{Backend, BackendError, Config};

use super::error::BenchError;
use super::machine::{peak_memory, reset_peak_memory};
use super::rows::Solve;

/// Solves a capture with `unshade` and with `paper`, the latter with textures of the same side.
pub fn measure(capture: &Path, backend: &dyn Backend) -> Result<[Solve; 2], BenchError> {
    let mut paper = PaperConfig::default();
    paper.fine_tuning.texture_size = TextureSize::Rule(TextureRule::Auto);
    Ok([
        solve(capture, backend, "unshade", &Config::default())?,
        solve(capture, backend, "paper", &Config::Paper(paper))?,
    ])
}

fn solve(
    folder: &Path,
    backend: &dyn Backend,
    config_name: &'static str,
    config: &Config,
) -> Result<Solve, BenchError> {
    let device = backend.name();
    let out = tempfile::tempdir()?;
    let reset = reset_peak_memory();
    let start = Instant::now();
    let capture = Capture::open(folder)?;
    let estimate = Estimate::new(&capture, config);
    let maps = out.path().join("maps");
    let progress = &mut |_: &solver::Progress| ControlFlow::Continue(());
    let solution = solver::solve_into(backend, &maps, "bench", &capture, config, progress)?;
    let seconds = start.elapsed().as_secs_f64();
    // A solve continues on the processor; its time would not be the device's.
    if backend.name() != device {
        return Err(BackendError::Refused { name: device, reason: backend.name() }.into());
    }
    let stages = solution.timing.seconds.iter();
    Ok(Solve {
        capture: folder.file_name().unwrap_or_default().display().to_string(),
        config: config_name,
        device,
        pixels: solution.record.samples,
        texture: solution.record.texture_size,
        seconds,
        stages: stages
            .map(|(stage, seconds)| (stage.clone(), seconds.as_f64().unwrap_or(0.0)))
            .collect(),
        peak_memory: reset.then(peak_memory).flatten(),
        estimated_memory: estimate.peak,
    })
}
