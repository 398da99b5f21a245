//! `unshade bench`: what the solver's arithmetic takes, against what the machine reaches in the same
//! run.
//!
//! Everything runs through [`solver::backend::Backend`] and the stages of a solve.

mod cells;
mod clock;
mod cost;
mod error;
mod gpu;
mod kernels;
mod kind;
mod machine;
mod markdown;
mod paper;
mod report;
mod solves;
mod steps;
mod synthetic;
mod torch;

use std::path::PathBuf;
use std::time::Duration;

use rayon::ThreadPoolBuilder;
use solver::backend::cpu::{Cpu, Level};
use solver::backend::gpu::Adapter;
use solver::backend::{Backend, BackendError};
use solver::model::deviation::Deviation;

pub use error::BenchError;
pub use gpu::GpuReport;
pub use kernels::Kernel;
pub use kind::Kind;
pub use machine::Machine;
pub use markdown::markdown;
pub use report::{PaperSize, Report, Torch, TorchRow};
pub use solves::Solved;
pub use steps::{Reach, Step};
pub use torch::{FIX, TorchDevice, TorchError, TorchStep};

use paper::{COARSE, PAPER_DIVISORS, PAPER_STEPS, Paper};
use synthetic::Problem;
use torch::TORCH_STEPS;

/// Pixels of the steps that stand for a capture of the demo's kind, half resolution.
const SMALL: usize = 300_000;
const LARGE: usize = 3_000_000;
const FINE: usize = 1024;
/// Bytes of each array of the bandwidth measurement: far more than any cache.
const ARRAY: usize = 128 << 20;

/// Choice of measurements.
pub struct Options {
    /// One of every kind of row, as small as it goes: does the command work?
    pub quick: bool,
    /// A GPU too, if there is one; the processor is measured at each of its levels.
    pub gpu: bool,
    /// A Python that has PyTorch.
    pub torch: Option<PathBuf>,
    /// Captures to be solved as a whole.
    pub captures: Vec<PathBuf>,
}

/// Measures everything; `progress` hears what comes next.
pub fn run(options: &Options, progress: &mut dyn FnMut(&str)) -> Result<Report, BenchError> {
    let bench = Bench { quick: options.quick };
    // Before there is a load of our own.
    let machine = Machine::here();
    // First, so that what the process keeps of other measurements does not count as theirs.
    let mut solves = vec![];
    for capture in &options.captures {
        progress(&format!("solving {}", capture.display()));
        solves.extend(solves::measure(capture, &Cpu::new())?);
    }
    progress("bandwidth");
    let bandwidth = machine::bandwidth(if bench.quick { 1 << 20 } else { ARRAY }, bench.budget());
    let mut devices: Vec<(Cpu, Reach)> = vec![];
    for level in Level::available() {
        progress(&format!("multiply-adds, {level}"));
        let flops = machine::peak(level, bench.budget());
        devices.push((Cpu::at(level), Reach { flops, bytes: bandwidth }));
    }
    let reach = devices.iter().map(|(device, reach)| (device.name(), *reach)).collect();
    let mut steps = vec![];
    for (kind, size) in bench.sizes() {
        for (device, reach) in &devices {
            progress(&format!("{}, {} pixels, {}", kind.name(), size.0, device.name()));
            steps.push(steps::measure(kind, device, *reach, size, bench.budget()));
        }
    }
    // Levels come in rising order, and there is always the portable one.
    let Some((device, reach_of_best)) = devices.last() else { unreachable!("no level at all") };
    progress("kernels");
    let kernels = kernels::measure(device, &bench.kernel_size());
    let scaling = bench.scaling(device, *reach_of_best, progress);
    let paper = bench.paper_size(device, *reach_of_best, progress);
    // Not looked for before: its driver takes memory, which would count as that of the steps.
    let adapter = if options.gpu { adapter()? } else { None };
    let gpu = adapter.map(|adapter| bench.gpu(&adapter, device, options, progress)).transpose()?;
    let torch = match &options.torch {
        None => Torch::Absent { fix: FIX.to_owned() },
        Some(python) => {
            let mut rows = vec![];
            // Large fine-tuning steps take PyTorch many seconds each and say nothing new.
            let worth =
                |(kind, size): &(Kind, (usize, usize))| *kind == Kind::WarmUp || size.0 < LARGE;
            for (kind, size) in bench.sizes().into_iter().filter(worth) {
                progress(&format!("{}, {} pixels, PyTorch", kind.name(), size.0));
                rows.push(torch_row(python, kind, size, device, &steps)?);
            }
            Torch::Measured(rows)
        }
    };
    Ok(Report { machine, reach, steps, kernels, scaling, paper, gpu, torch, solves })
}

/// The best real GPU, or the adapter that the user names.
fn adapter() -> Result<Option<Adapter>, BackendError> {
    match Adapter::chosen() {
        Ok(adapter) => Ok(Some(adapter)),
        Err(BackendError::NoGpu { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

struct Bench {
    quick: bool,
}

impl Bench {
    fn budget(&self) -> Duration {
        Duration::from_millis(if self.quick { 1 } else { 1500 })
    }

    fn sizes(&self) -> Vec<(Kind, (usize, usize))> {
        if self.quick {
            return Kind::ALL.map(|kind| (kind, (5000, 32))).to_vec();
        }
        let warm_up = [SMALL, LARGE].map(|pixels| (Kind::WarmUp, (pixels, COARSE)));
        let fine = [Kind::Normals, Kind::Diffuse].into_iter();
        let fine = fine.flat_map(|kind| [SMALL, LARGE].map(|pixels| (kind, (pixels, FINE))));
        warm_up.into_iter().chain(fine).collect()
    }

    fn kernel_size(&self) -> kernels::Size {
        let budget = self.budget() / 3;
        match self.quick {
            true => kernels::Size { pixels: 5000, texture: 32, transport: 16, budget },
            false => kernels::Size { pixels: SMALL, texture: FINE, transport: 128, budget },
        }
    }

    fn scaling(&self, device: &Cpu, reach: Reach, progress: &mut dyn FnMut(&str)) -> Vec<Step> {
        let (pixels, textures): (&[usize], &[usize]) = match self.quick {
            true => (&[1000, 4000], &[16, 32]),
            false => (&[10_000, 100_000, 1_000_000, 10_000_000], &[128, 256, 512, 1024, 2048]),
        };
        let over_pixels = pixels.iter().map(|pixels| (Kind::WarmUp, (*pixels, COARSE)));
        let over_textures = [Kind::Normals, Kind::Diffuse].into_iter().flat_map(|kind| {
            textures
                .iter()
                .map(move |texture| (kind, (SMALL.min(100 * texture * texture), *texture)))
        });
        let mut rows = vec![];
        for (kind, size) in over_pixels.chain(over_textures) {
            progress(&format!("{}, {} pixels, {}² textures", kind.name(), size.0, size.1));
            rows.push(steps::measure(kind, device, reach, size, self.budget()));
        }
        let all = rayon::current_num_threads();
        let size = (if self.quick { 4000 } else { SMALL }, COARSE);
        for threads in (0..).map(|power| 1 << power).take_while(|threads| *threads < all) {
            progress(&format!("warm-up, {threads} threads"));
            // A machine that cannot start a thread has no row for it.
            let Ok(pool) = ThreadPoolBuilder::new().num_threads(threads).build() else { continue };
            let fraction = threads as f64 / all as f64;
            let reach = Reach { flops: fraction * reach.flops, ..reach };
            let budget = self.budget();
            rows.push(pool.install(|| steps::measure(Kind::WarmUp, device, reach, size, budget)));
        }
        rows
    }

    fn paper(&self) -> Paper {
        Paper {
            quick: self.quick,
            divisors: if self.quick { [10_000, 40_000] } else { PAPER_DIVISORS },
        }
    }

    fn paper_size(&self, device: &Cpu, reach: Reach, progress: &mut dyn FnMut(&str)) -> PaperSize {
        let paper = self.paper();
        let steps = Kind::ALL.map(|kind| {
            paper.divisors.map(|divisor| {
                let size = paper.size(kind, divisor);
                let (pixels, name) = (size.0, kind.name());
                progress(&format!(
                    "the paper's capture, {name}, {pixels} pixels, {}",
                    device.name()
                ));
                steps::measure(kind, device, reach, size, self.budget())
            })
        });
        let seconds = steps.iter().zip(PAPER_STEPS).map(|([more, less], steps)| {
            let times = [more, less].map(|step| (step.pixels, step.milliseconds));
            1e-3 * steps as f64 * on_a_line(times, paper.size(more.kind, 1).0)
        });
        PaperSize { divisors: paper.divisors, seconds: seconds.sum(), steps: steps.to_vec() }
    }

    /// Steps, whole solves and the paper's capture on a GPU; `cpu` says what the losses should be.
    fn gpu(
        &self,
        adapter: &Adapter,
        cpu: &dyn Backend,
        options: &Options,
        progress: &mut dyn FnMut(&str),
    ) -> Result<GpuReport, BenchError> {
        progress(&format!("what {} reaches", adapter.name));
        let bytes = if self.quick { 1 << 20 } else { ARRAY };
        let device = gpu::Device::open(adapter, bytes, self.budget())?;
        let mut steps = vec![];
        for (kind, (pixels, texture)) in self.sizes() {
            progress(&format!("{}, {pixels} pixels, {}", kind.name(), device.name()));
            let problem = Problem::new(pixels, texture);
            let mut step = device.step(kind, &problem, &losses(kind, &problem, cpu))?;
            if let Some(python) = options.torch.as_ref().filter(|_| !device.software) {
                // Not every GPU has CUDA, nor every PyTorch.
                match torch::measure(python, TorchDevice::Cuda, kind, &problem, TORCH_STEPS) {
                    Ok(there) => step.torch = Some(there),
                    Err(error) => progress(&format!("no row for PyTorch on the GPU: {error}")),
                }
            }
            steps.push(step);
        }
        let mut solves = vec![];
        for capture in &options.captures {
            progress(&format!("solving {}, {}", capture.display(), device.name()));
            solves.extend(device.solves(capture)?);
        }
        let paper = device.paper(&self.paper(), progress);
        Ok(device.report(steps, solves, paper))
    }
}

/// The time on so many pixels, from two times on fewer.
fn on_a_line([(more, later), (less, sooner)]: [(usize, f64); 2], pixels: usize) -> f64 {
    let slope = (later - sooner) / (more as f64 - less as f64);
    later + slope * (pixels as f64 - more as f64)
}

fn torch_row(
    python: &std::path::Path,
    kind: Kind,
    (pixels, texture): (usize, usize),
    device: &dyn Backend,
    steps: &[Step],
) -> Result<TorchRow, TorchError> {
    let problem = Problem::new(pixels, texture);
    let torch = torch::measure(python, TorchDevice::Cpu, kind, &problem, TORCH_STEPS)?;
    let ours = losses(kind, &problem, device);
    let difference = ours.iter().zip(&torch.losses).map(|(a, b)| (a / b - 1.0).abs());
    let same = |step: &&Step| (step.kind, step.pixels, step.texture) == (kind, pixels, texture);
    Ok(TorchRow {
        kind,
        pixels,
        texture,
        loss_difference: difference.fold(0.0, f64::max),
        torch,
        ours: steps.iter().filter(same).cloned().collect(),
    })
}

/// The losses before the first steps.
fn losses(kind: Kind, problem: &Problem, device: &dyn Backend) -> Vec<f64> {
    let deviation = Deviation::new(&problem.config, problem.state.size);
    let mut fit = problem.fit(kind, &deviation, device);
    (0..TORCH_STEPS).map(|_| fit.step(device, 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every row is there and finite; nothing is said about its time.
    #[test]
    fn the_smallest_run_has_every_row_and_a_table() {
        let options = Options { quick: true, gpu: false, torch: None, captures: vec![] };
        let mut heard = 0;
        let report = run(&options, &mut |_| heard += 1).unwrap();
        let levels = Level::available().len();
        assert_eq!(report.reach.len(), levels);
        assert_eq!(report.steps.len(), 3 * levels);
        assert!(report.steps.iter().all(|step| step.milliseconds > 0.0));
        assert!(report.kernels.len() > 10 && heard > report.steps.len());
        let text = markdown(&report, "unshade bench");
        assert!(text.contains("pip install torch"), "{text}");
        assert_eq!(text.matches("ot yet measured").count(), 3, "{text}");
        let value = serde_json::to_value(&report).unwrap();
        assert_eq!(value["steps"][0]["kind"], "warm-up");
    }

    /// Where there is no adapter, the run above has said that nothing was measured.
    #[test]
    fn an_adapter_has_its_steps_its_passes_and_the_processors_losses() {
        let mut adapters = solver::backend::gpu::adapters();
        let software = adapters.iter().position(|adapter| adapter.software).unwrap_or(0);
        if adapters.is_empty() {
            eprintln!("skipped: no adapter");
            return;
        }
        let adapter = adapters.swap_remove(software);
        let bench = Bench { quick: true };
        let options = Options { quick: true, gpu: true, torch: None, captures: vec![] };
        let report = bench.gpu(&adapter, &Cpu::new(), &options, &mut |_| {}).unwrap();
        assert_eq!(report.software, adapter.software);
        assert_eq!(report.steps.len(), 3);
        for step in &report.steps {
            assert!(step.milliseconds > 0.0 && step.floors.iter().all(|floor| *floor > 0.0));
            assert!(step.loss_difference.unwrap() < 1e-4, "{:?}", step.loss_difference);
            assert_eq!(step.passes.is_empty(), !adapter.has_clock());
        }
        let gpu::GpuPaper::Done { steps, seconds, .. } = &report.paper else {
            panic!("{:?}", report.paper)
        };
        assert!(steps.len() == 3 && *seconds > 0.0);
    }

    #[test]
    fn what_a_step_takes_without_pixels_is_counted_once() {
        let time = |pixels: usize| 7.0 + 0.25 * pixels as f64;
        let times = [120, 30].map(|pixels| (pixels, time(pixels)));
        assert_eq!(on_a_line(times, 1920), time(1920));
    }

    #[test]
    fn a_python_without_torch_is_named_with_the_fix() {
        let problem = Problem::new(100, 8);
        let python = std::path::Path::new("/nowhere/python");
        let error = torch::measure(python, TorchDevice::Cpu, Kind::WarmUp, &problem, 1)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("/nowhere/python") && error.contains("pip install torch"),
            "{error}"
        );
    }
}
