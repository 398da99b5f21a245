//! The steps of the paper's optimisation on synthetic G-buffers, each against its floors.

use std::time::Duration;

use serde::Serialize;
use solver::backend::Backend;
use solver::backend::cpu::Cpu;
use solver::memory::KeepFreedMemory;
use solver::model::deviation::Deviation;

use super::clock::{best, forget_peak, peak_memory};
use super::cost::{self, Cost};
use super::kind::Kind;
use super::machine::peak_now;
use super::synthetic::{Problem, paper};

/// The least work of a step.
pub fn least_work(kind: Kind, pixels: usize, size: usize) -> Cost {
    match kind {
        Kind::WarmUp => cost::warm_up(&paper(), pixels, size),
        Kind::Normals => cost::normals(&paper(), pixels, size),
        Kind::Diffuse => cost::diffuse(pixels, size),
    }
}

/// Rates that a machine reaches with a backend.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Reach {
    /// Multiply-adds, FLOP/s.
    pub flops: f64,
    /// To and from memory, bytes/s.
    pub bytes: f64,
}

/// A measured step.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    /// The kind of step.
    pub kind: Kind,
    /// On what.
    pub backend: String,
    /// Number of threads.
    pub threads: usize,
    /// Pixels of all views.
    pub pixels: usize,
    /// Side of the textures.
    pub texture: usize,
    /// Milliseconds of a step, the shortest of several.
    pub milliseconds: f64,
    /// The least work.
    pub cost: Cost,
    /// Milliseconds that the products alone would take.
    pub product_floor: f64,
    /// Milliseconds that all arithmetic would take.
    pub compute_floor: f64,
    /// Milliseconds that memory alone would take.
    pub memory_floor: f64,
    /// Multiply-adds right after such a step, FLOP/s: the most of several times.
    pub flops_after: f64,
    /// Largest resident set of the process, bytes.
    pub peak_memory: Option<u64>,
}

impl Step {
    /// The larger floor.
    pub fn floor(&self) -> f64 {
        self.compute_floor.max(self.memory_floor)
    }

    /// Fraction of the peak of multiply-adds that the products are: of the machine's, and of what is left
    /// of it after such steps.
    pub fn fractions_of_peak(&self) -> [f64; 2] {
        let after = 1e3 * self.cost.flops / self.flops_after;
        [self.product_floor, after].map(|floor| floor / self.milliseconds)
    }
}

/// Measures one kind of step; everything else is given back before.
pub fn measure(
    kind: Kind,
    backend: &Cpu,
    reach: Reach,
    (pixels, texture): (usize, usize),
    budget: Duration,
) -> Step {
    // As in a solve; dropped last, so that the next measurement begins with little memory.
    let _kept = KeepFreedMemory::begin();
    let forgot = forget_peak();
    let problem = Problem::new(pixels, texture);
    let deviation = Deviation::new(&problem.config, texture);
    let mut fit = problem.fit(kind, &deviation, backend);
    let seconds = best(budget, 2, || {
        fit.step(backend, 1.0);
    });
    // Not in between: the steps are to find the processor as those of a solve do.
    let mut flops_after = 0.0f64;
    best(budget / 4, 2, || {
        fit.step(backend, 1.0);
        flops_after = flops_after.max(peak_now(backend));
    });
    let cost = least_work(kind, pixels, texture);
    Step {
        kind,
        backend: backend.name(),
        threads: rayon::current_num_threads(),
        pixels,
        texture,
        milliseconds: 1e3 * seconds,
        cost,
        product_floor: 1e3 * cost.flops / reach.flops,
        compute_floor: 1e3 * cost.operations / reach.flops,
        memory_floor: 1e3 * cost.bytes / reach.bytes,
        flops_after,
        peak_memory: forgot.then(peak_memory).flatten(),
    }
}
