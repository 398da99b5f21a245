//! A running program with its limits: a process group that is ended as a whole.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::process::{Child, Command, ExitStatus};
use std::sync::atomic::Ordering;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::spawn::{Network, spawn};
use crate::synth::Interrupt;

/// Between two looks at the program.
const LOOK: Duration = Duration::from_millis(25);
/// Between two ticks.
const TICK: Duration = Duration::from_millis(500);
/// Bytes at the end of a log that hold its last line.
const END: u64 = 4096;
/// A log that grows past this ends the program before it fills the disk, bytes.
const LARGEST_LOG: u64 = 256 << 20;
const GIB: f64 = (1u64 << 30) as f64;

/// Limits of a program; none where nothing is stated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Wall time, seconds.
    pub timeout_s: Option<f64>,
    /// Resident memory of all its processes, GiB.
    pub memory_gib: Option<f64>,
    /// Processors that it may use.
    pub threads: Option<usize>,
}

/// Time and memory that a program took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Usage {
    /// Wall time, seconds.
    pub seconds: f64,
    /// Largest resident memory of all its processes together, bytes.
    pub peak_bytes: u64,
    /// Whether the kernel kept it to its own files.
    pub confined: bool,
    /// The network that it could reach.
    #[serde(default)]
    pub network: Network,
}

/// How the watch ended.
pub(super) enum End {
    /// By itself.
    Exited(ExitStatus),
    /// It took more than it may.
    Limit(String),
    /// The user interrupted.
    Interrupted,
}

/// Settings of a program's start, beside its command.
pub(super) struct Watched<'a> {
    pub limits: &'a Limits,
    /// Whether it may use the network.
    pub network: bool,
    /// The file that it prints to.
    pub log: &'a Path,
    pub interrupt: &'a Interrupt,
}

/// Starts `command` in a process group of its own, which dies with this thread, and waits for it. `ticks` says again and
/// again that it runs: this thread may not read its log. Nothing of the group is left when this returns.
pub(super) fn watch(
    command: Command,
    watched: &Watched,
    ticks: &Sender<()>,
    usage: &mut Usage,
) -> io::Result<End> {
    let Watched { limits, network, log, interrupt } = *watched;
    if let Some(threads) = limits.threads {
        keep_to_processors(threads)?;
    }
    let start = Instant::now();
    let mut child;
    (child, usage.network) = spawn(command, network)?;
    let mut said = start;
    let end = loop {
        if said.elapsed() >= TICK {
            said = Instant::now();
            // Nobody listens after a fault.
            let _ = ticks.send(());
        }
        let members = members(child.id());
        usage.peak_bytes = usage.peak_bytes.max(memory(&members));
        usage.seconds = start.elapsed().as_secs_f64();
        if interrupt.load(Ordering::Relaxed) {
            break End::Interrupted;
        }
        if let Some(status) = child.try_wait()? {
            break End::Exited(status);
        }
        if let Some(reason) = exceeded(limits, usage, log) {
            break End::Limit(reason);
        }
        thread::sleep(LOOK);
    };
    end_group(&mut child);
    Ok(end)
}

fn exceeded(limits: &Limits, usage: &Usage, log: &Path) -> Option<String> {
    if let Some(limit) = limits.timeout_s.filter(|limit| usage.seconds > *limit) {
        return Some(format!("took longer than timeout_s = {limit}"));
    }
    if let Some(limit) = limits.memory_gib.filter(|limit| usage.peak_bytes as f64 > limit * GIB) {
        let taken = usage.peak_bytes as f64 / GIB;
        return Some(format!("took {taken:.2} GiB of memory, more than memory_gib = {limit}"));
    }
    let written = fs::metadata(log).map_or(0, |log| log.len());
    (written > LARGEST_LOG).then(|| format!("wrote more than {} MiB to its log", LARGEST_LOG >> 20))
}

/// The last line of a log that is not blank, as a terminal shows it: a progress bar writes over its line.
pub(super) fn last_line(log: &Path) -> String {
    let mut bytes = Vec::new();
    let _ = File::open(log).and_then(|mut file| {
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(END)))?;
        file.read_to_end(&mut bytes)
    });
    let text = String::from_utf8_lossy(&bytes);
    let last = text.split(['\n', '\r']).rev().map(str::trim).find(|line| !line.is_empty());
    last.unwrap_or_default().chars().filter(|letter| !letter.is_control()).collect()
}

/// Processes of the group `leader`, and all that they started.
fn members(leader: u32) -> Vec<u32> {
    let mut processes: Vec<(u32, u32, u32)> = Vec::new();
    for entry in fs::read_dir("/proc").into_iter().flatten().flatten() {
        let id = entry.file_name().to_str().and_then(|name| name.parse().ok());
        let Some(id) = id else { continue };
        let Ok(stat) = fs::read_to_string(entry.path().join("stat")) else { continue };
        // The name, in parentheses, may hold anything.
        let Some((_, rest)) = stat.rsplit_once(')') else { continue };
        let mut fields = rest.split_whitespace().skip(1).map_while(|field| field.parse().ok());
        if let (Some(parent), Some(group)) = (fields.next(), fields.next()) {
            processes.push((id, parent, group));
        }
    }
    let mut members = vec![leader];
    loop {
        let more: Vec<u32> = processes
            .iter()
            .filter(|(id, parent, group)| {
                !members.contains(id) && (*group == leader || members.contains(parent))
            })
            .map(|(id, ..)| *id)
            .collect();
        if more.is_empty() {
            return members;
        }
        members.extend(more);
    }
}

/// Bytes that the processes have in memory; what several share counts once.
fn memory(processes: &[u32]) -> u64 {
    let kilobytes = |process: &u32, file: &str, key: &str| -> Option<u64> {
        let text = fs::read_to_string(format!("/proc/{process}/{file}")).ok()?;
        let line = text.lines().find_map(|line| line.strip_prefix(key))?;
        line.split_whitespace().next()?.parse().ok()
    };
    let resident = |process: &u32| kilobytes(process, "status", "VmRSS:").unwrap_or(0);
    let shared = |process: &u32| {
        kilobytes(process, "smaps_rollup", "Pss:").unwrap_or_else(|| resident(process))
    };
    let total: u64 = match processes {
        [alone] => resident(alone),
        many => many.iter().map(shared).sum(),
    };
    total * 1024
}

#[cfg(unix)]
fn end_group(child: &mut Child) {
    use rustix::process::{Pid, Signal, kill_process, kill_process_group};
    // Those first that left the group, as long as it is known whose they are.
    for process in members(child.id()) {
        if let Some(pid) = i32::try_from(process).ok().and_then(Pid::from_raw) {
            let _ = kill_process(pid, Signal::KILL);
        }
    }
    if let Some(pid) = i32::try_from(child.id()).ok().and_then(Pid::from_raw) {
        let _ = kill_process_group(pid, Signal::KILL);
    }
    let _ = child.wait();
}

#[cfg(not(unix))]
fn end_group(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

/// This thread, and so what it starts, runs on at most so many of its processors.
#[cfg(target_os = "linux")]
fn keep_to_processors(threads: usize) -> io::Result<()> {
    use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
    let all = sched_getaffinity(None)?;
    let mut some = CpuSet::new();
    (0..CpuSet::MAX_CPU).filter(|cpu| all.is_set(*cpu)).take(threads).for_each(|cpu| some.set(cpu));
    Ok(sched_setaffinity(None, &some)?)
}

#[cfg(not(target_os = "linux"))]
fn keep_to_processors(_: usize) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_line_of_a_log_is_what_a_terminal_shows_last() {
        let folder = tempfile::tempdir().unwrap();
        let log = folder.path().join("log");
        let last = |text: &str| {
            fs::write(&log, text).unwrap();
            last_line(&log)
        };
        assert_eq!(last(""), "");
        assert_eq!(last("loss 2\nloss 1\n\n"), "loss 1");
        assert_eq!(last("begin\n 10 %\r 20 %\r"), "20 %");
        assert_eq!(last(&format!("{}\n\u{1b}end", "x".repeat(9000))), "end");
    }
}
