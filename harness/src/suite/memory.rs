//! How much memory stages take, so that no more run at once than there is memory for.

use std::collections::BTreeMap;

use solver::memory::{Estimate, available};

use super::cost::frame;
use super::method::MethodKind;
use super::plan::{Kind, Task};
use super::workshop::Workshop;

/// A process with the renderer in it, at the least (measured: 495 MB for 96 x 96 pictures), bytes.
const RENDERER: u64 = 500 << 20;
/// A camera ray in flight, and how many there are at most, see `synth/unshade/render/passes.py`.
const RAY: u64 = 300;
const MAX_RAYS: u64 = 1 << 21;
/// A program that states no limit.
const PROGRAM: u64 = 2 << 30;
/// Scoring, and methods that optimise nothing.
const SMALL: u64 = 200 << 20;
/// Part of the free memory that is used: the rest is for what the estimates miss.
const USED_FRACTION: f64 = 0.9;

/// Running stages, with the memory that each takes.
pub(super) struct Memory {
    /// Bytes; none for a single worker, or where the system does not report its memory.
    limit: Option<u64>,
    /// Estimates of stages that were asked for, by their place in the plan.
    known: BTreeMap<usize, u64>,
    taken: BTreeMap<usize, u64>,
}

impl Memory {
    /// For so many workers.
    pub fn new(workers: usize) -> Self {
        let limit = available().filter(|_| workers > 1);
        Self::limited(limit.map(|bytes| (USED_FRACTION * bytes as f64) as u64))
    }

    fn limited(limit: Option<u64>) -> Self {
        Self { limit, known: BTreeMap::new(), taken: BTreeMap::new() }
    }

    /// Takes the memory of the stage `at`, if it fits beside what runs; `alone` it always does.
    pub fn take(&mut self, at: usize, alone: bool, estimate: impl FnOnce() -> u64) -> bool {
        let Some(limit) = self.limit else { return true };
        let bytes = *self.known.entry(at).or_insert_with(estimate);
        let fits = alone || self.taken.values().sum::<u64>() + bytes <= limit;
        if fits {
            self.taken.insert(at, bytes);
        }
        fits
    }

    /// The stage `at` is over.
    pub fn give_back(&mut self, at: usize) {
        self.taken.remove(&at);
    }
}

/// Bytes that a stage takes at its peak.
pub(super) fn estimate(workshop: &Workshop, task: &Task) -> u64 {
    let suite = workshop.suite;
    let renders = RENDERER + RAY * frame(suite, task).min(MAX_RAYS);
    let method = task.method.map(|method| &suite.methods[method].kind);
    match (task.kind, method) {
        (Kind::Maps, Some(MethodKind::Fields { config, .. })) => {
            let capture = capture::Capture::open(&workshop.capture(task));
            match (capture, solver::Config::from_toml(config)) {
                (Ok(capture), Ok(config)) => Estimate::new(&capture, &config).peak,
                // The stage itself says what is wrong with them.
                _ => SMALL,
            }
        }
        (Kind::Maps, Some(MethodKind::Program(program))) => {
            let stated = program.limits.memory_gib;
            stated.map_or(PROGRAM, |gib| (gib * f64::from(1 << 30)) as u64)
        }
        (Kind::Maps, Some(MethodKind::Competitor { .. })) | (Kind::Capture | Kind::Relit, _) => {
            renders
        }
        (Kind::Lights, _) => RENDERER,
        (Kind::Maps | Kind::Scores, _) => SMALL,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_runs_at_once_than_there_is_memory_for() {
        let mut memory = Memory::limited(Some(10));
        assert!(memory.take(0, true, || 6));
        assert!(!memory.take(1, false, || 5));
        assert!(memory.take(2, false, || 4), "a smaller one fits beside it");
        memory.give_back(0);
        assert!(memory.take(1, false, || panic!("it was asked for before")));
        memory.give_back(1);
        memory.give_back(2);
        assert!(memory.take(3, true, || 1000), "what fits nowhere runs alone");
        assert!(!memory.take(4, false, || 1));
    }
}
