//! The rows of the page and of the JSON file.

use serde::Serialize;

use super::cost::Cost;
use super::kind::Kind;
use super::machine::{Machine, Reach};

/// All measurements of a run.
#[derive(Debug, Serialize)]
pub struct Report {
    /// The machine.
    pub machine: Machine,
    /// The rates that each device reaches.
    pub reach: Vec<(String, Reach)>,
    /// The paper's steps on every device.
    pub steps: Vec<Step>,
    /// The kernels of the steps: on the processor at its best level, on a GPU by its own clock.
    pub kernels: Vec<Kernel>,
    /// The paper's capture on the best level of the processor, and on a GPU.
    pub paper: Vec<PaperCapture>,
    /// Whole solves.
    pub solves: Vec<Solve>,
}

/// A measured step.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    /// The kind of step.
    pub kind: Kind,
    /// The device, or PyTorch on it.
    pub device: String,
    /// Pixels of all views.
    pub pixels: usize,
    /// Side of the textures.
    pub texture: usize,
    /// Milliseconds of a step, the shortest of several.
    pub milliseconds: f64,
    /// The least work of a step.
    pub cost: Cost,
    /// The least time of that work.
    pub floors: Floors,
    /// Bytes: the largest resident set of the process, or what the device's driver counts.
    pub memory: Option<u64>,
    /// Largest relative difference of the first losses to those of the processor's best level.
    pub loss_difference: Option<f64>,
}

/// A measured kernel, or all dispatches of one name in a step on a GPU.
#[derive(Clone, Debug, Serialize)]
pub struct Kernel {
    /// The device.
    pub device: String,
    /// The step that it was timed in; empty for a kernel that was timed alone.
    pub step: String,
    /// The kernel's name.
    pub name: &'static str,
    /// Dispatches in a step.
    pub dispatches: f64,
    /// Milliseconds of all dispatches.
    pub milliseconds: f64,
    /// The least time of the kernel's work.
    pub floors: Floors,
}

/// The milliseconds that each part of some work would take alone, at the rates that the device reaches.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Floors {
    /// Products of networks and blurs.
    pub products: f64,
    /// All arithmetic.
    pub arithmetic: f64,
    /// Every value read once and written once.
    pub memory: f64,
}

impl Floors {
    pub(crate) fn new(cost: &Cost, reach: Reach) -> Self {
        Self {
            products: 1e3 * cost.flops / reach.flops,
            arithmetic: 1e3 * cost.operations / reach.flops,
            memory: 1e3 * cost.bytes / reach.bytes,
        }
    }

    /// The larger of the floors.
    pub fn largest(&self) -> f64 {
        self.arithmetic.max(self.memory)
    }
}

/// The paper's capture on a device.
#[derive(Debug, Serialize)]
pub struct PaperCapture {
    /// The device.
    pub device: String,
    /// The measured steps take one pixel of so many.
    pub divisors: [usize; 2],
    /// The steps of each kind at both sizes.
    pub steps: Vec<Step>,
    /// Seconds of all 3000 steps on all pixels, on the line through the measured times.
    pub seconds: Option<f64>,
    /// The error of a device that could not take the steps.
    pub failure: Option<String>,
}

/// A whole solve.
#[derive(Debug, Serialize)]
pub struct Solve {
    /// The capture's name.
    pub capture: String,
    /// The configuration's name.
    pub config: &'static str,
    /// The device.
    pub device: String,
    /// Foreground pixels of the training views.
    pub pixels: usize,
    /// Side of the fine-tuned textures.
    pub texture: usize,
    /// From the files of the capture to the files of the maps.
    pub seconds: f64,
    /// Seconds of each stage.
    pub stages: Vec<(String, f64)>,
    /// Largest resident set of the process, bytes.
    pub peak_memory: Option<u64>,
    /// Bytes that the solver estimated beforehand.
    pub estimated_memory: u64,
}
