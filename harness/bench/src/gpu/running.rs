//! A stage's program on the device, and its times.

use std::time::{Duration, Instant};

use solver::BackendError;
use solver::backend::Backend;
use solver::backend::gpu::Gpu;
use solver::backend::resident::{BATCH, DeviceError, Resident};
use solver::model::deviation::Deviation;

use super::rows::{GpuStep, PassRow};
use crate::kind::Kind;
use crate::steps::{Reach, least_work};
use crate::synthetic::Problem;

/// Steps that every pass is timed in.
const TIMED: usize = 4;

/// Uploaded, with nothing left on the host.
pub struct Running<'a> {
    gpu: &'a Gpu,
    reach: Reach,
    program: Box<dyn Resident + 'a>,
    kind: Kind,
    pixels: usize,
    texture: usize,
}

impl<'a> Running<'a> {
    pub fn new(
        gpu: &'a Gpu,
        reach: Reach,
        kind: Kind,
        problem: &Problem,
    ) -> Result<Self, BackendError> {
        let deviation = Deviation::new(&problem.config, problem.state.size);
        let mut fit = problem.fit(kind, &deviation, gpu);
        let no_program = || failed(gpu, &DeviceError("it has no program for the stage".to_owned()));
        let job = fit.job().ok_or_else(no_program)?;
        let mut program = gpu.resident(&job).ok_or_else(no_program)?;
        drop(job);
        program.upload(&fit.variables()).map_err(|error| failed(gpu, &error))?;
        let (pixels, texture) = (problem.samples.len(), problem.state.size);
        Ok(Self { gpu, reach, program, kind, pixels, texture })
    }

    /// Losses before `count` more steps.
    pub fn steps(&mut self, count: usize) -> Result<Vec<f64>, BackendError> {
        let mut losses = vec![];
        while losses.len() < count {
            let rate_factors = vec![1.0; BATCH.min(count - losses.len())];
            losses.extend(
                self.program.steps(&rate_factors).map_err(|error| failed(self.gpu, &error))?,
            );
        }
        Ok(losses)
    }

    /// Seconds of a step, over `count` of them as a solve takes them.
    pub fn mean(&mut self, count: usize) -> Result<f64, BackendError> {
        let start = Instant::now();
        self.steps(count)?;
        Ok(start.elapsed().as_secs_f64() / count as f64)
    }

    /// Seconds of a step, the least of submissions that grow to a solve's.
    pub fn best(&mut self, budget: Duration) -> Result<f64, BackendError> {
        let (start, mut best, mut count) = (Instant::now(), f64::INFINITY, 1);
        loop {
            let seconds = self.mean(count)?;
            best = best.min(seconds);
            if start.elapsed() >= budget {
                return Ok(best);
            }
            if seconds * (count as f64) < budget.as_secs_f64() / 4.0 {
                count = BATCH.min(2 * count);
            }
        }
    }

    /// The row of a step that took so long; every pass is timed now.
    pub fn row(mut self, seconds: f64, losses: Vec<f64>) -> Result<GpuStep, BackendError> {
        let gpu = self.gpu;
        let (result, timings) = gpu.timed(|| self.steps(TIMED));
        result?;
        let Reach { flops, bytes } = self.reach;
        let each = TIMED as f64;
        let mut passes: Vec<PassRow> = timings
            .unwrap_or_default()
            .into_iter()
            .map(|(name, pass)| PassRow {
                name,
                dispatches: pass.dispatches as f64 / each,
                milliseconds: pass.milliseconds / each,
                floors: [1e3 * pass.flops / flops / each, 1e3 * pass.bytes / bytes / each],
            })
            .collect();
        passes.sort_by(|a, b| b.milliseconds.total_cmp(&a.milliseconds));
        let cost = least_work(self.kind, self.pixels, self.texture);
        Ok(GpuStep {
            kind: self.kind,
            pixels: self.pixels,
            texture: self.texture,
            milliseconds: 1e3 * seconds,
            floors: [1e3 * cost.operations / flops, 1e3 * cost.bytes / bytes],
            memory: gpu.memory(),
            passes,
            losses,
            loss_difference: None,
            torch: None,
        })
    }
}

/// A benchmark does not go on on the processor.
pub fn failed(gpu: &Gpu, error: &DeviceError) -> BackendError {
    BackendError::Refused { name: gpu.name(), reason: error.to_string() }
}
