//! Steps on a GPU: whole steps, their passes by the device's own clock, and the losses beside the
//! processor's; then whole solves, and the paper's capture in full.

mod page;
mod rows;
mod running;

use std::path::Path;
use std::time::{Duration, Instant};

use solver::BackendError;
use solver::backend::Backend;
use solver::backend::gpu::{Adapter, Gpu};
use solver::memory::available;

use self::running::{Running, failed};
use super::error::BenchError;
use super::kind::Kind;
use super::paper::{PAPER_STEPS, Paper};
use super::solves::{self, Solved};
use super::steps::Reach;
use super::synthetic::Problem;
use super::torch::TORCH_STEPS;
pub use page::{write_gpu, write_reach};
pub use rows::{GpuPaper, GpuReport, GpuStep};

/// Memory of the host that the whole of the paper's capture takes, about; with less, a quarter is done.
const PAPER_MEMORY: u64 = 20 << 30;
/// A software adapter does one of so many of the paper's pixels.
const SOFTWARE_DIVISOR: usize = 256;

/// A GPU that is measured.
pub struct Device {
    gpu: Gpu,
    /// A processor plays it.
    pub software: bool,
    reach: Reach,
    budget: Duration,
}

impl Device {
    /// Opens the adapter and measures what it reaches, on arrays of `bytes`.
    pub fn open(adapter: &Adapter, bytes: usize, budget: Duration) -> Result<Self, BackendError> {
        let gpu = Gpu::open(adapter)?;
        let found = gpu.ceilings(bytes, budget).map_err(|error| failed(&gpu, &error))?;
        let reach = Reach { flops: found.flops, bytes: found.bytes };
        Ok(Self { gpu, software: adapter.software, reach, budget })
    }

    /// In words.
    pub fn name(&self) -> String {
        self.gpu.name()
    }

    fn running(&self, kind: Kind, problem: &Problem) -> Result<Running<'_>, BackendError> {
        Running::new(&self.gpu, self.reach, kind, problem)
    }

    /// A step of a kind; `reference` are the processor's losses.
    pub fn step(
        &self,
        kind: Kind,
        problem: &Problem,
        reference: &[f64],
    ) -> Result<GpuStep, BackendError> {
        let mut running = self.running(kind, problem)?;
        let losses = running.steps(reference.len())?;
        let differences = losses.iter().zip(reference).map(|(a, b)| (a / b - 1.0).abs());
        let loss_difference = Some(differences.fold(0.0, f64::max));
        let seconds = running.best(self.budget)?;
        Ok(GpuStep { loss_difference, ..running.row(seconds, losses)? })
    }

    /// The paper's capture: on a GPU all steps on all pixels, if the host can hold them.
    pub fn paper(&self, paper: &Paper, progress: &mut dyn FnMut(&str)) -> GpuPaper {
        let divisor = match (paper.quick, self.software) {
            (true, _) => paper.divisors[0],
            (_, true) => SOFTWARE_DIVISOR,
            _ if available().is_some_and(|bytes| bytes < PAPER_MEMORY) => 4,
            _ => 1,
        };
        match self.paper_at(divisor, paper, progress) {
            Ok(done) => done,
            Err(error) => GpuPaper::Failed { reason: error.to_string() },
        }
    }

    fn paper_at(
        &self,
        divisor: usize,
        paper: &Paper,
        progress: &mut dyn FnMut(&str),
    ) -> Result<GpuPaper, BackendError> {
        let (mut rows, mut seconds, mut preparation_seconds) = (vec![], 0.0, 0.0);
        let mut problem: Option<Problem> = None;
        for (kind, steps) in Kind::ALL.into_iter().zip(PAPER_STEPS) {
            progress(&format!("the paper's capture, {}, {}", kind.name(), self.name()));
            let (pixels, texture) = paper.size(kind, divisor);
            // Full resolution is made once for both kinds.
            let same = |problem: &Problem| problem.samples.len() == pixels;
            let made = problem.take().filter(same).unwrap_or_else(|| Problem::new(pixels, texture));
            let start = Instant::now();
            let mut running = self.running(kind, &made)?;
            problem = Some(made);
            let losses = running.steps(TORCH_STEPS)?;
            preparation_seconds += start.elapsed().as_secs_f64();
            let each =
                if divisor == 1 { running.mean(steps)? } else { running.best(self.budget)? };
            seconds += each * (steps * divisor) as f64;
            rows.push(running.row(each, losses)?);
        }
        Ok(GpuPaper::Done { divisor, steps: rows, seconds, preparation_seconds })
    }

    /// Whole solves of a capture.
    pub fn solves(&self, capture: &Path) -> Result<[Solved; 2], BenchError> {
        solves::measure(capture, &self.gpu)
    }

    /// All that was found.
    pub fn report(self, steps: Vec<GpuStep>, solves: Vec<Solved>, paper: GpuPaper) -> GpuReport {
        let (mut name, software, reach) = (self.name(), self.software, self.reach);
        if software {
            name += ", a software adapter";
        }
        GpuReport { name, software, reach, steps, solves, paper }
    }
}
