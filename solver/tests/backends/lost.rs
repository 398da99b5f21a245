//! After the loss of a device, the solve continues on the processor.

use std::ops::ControlFlow;

use solver::backend::Backend;
use solver::backend::cpu::Cpu;
use solver::backend::gpu::{Adapter, Gpu};
use solver::{Config, Options, Solution, solve_on};

use super::scene::{capture, short};

/// Light and joint fit on the processor; relief and albedo on the device.
fn config() -> Config {
    short().without_records()
}

/// Steps of the stages: two rounds of the light, joint fit with and without grey light, relief, albedo.
const STAGES: [usize; 6] = [60, 60, 60, 60, 20, 40];
/// Steps of all stages.
const STEPS: usize = 300;

/// Loses the device after `at` steps.
fn solve(gpu: &Gpu, at: usize) -> (Solution, Vec<usize>) {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(folder.path());
    let mut heard = vec![];
    let solution = solve_on(gpu, &capture, &config(), Options::default(), &mut |progress| {
        heard.push(progress.iteration);
        if progress.iteration >= at {
            gpu.destroy();
        }
        ControlFlow::Continue(())
    });
    (solution.unwrap(), heard)
}

fn assert_complete(solution: &Solution) {
    let record = &solution.record;
    assert_eq!(record.interrupted, None);
    assert_eq!(record.stages.iter().map(|stage| stage.loss.len()).collect::<Vec<_>>(), STAGES);
    let folder = tempfile::tempdir().unwrap();
    let silent = &mut |_: &solver::Progress| ControlFlow::Continue(());
    let capture = capture(folder.path());
    let expected = solve_on(&Cpu::new(), &capture, &config(), Options::default(), silent).unwrap();
    for (stage, expected) in record.stages.iter().zip(&expected.record.stages) {
        let off = stage.loss.iter().zip(&expected.loss).map(|(a, b)| (a / b - 1.0).abs());
        assert!(off.fold(0.0, f64::max) < 1e-3, "{}", stage.name);
    }
    for word in ["gpu, ", "it failed (", "then cpu, "] {
        assert!(record.backend.contains(word), "{}", record.backend);
    }
}

pub fn within_the_heights(adapter: &Adapter) {
    let gpu = Gpu::open(adapter).unwrap();
    let (solution, heard) = solve(&gpu, 243);
    assert_complete(&solution);
    // Fits report submissions; heights report every step, and only once.
    let heights: Vec<usize> = heard.iter().copied().filter(|step| *step > 240).collect();
    assert_eq!(heights, (241..=STEPS).collect::<Vec<_>>());
}

pub fn within_a_stage(adapter: &Adapter) {
    let gpu = Gpu::open(adapter).unwrap();
    let (solution, heard) = solve(&gpu, 281);
    assert_complete(&solution);
    // The lost steps are unknown to the host, so the stage restarts and is reported from its first step.
    assert!(heard.iter().filter(|step| **step == 261).count() > 1, "{heard:?}");
    assert_eq!(heard.last(), Some(&STEPS));
}

pub fn before(adapter: &Adapter) {
    let gpu = Gpu::open(adapter).unwrap();
    assert!(!gpu.name().contains("failed"));
    gpu.destroy();
    let (solution, heard) = solve(&gpu, 0);
    assert_complete(&solution);
    assert_eq!(heard, (1..=STEPS).collect::<Vec<_>>());
}
