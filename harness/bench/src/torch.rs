//! The paper's steps in PyTorch, an optional extra: a Python that has torch runs `torch_steps.py` on
//! equal numbers.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::Command;

use serde::Deserialize;
use solver::model::planes::Planes;

use super::kind::Kind;
use super::synthetic::Problem;

const SCRIPT: &str = include_str!("torch_steps.py");

/// The way to get PyTorch's rows.
pub const INSTALL: &str = "python3 -m venv torch && torch/bin/pip install torch numpy, then `unshade \
                           bench --torch torch/bin/python`";

/// The answer of `torch_steps.py`.
#[derive(Deserialize)]
pub struct TorchSteps {
    /// Milliseconds of a step, the shortest of several.
    pub milliseconds: f64,
    /// The loss before every step.
    pub losses: Vec<f64>,
    /// Largest resident set of the Python process, or the memory of its tensors on the GPU, bytes.
    pub peak_memory: u64,
    /// PyTorch's version.
    pub version: String,
}

/// PyTorch cannot take the steps.
#[derive(Debug, thiserror::Error)]
pub enum TorchError {
    /// The problem's file cannot be written.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// Python failed.
    #[error("{python} cannot run the steps: {reason}; get PyTorch by: {INSTALL}")]
    Python {
        /// The interpreter.
        python: String,
        /// The last line of its messages.
        reason: String,
    },
}

/// The device that PyTorch computes on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum TorchPlace {
    /// As many threads as this process has.
    Cpu,
    /// The GPU that CUDA lists first.
    Cuda,
}

impl TorchPlace {
    /// PyTorch's name of the device.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Cuda => "cuda",
        }
    }
}

/// Runs `steps` eager steps of `kind` on `problem`.
pub fn measure(
    python: &Path,
    place: TorchPlace,
    kind: Kind,
    problem: &Problem,
    steps: usize,
) -> Result<TorchSteps, TorchError> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("problem.f32");
    write(&file, problem)?;
    let arguments = serde_json::json!({
        "kind": kind, "file": file, "pixels": problem.samples.len(), "size": problem.state.size,
        "steps": steps, "device": place.name(), "threads": rayon::current_num_threads(),
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
