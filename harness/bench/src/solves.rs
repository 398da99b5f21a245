//! Whole solves of captures, everything included.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use capture::Capture;
use serde::Serialize;
use solver::config::{PaperConfig, TextureRule, TextureSize};
use solver::memory::Estimate;
use solver::{Backend, BackendError, Config};

use super::clock::{forget_peak, peak_memory};
use super::error::BenchError;

/// A solve.
#[derive(Debug, Serialize)]
pub struct Solved {
    /// The capture's name.
    pub capture: String,
    /// The configuration's name.
    pub config: &'static str,
    /// Training views and their foreground pixels.
    pub views: usize,
    /// Foreground pixels.
    pub pixels: usize,
    /// Side of the fine-tuned textures.
    pub texture: usize,
    /// From the files of the capture to the files of the maps.
    pub seconds: f64,
    /// Stage by stage.
    pub stages: Vec<(String, f64)>,
    /// Largest resident set of the host, bytes.
    pub peak_memory: Option<u64>,
    /// Bytes that the solver had estimated beforehand.
    pub estimated_memory: u64,
}

/// Solves a capture with `unshade` and with `paper`, the latter with textures of the same side.
pub fn measure(capture: &Path, backend: &dyn Backend) -> Result<[Solved; 2], BenchError> {
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
) -> Result<Solved, BenchError> {
    let device = backend.name();
    let out = tempfile::tempdir()?;
    let forgot = forget_peak();
    let start = Instant::now();
    let capture = Capture::open(folder)?;
    let estimate = Estimate::new(&capture, config);
    let maps = out.path().join("maps");
    let go_on = &mut |_: &solver::Progress| ControlFlow::Continue(());
    let solution = solver::solve_into(backend, &maps, "bench", &capture, config, go_on)?;
    let seconds = start.elapsed().as_secs_f64();
    // A solve goes on on the processor; its time would not be the device's.
    if backend.name() != device {
        return Err(BackendError::Refused { name: device, reason: backend.name() }.into());
    }
    let stages = solution.timing.seconds.iter();
    Ok(Solved {
        capture: folder.file_name().unwrap_or_default().display().to_string(),
        config: config_name,
        views: estimate.views,
        pixels: solution.record.samples,
        texture: solution.record.texture_size,
        seconds,
        stages: stages
            .map(|(stage, seconds)| (stage.clone(), seconds.as_f64().unwrap_or(0.0)))
            .collect(),
        peak_memory: forgot.then(peak_memory).flatten(),
        estimated_memory: estimate.peak,
    })
}
