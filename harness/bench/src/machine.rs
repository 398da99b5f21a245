//! The machine: its names, the rates that it reaches in this run, and the time and memory of work on it.

use std::fs;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use serde::Serialize;
use solver::backend::cpu::{Cpu, Level};

/// Rounds of multiply-adds on one thread, about 10 ms.
const ROUNDS: usize = 4_000_000;

/// The machine in words.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// The processor's name.
    pub processor: String,
    /// Hardware threads that the run used.
    pub threads: usize,
    /// Sizes of the caches, the smallest first, as the system names them.
    pub caches: Vec<String>,
    /// Runnable processes when the run began, mean of a minute, this one included.
    pub load: Option<f64>,
    /// Bytes of memory.
    pub memory: Option<u64>,
    /// Operating system and architecture.
    pub system: String,
    /// Version of this program.
    pub version: String,
}

impl Machine {
    /// Describes this machine. Values that the system does not give are left out.
    pub fn here() -> Self {
        let line = |file: &str, key: &str| {
            let text = fs::read_to_string(file).ok()?;
            let line = text.lines().find(|line| line.starts_with(key))?;
            line.split_once(':').map(|(_, value)| value.trim().to_owned())
        };
        let kilobytes = |value: String| value.trim_end_matches(" kB").parse::<u64>().ok();
        let cache = |index: usize| {
            let of = |what: &str| {
                let file = format!("/sys/devices/system/cpu/cpu0/cache/index{index}/{what}");
                fs::read_to_string(file).ok().map(|text| text.trim().to_owned())
            };
            let (level, kind, size) = (of("level")?, of("type")?, of("size")?);
            (kind != "Instruction").then(|| format!("L{level} {size}"))
        };
        Self {
            processor: line("/proc/cpuinfo", "model name").unwrap_or_else(|| "unknown".to_owned()),
            threads: rayon::current_num_threads(),
            caches: (0..8).filter_map(cache).collect(),
            load: fs::read_to_string("/proc/loadavg")
                .ok()
                .and_then(|text| text.split_whitespace().next()?.parse().ok()),
            memory: line("/proc/meminfo", "MemTotal").and_then(kilobytes).map(|kb| kb * 1024),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}

/// Rates that a device reaches.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Reach {
    /// Multiply-adds, FLOP/s.
    pub flops: f64,
    /// From and to memory, bytes/s.
    pub bytes: f64,
}

/// Runs `work` as often as fits into `budget`, `min_runs` times at least, and returns the shortest time in
/// seconds: other work of the machine only adds to it.
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

/// Resets the largest memory of this process; false where the system cannot.
pub fn reset_peak_memory() -> bool {
    fs::write("/proc/self/clear_refs", "5").is_ok()
}

/// The largest resident set of this process since [`reset_peak_memory`], bytes.
pub fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches(" kB").parse::<u64>().ok().map(|kb| kb * 1024)
}

/// Multiply-adds per second of all threads, in FLOP/s.
pub fn peak(level: Level, budget: Duration) -> f64 {
    let cpu = Cpu::at(level);
    let mut flops = 0.0;
    let seconds = best(budget, 3, || {
        let each = rayon::broadcast(|_| cpu.multiply_adds(ROUNDS));
        flops = each.iter().sum();
    });
    flops / seconds
}

/// Bytes per second of a = b + s c over arrays of `bytes` each, which no cache should hold, all threads
/// (STREAM's triad: two reads and a write are counted).
pub fn bandwidth(bytes: usize, budget: Duration) -> f64 {
    let count = bytes / size_of::<f32>();
    let mut a = vec![0.0f32; count];
    let (b, c) = (vec![1.0f32; count], vec![2.0f32; count]);
    let seconds = best(budget, 3, || {
        let sources = b.par_chunks(1 << 16).zip(c.par_chunks(1 << 16));
        a.par_chunks_mut(1 << 16).zip(sources).for_each(|(a, (b, c))| {
            a.iter_mut().zip(b.iter().zip(c)).for_each(|(a, (b, c))| *a = b + 3.0 * c);
        });
    });
    std::hint::black_box(&a);
    3.0 * bytes as f64 / seconds
}
