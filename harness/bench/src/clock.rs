//! Time and memory of a piece of work.

use std::fs;
use std::time::{Duration, Instant};

/// The shortest of as many runs as fit into `budget`, `min_runs` at the least; seconds. The shortest,
/// because whatever else the machine does only ever adds to it.
pub fn best(budget: Duration, min_runs: usize, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    let mut best = f64::INFINITY;
    let mut runs = 0;
    while runs < min_runs || start.elapsed() < budget {
        let begin = Instant::now();
        work();
        best = best.min(begin.elapsed().as_secs_f64());
        runs += 1;
    }
    best
}

/// Forgets the largest memory of this process so far; false where the system cannot.
pub fn forget_peak() -> bool {
    fs::write("/proc/self/clear_refs", "5").is_ok()
}

/// The largest resident set of this process since [`forget_peak`], bytes.
pub fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches(" kB").parse::<u64>().ok().map(|kb| kb * 1024)
}
