//! Measurements on a GPU.

use serde::Serialize;

use crate::kind::Kind;
use crate::solves::Solved;
use crate::steps::Reach;
use crate::torch::TorchStep;

/// A GPU's rows.
#[derive(Debug, Serialize)]
pub struct GpuReport {
    /// Device, interface and driver.
    pub name: String,
    /// A processor that plays a GPU: its times say nothing about GPUs.
    pub software: bool,
    /// Rates that compute kernels reach.
    pub reach: Reach,
    /// The paper's steps.
    pub steps: Vec<GpuStep>,
    /// Whole solves.
    pub solves: Vec<Solved>,
    /// The paper's capture.
    pub paper: GpuPaper,
}

/// A step.
#[derive(Debug, Serialize)]
pub struct GpuStep {
    /// The kind of step.
    pub kind: Kind,
    /// Pixels of all views.
    pub pixels: usize,
    /// Side of the textures.
    pub texture: usize,
    /// Milliseconds of a step: the least of several submissions, or the mean of all steps of the paper.
    pub milliseconds: f64,
    /// Milliseconds that the step's operations alone would take, and its bytes.
    pub floors: [f64; 2],
    /// Bytes on the device, where the driver counts them.
    pub memory: Option<u64>,
    /// Its passes, the longest first; none without a clock.
    pub passes: Vec<PassRow>,
    /// The losses before the first steps.
    pub losses: Vec<f64>,
    /// Their largest relative difference to the processor's, where those were taken too.
    pub loss_difference: Option<f64>,
    /// The same in PyTorch on the same GPU, where that was asked for.
    pub torch: Option<TorchStep>,
}

/// All dispatches of one name within a step.
#[derive(Debug, Serialize)]
pub struct PassRow {
    /// Name of the dispatches' kernel.
    pub name: &'static str,
    /// In a step.
    pub dispatches: f64,
    /// In a step, by the device's clock.
    pub milliseconds: f64,
    /// Milliseconds that the operations alone would take, and the bytes.
    pub floors: [f64; 2],
}

/// The paper's capture on a GPU.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum GpuPaper {
    /// It went through.
    Done {
        /// One of so many pixels was really there; with all of them, all steps were taken.
        #[serde(rename = "share")]
        divisor: usize,
        /// One of each kind.
        steps: Vec<GpuStep>,
        /// Seconds of all 3000 steps on all pixels.
        seconds: f64,
        /// Before them: what stays fixed is evaluated and uploaded, kernels are compiled.
        preparation_seconds: f64,
    },
    /// It did not.
    Failed {
        /// The device's error.
        reason: String,
    },
}
