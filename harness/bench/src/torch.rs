//! The paper's steps in PyTorch, an optional extra: a Python that has torch runs `torch_steps.py` on
//! equal numbers, and its times and losses stand beside ours.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};
use solver::model::planes::Planes;

use super::kind::Kind;
use super::synthetic::Problem;

/// Steps whose losses are compared with PyTorch's.
pub(super) const TORCH_STEPS: usize = 8;

const SCRIPT: &str = include_str!("torch_steps.py");

/// How to get the row, where there is no PyTorch.
pub const FIX: &str = "python3 -m venv torch && torch/bin/pip install torch numpy, then `unshade \
                        bench --torch torch/bin/python`";

/// Steps of one kind in PyTorch.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TorchStep {
    /// Milliseconds of a step, the shortest of several.
    pub milliseconds: f64,
    /// The loss before every step.
    pub losses: Vec<f64>,
    /// Largest resident set of the Python process, or what its tensors took on the GPU, bytes.
    pub peak_memory: u64,
    /// PyTorch's version.
    pub version: String,
}

/// A Python that cannot do it, with the fix.
#[derive(Debug, thiserror::Error)]
pub enum TorchError {
    /// The problem cannot be handed over.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// Python said no.
    #[error("{python} cannot run the steps: {reason}; get PyTorch by: {FIX}")]
    Python {
        /// The interpreter.
        python: String,
        /// Its last line.
        reason: String,
    },
}

/// Where PyTorch computes.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TorchDevice {
    /// As many threads as this process has.
    Cpu,
    /// The GPU that CUDA lists first.
    Cuda,
}

/// Runs `steps` eager steps of `kind` on `problem`.
pub fn measure(
    python: &Path,
    device: TorchDevice,
    kind: Kind,
    problem: &Problem,
    steps: usize,
) -> Result<TorchStep, TorchError> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("problem.f32");
    write(&file, problem)?;
    let arguments = serde_json::json!({
        "kind": kind, "file": file, "pixels": problem.samples.len(), "size": problem.state.size,
        "steps": steps, "device": device, "threads": rayon::current_num_threads(),
        "prior": problem.config.warm_up.prior, "rate": problem.config.warm_up.diffuse_rate,
        "range": problem.config.fine_tuning.deviation_range,
        "blur": problem.config.fine_tuning.deviation_blur,
    });
    let failed =
        |reason: String| TorchError::Python { python: python.display().to_string(), reason };
    let output = Command::new(python)
        .args(["-c", SCRIPT, &arguments.to_string()])
        .output()
        .map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(failed(text.trim().lines().last().unwrap_or("no reason given").to_owned()));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| failed(error.to_string()))
}

/// The arrays one after the other: position, normal, view, Fresnel factor, colour, weight, place in the
/// texture (column and row of texel centres); networks; diffuse and specular albedo.
fn write(file: &Path, problem: &Problem) -> io::Result<()> {
    let Problem { samples, state, .. } = problem;
    let mut out = BufWriter::new(File::create(file)?);
    let mut put = |value: f32| out.write_all(&value.to_le_bytes());
    let planes: [&Planes; 6] = [
        &samples.position,
        &samples.normal,
        &samples.view,
        &samples.fresnel,
        &samples.target,
        &samples.weight,
    ];
    for plane in planes {
        for i in 0..plane.len() {
            (0..plane.rows()).try_for_each(|row| put(plane.get(row, i)))?;
        }
    }
    for i in 0..samples.len() {
        samples.taps.place(i).into_iter().try_for_each(&mut put)?;
    }
    for values in [&state.networks.parameters, &state.diffuse, &state.specular] {
        values.iter().try_for_each(|value| put(*value))?;
    }
    out.flush()
}
