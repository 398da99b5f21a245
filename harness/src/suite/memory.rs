//! How much memory stages take, so that no more run at once than there is memory for.

use std::collections::BTreeMap;

use solver::memory::available;

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
