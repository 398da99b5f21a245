//! `unshade bench`: times of the solver's kernels and steps against the rates that the machine reaches in the
//! same run.
//!
//! Everything runs through [`solver::backend::Backend`] and the stages of a solve.

mod cost;
mod device;
mod error;
mod kernels;
mod kind;
mod machine;
mod page;
mod rows;
mod solves;
mod synthetic;
#[cfg(test)]
mod tests;
mod torch;

use std::path::PathBuf;
use std::time::Duration;

use solver::BackendError;
use solver::backend::Backend;
use solver::backend::cpu::{Cpu, Level};
use solver::backend::gpu::{Adapter, Gpu};
use solver::memory::available;

pub use cost::Cost;
pub use error::BenchError;
pub use kind::Kind;
pub use machine::{Machine, Reach};
pub use page::markdown;
pub use rows::{Floors, Kernel, PaperCapture, Report, Solve, Step};
pub use torch::TorchError;

use device::{Computer, Device, Measured, gpu_error};
use torch::TorchPlace;

/// Pixels of the steps that stand for a capture of the demo's kind, half resolution.
const SMALL: usize = 300_000;
const LARGE: usize = 3_000_000;
/// Sides of the textures of warm-up and fine-tuning.
const COARSE: usize = 128;
const FINE: usize = 1024;
/// Bytes of each array of the bandwidth measurement: far more than any cache.
const ARRAY: usize = 128 << 20;
/// The paper's capture: ten views of 12 million pixels in half resolution, 48 million in full, textures of
/// 2048²; steps of each kind.
const PAPER_PIXELS: [usize; 2] = [12_000_000, 48_000_000];
const PAPER_TEXTURE: usize = 2048;
const PAPER_STEPS: [usize; 3] = [2000, 500, 500];
/// Memory of the host that all pixels of the paper's capture take, about.
const PAPER_MEMORY: u64 = 20 << 30;

/// Choice of measurements.
pub struct Options {
    /// One row of every kind on the smallest size; the times are meaningless.
    pub quick: bool,
    /// Measures a GPU too, if there is one; the processor is measured at each of its levels.
    pub gpu: bool,
    /// A Python that has PyTorch.
    pub torch: Option<PathBuf>,
    /// Captures to be solved as a whole.
    pub captures: Vec<PathBuf>,
}

/// Measures everything; `progress` gets the name of each measurement before it begins.
pub fn run(options: &Options, progress: &mut dyn FnMut(&str)) -> Result<Report, BenchError> {
    let adapter = || if options.gpu { adapter() } else { Ok(None) };
    Bench { options, progress }.run(adapter)
}

/// The best real GPU, or the adapter that the user names.
fn adapter() -> Result<Option<Adapter>, BackendError> {
    match Adapter::chosen() {
        Ok(adapter) => Ok(Some(adapter)),
        Err(BackendError::NoGpu { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

struct Bench<'a> {
    options: &'a Options,
    progress: &'a mut dyn FnMut(&str),
}

impl Bench<'_> {
    fn run(
        &mut self,
        adapter: impl FnOnce() -> Result<Option<Adapter>, BackendError>,
    ) -> Result<Report, BenchError> {
        // Before this run adds to the load.
        let machine = Machine::here();
        // Before other measurements fill the memory of the process.
        let solves = self.solves(&Cpu::new())?;
        let processors = self.processors();
        // Levels come in rising order, and there is always the portable one.
        let (Some(best), Some(level)) = (processors.last(), Level::available().pop()) else {
            unreachable!("no level at all")
        };
        let mut report = Report {
            machine,
            reach: processors.iter().map(|device| (device.name(), device.reach)).collect(),
            steps: vec![],
            kernels: vec![],
            paper: vec![],
            solves,
        };
        let sizes = self.sizes();
        let mut losses = vec![vec![]; sizes.len()];
        for (size, losses) in sizes.iter().zip(&mut losses) {
            for device in &processors {
                let found = self.step(device, *size)?;
                *losses = found.losses;
                report.steps.push(found.step);
            }
        }
        (self.progress)("kernels");
        report.kernels = kernels::measure(&Cpu::at(level), best.reach, &self.kernel_size());
        report.paper.push(self.paper(best, [16, 64]));
        let mut others = vec![];
        // Opened late: the driver's memory would count as that of the processor's steps.
        if let Some(adapter) = adapter()? {
            others.push(self.gpu(&adapter)?);
        }
        others.extend(self.torch(best, others.first()));
        for device in &others {
            for ((kind, size), losses) in sizes.iter().zip(&losses) {
                if device.is_torch() && *kind != Kind::WarmUp && size.0 >= LARGE {
                    // Such steps take PyTorch many seconds each, and the smaller ones give the same ratio.
                    continue;
                }
                let found = match self.step(device, (*kind, *size)) {
                    // Not every GPU has CUDA, nor every PyTorch.
                    Err(error) if device.is_cuda() => {
                        (self.progress)(&format!("PyTorch does not run on the GPU: {error}"));
                        break;
                    }
                    found => found?,
                };
                let difference = losses.iter().zip(&found.losses).map(|(a, b)| (a / b - 1.0).abs());
                let loss_difference = Some(difference.fold(0.0, f64::max));
                report.steps.push(Step { loss_difference, ..found.step });
                report.kernels.extend(found.passes);
            }
            if let Computer::Gpu { gpu, software } = &device.computer {
                report.reach.push((device.name(), device.reach));
                report.solves.extend(self.solves(gpu)?);
                let divisors = match software {
                    true => [256, 1024],
                    false if available().is_some_and(|bytes| bytes < PAPER_MEMORY) => [4, 16],
                    false => [1, 4],
                };
                report.paper.push(self.paper(device, divisors));
            }
        }
        Ok(report)
    }

    fn budget(&self) -> Duration {
        Duration::from_millis(if self.options.quick { 1 } else { 1500 })
    }

    fn array(&self) -> usize {
        if self.options.quick { 1 << 20 } else { ARRAY }
    }

    fn solves(&mut self, backend: &dyn Backend) -> Result<Vec<Solve>, BenchError> {
        let mut solves = vec![];
        for capture in &self.options.captures {
            (self.progress)(&format!("solving {}, {}", capture.display(), backend.name()));
            solves.extend(solves::measure(capture, backend)?);
        }
        Ok(solves)
    }

    /// The processor at each of its levels.
    fn processors(&mut self) -> Vec<Device> {
        (self.progress)("bandwidth");
        let bytes = machine::bandwidth(self.array(), self.budget());
        let mut devices = vec![];
        for level in Level::available() {
            (self.progress)(&format!("multiply-adds, {level}"));
            let reach = Reach { flops: machine::peak(level, self.budget()), bytes };
            devices.push(Device { computer: Computer::Processor(level), reach });
        }
        devices
    }

    fn gpu(&mut self, adapter: &Adapter) -> Result<Device, BenchError> {
        (self.progress)(&format!("multiply-adds and bandwidth, {}", adapter.name));
        let gpu = Gpu::open(adapter)?;
        let found = gpu.ceilings(self.array(), self.budget());
        let found = found.map_err(|error| gpu_error(&gpu, &error))?;
        let reach = Reach { flops: found.flops, bytes: found.bytes };
        Ok(Device { computer: Computer::Gpu { gpu, software: adapter.software }, reach })
    }

    /// PyTorch on the processor, and on a real GPU.
    fn torch(&self, processor: &Device, gpu: Option<&Device>) -> Vec<Device> {
        let Some(python) = &self.options.torch else { return vec![] };
        let on = |place, reach| Device {
            computer: Computer::Torch { python: python.clone(), place },
            reach,
        };
        let mut devices = vec![on(TorchPlace::Cpu, processor.reach)];
        let real = |gpu: &&Device| matches!(gpu.computer, Computer::Gpu { software: false, .. });
        devices.extend(gpu.filter(real).map(|gpu| on(TorchPlace::Cuda, gpu.reach)));
        devices
    }

    fn step(
        &mut self,
        device: &Device,
        (kind, size): (Kind, (usize, usize)),
    ) -> Result<Measured, BenchError> {
        let (pixels, side) = size;
        let name = device.name();
        (self.progress)(&format!("{}, {pixels} pixels, {side}² textures, {name}", kind.name()));
        device.measure(kind, size, self.budget())
    }

    fn sizes(&self) -> Vec<(Kind, (usize, usize))> {
        if self.options.quick {
            return Kind::ALL.map(|kind| (kind, (5000, 32))).to_vec();
        }
        let sides = [(Kind::WarmUp, COARSE), (Kind::Normals, FINE), (Kind::Diffuse, FINE)];
        let of = |(kind, side)| [SMALL, LARGE].map(|pixels| (kind, (pixels, side)));
        sides.into_iter().flat_map(of).collect()
    }

    fn kernel_size(&self) -> kernels::Size {
        let budget = self.budget() / 3;
        match self.options.quick {
            true => kernels::Size { pixels: 5000, texture: 32, transport: 16, budget },
            false => kernels::Size { pixels: SMALL, texture: FINE, transport: 128, budget },
        }
    }

    /// The paper's capture on one pixel of `divisors`, more of them first. A step's time is linear in its pixels,
    /// but for its textures.
    fn paper(&mut self, device: &Device, divisors: [usize; 2]) -> PaperCapture {
        let divisors = if self.options.quick { [10_000, 40_000] } else { divisors };
        let mut steps = vec![];
        let seconds = self.paper_seconds(device, divisors, &mut steps);
        let (seconds, failure) = match seconds {
            Ok(seconds) => (Some(seconds), None),
            Err(error) => (None, Some(error.to_string())),
        };
        PaperCapture { device: device.name(), divisors, steps, seconds, failure }
    }

    fn paper_seconds(
        &mut self,
        device: &Device,
        divisors: [usize; 2],
        steps: &mut Vec<Step>,
    ) -> Result<f64, BenchError> {
        let texture = if self.options.quick { 32 } else { PAPER_TEXTURE };
        let mut seconds = 0.0;
        for (kind, count) in Kind::ALL.into_iter().zip(PAPER_STEPS) {
            let [half, full] = PAPER_PIXELS;
            let (pixels, side) =
                if kind == Kind::WarmUp { (half, COARSE) } else { (full, texture) };
            let mut times = vec![];
            for divisor in divisors {
                let step = self.step(device, (kind, (pixels / divisor, side)))?.step;
                times.push((step.pixels, step.milliseconds));
                steps.push(step);
            }
            seconds += 1e-3 * count as f64 * on_a_line([times[0], times[1]], pixels);
        }
        Ok(seconds)
    }
}

/// The time on so many pixels, from two times on fewer.
fn on_a_line([(more, later), (less, sooner)]: [(usize, f64); 2], pixels: usize) -> f64 {
    let slope = (later - sooner) / (more as f64 - less as f64);
    later + slope * (pixels as f64 - more as f64)
}
