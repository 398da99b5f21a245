//! The devices that take steps: the processor at one of its levels, a GPU, and PyTorch on either.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use solver::BackendError;
use solver::backend::Backend;
use solver::backend::cpu::{Cpu, Level};
use solver::backend::gpu::Gpu;
use solver::backend::resident::{BATCH, DeviceError, Resident};
use solver::memory::KeepFreedMemory;
use solver::model::deviation::Deviation;

use super::cost::Cost;
use super::error::BenchError;
use super::kind::Kind;
use super::machine::{Reach, best, peak_memory, reset_peak_memory};
use super::rows::{Floors, Kernel, Step};
use super::synthetic::Problem;
use super::torch::{self, TorchPlace};

/// Steps whose losses are compared.
pub const COMPARED: usize = 8;
/// Steps that every pass of a GPU is timed in.
const TIMED: usize = 4;

/// A device and the rates that it reaches.
pub struct Device {
    pub computer: Computer,
    pub reach: Reach,
}

pub enum Computer {
    Processor(Level),
    Gpu {
        gpu: Gpu,
        /// A processor plays it.
        software: bool,
    },
    Torch {
        python: PathBuf,
        place: TorchPlace,
    },
}

/// A step with its first losses, and the passes of a GPU.
pub struct Measured {
    pub step: Step,
    pub losses: Vec<f64>,
    pub passes: Vec<Kernel>,
}

/// Measurements of the same steps on any device.
struct Timed {
    /// The shortest of several measurements of a step.
    seconds: f64,
    losses: Vec<f64>,
    /// Bytes.
    memory: Option<u64>,
    passes: Vec<Kernel>,
}

impl Device {
    pub fn name(&self) -> String {
        match &self.computer {
            Computer::Processor(level) => match rayon::current_num_threads() {
                1 => format!("{}, 1 thread", Cpu::at(*level).name()),
                threads => format!("{}, {threads} threads", Cpu::at(*level).name()),
            },
            Computer::Gpu { gpu, software: false } => gpu.name(),
            Computer::Gpu { gpu, software: true } => format!("{}, a software adapter", gpu.name()),
            Computer::Torch { place, .. } => format!("PyTorch, {}", place.name()),
        }
    }

    pub fn is_torch(&self) -> bool {
        matches!(self.computer, Computer::Torch { .. })
    }

    pub fn is_cuda(&self) -> bool {
        matches!(self.computer, Computer::Torch { place: TorchPlace::Cuda, .. })
    }

    /// Measures one kind of step on `pixels` pixels and textures of side `texture`.
    pub fn measure(
        &self,
        kind: Kind,
        (pixels, texture): (usize, usize),
        budget: Duration,
    ) -> Result<Measured, BenchError> {
        // Dropped last, so that the next measurement begins with little memory.
        let _kept = KeepFreedMemory::begin();
        let reset = reset_peak_memory();
        let problem = Problem::new(pixels, texture);
        let mut device = self.name();
        let Timed { seconds, losses, memory, passes } = match &self.computer {
            Computer::Processor(level) => {
                let (seconds, losses) = on_processor(&Cpu::at(*level), kind, &problem, budget);
                Timed { seconds, losses, memory: reset.then(peak_memory).flatten(), passes: vec![] }
            }
            Computer::Gpu { gpu, .. } => {
                self.on_gpu(gpu, kind, &problem, budget).map_err(|error| gpu_error(gpu, &error))?
            }
            Computer::Torch { python, place } => {
                let found = torch::measure(python, *place, kind, &problem, COMPARED)?;
                device = format!("PyTorch {}, {}", found.version, place.name());
                Timed {
                    seconds: 1e-3 * found.milliseconds,
                    losses: found.losses,
                    memory: Some(found.peak_memory),
                    passes: vec![],
                }
            }
        };
        let cost = Cost::of(kind, pixels, texture);
        let step = Step {
            kind,
            device,
            pixels,
            texture,
            milliseconds: 1e3 * seconds,
            cost,
            floors: Floors::new(&cost, self.reach),
            memory,
            loss_difference: None,
        };
        Ok(Measured { step, losses, passes })
    }

    /// Takes steps on a GPU until the budget is spent; `memory` is the device's.
    fn on_gpu(
        &self,
        gpu: &Gpu,
        kind: Kind,
        problem: &Problem,
        budget: Duration,
    ) -> Result<Timed, DeviceError> {
        let deviation = Deviation::new(&problem.config, problem.state.size);
        let missing = || DeviceError("the device has no program for this stage".to_owned());
        let mut fit = problem.fit(kind, &deviation, gpu);
        let job = fit.job().ok_or_else(missing)?;
        let mut program = gpu.resident(&job).ok_or_else(missing)?;
        drop(job);
        program.upload(&fit.variables())?;
        let losses = take_steps(&mut *program, COMPARED)?;
        // Submissions grow to those of a solve.
        let (start, mut seconds, mut count) = (Instant::now(), f64::INFINITY, 1);
        loop {
            let begin = Instant::now();
            take_steps(&mut *program, count)?;
            let each = begin.elapsed().as_secs_f64() / count as f64;
            seconds = each.min(seconds);
            if start.elapsed() >= budget {
                break;
            }
            if each * (count as f64) < budget.as_secs_f64() / 4.0 {
                count = BATCH.min(2 * count);
            }
        }
        let (result, timings) = gpu.timed(|| take_steps(&mut *program, TIMED));
        result?;
        let step = format!(
            "{}, {} pixels, {}² texels",
            kind.name(),
            problem.samples.len(),
            problem.state.size
        );
        let pass = |(name, pass): (&'static str, solver::backend::gpu::PassTime)| {
            let (flops, bytes) = (pass.flops / TIMED as f64, pass.bytes / TIMED as f64);
            Kernel {
                device: self.name(),
                step: step.clone(),
                name,
                dispatches: pass.dispatches as f64 / TIMED as f64,
                milliseconds: pass.milliseconds / TIMED as f64,
                floors: Floors::new(&Cost { flops, operations: flops, bytes }, self.reach),
            }
        };
        let mut passes: Vec<Kernel> = timings.unwrap_or_default().into_iter().map(pass).collect();
        passes.sort_by(|a, b| b.milliseconds.total_cmp(&a.milliseconds));
        Ok(Timed { seconds, losses, memory: gpu.memory(), passes })
    }
}

/// Seconds of a step, and the first losses.
fn on_processor(cpu: &Cpu, kind: Kind, problem: &Problem, budget: Duration) -> (f64, Vec<f64>) {
    let deviation = Deviation::new(&problem.config, problem.state.size);
    let mut fit = problem.fit(kind, &deviation, cpu);
    let losses = (0..COMPARED).map(|_| fit.step(cpu, 1.0)).collect();
    let seconds = best(budget, 2, || {
        fit.step(cpu, 1.0);
    });
    (seconds, losses)
}

/// The losses before `count` more steps.
fn take_steps(program: &mut dyn Resident, count: usize) -> Result<Vec<f64>, DeviceError> {
    let mut losses = vec![];
    while losses.len() < count {
        losses.extend(program.steps(&vec![1.0; BATCH.min(count - losses.len())])?);
    }
    Ok(losses)
}

/// A benchmark does not continue on the processor.
pub fn gpu_error(gpu: &Gpu, error: &DeviceError) -> BackendError {
    BackendError::Refused { name: gpu.name(), reason: error.to_string() }
}
