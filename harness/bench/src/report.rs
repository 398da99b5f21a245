//! All that was measured.

use serde::Serialize;

use super::gpu::GpuReport;
use super::kernels::Kernel;
use super::kind::Kind;
use super::machine::Machine;
use super::solves::Solved;
use super::steps::{Reach, Step};
use super::torch::TorchStep;

/// All that was measured.
#[derive(Debug, Serialize)]
pub struct Report {
    /// On what.
    pub machine: Machine,
    /// Rates that it reaches, level by level.
    pub reach: Vec<(String, Reach)>,
    /// The paper's steps at every level.
    pub steps: Vec<Step>,
    /// The parts of the steps, at the best level.
    pub kernels: Vec<Kernel>,
    /// Warm-up steps over pixels, fine-tuning over textures, warm-up over threads; at the best level.
    pub scaling: Vec<Step>,
    /// The paper's capture on the processor.
    pub paper: PaperSize,
    /// Steps and solves on a GPU.
    pub gpu: Option<GpuReport>,
    /// The paper's steps in PyTorch.
    pub torch: Torch,
    /// Whole solves.
    pub solves: Vec<Solved>,
}

/// The paper's capture on the processor.
#[derive(Debug, Serialize)]
pub struct PaperSize {
    /// One of so many pixels was really there, more of them first.
    #[serde(rename = "shares")]
    pub divisors: [usize; 2],
    /// One step of each kind on either number of pixels.
    pub steps: Vec<[Step; 2]>,
    /// Seconds of all 3000 steps on all pixels, on the line through the measured ones.
    pub seconds: f64,
}

/// PyTorch's rows.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum Torch {
    /// None, and how to get them.
    Absent {
        /// The command to type.
        fix: String,
    },
    /// Rows of each kind and size.
    Measured(Vec<TorchRow>),
}

/// PyTorch beside ours.
#[derive(Debug, Serialize)]
pub struct TorchRow {
    /// The kind of step.
    pub kind: Kind,
    /// Pixels of all views.
    pub pixels: usize,
    /// Side of the textures.
    pub texture: usize,
    /// There.
    pub torch: TorchStep,
    /// Here, level by level.
    pub ours: Vec<Step>,
    /// Largest relative difference of the losses of the first steps.
    pub loss_difference: f64,
}
