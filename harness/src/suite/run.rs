//! Runs a suite: capture, solve, relight, score for every case, then the report.
//!
//! A stage whose inputs have not changed, or are those of an earlier run, is skipped; every output appears complete or not at
//! all, so a run that was killed goes on where it stopped and ends with the same bytes.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use formats::atomic;
use formats::content_hash::hash_parts;

use super::cluster::{self, Cluster, Elsewhere};
use super::cost::drawn;
use super::error::RunError;
use super::executor::{Contents, StageExecutor};
use super::file::Suite;
use super::manifest::{Ended, manifest};
use super::observer::Observer;
use super::plan::{Stage, StageKind, plan};
use super::pool::{self, PlanOptions};
use super::preflight;
use super::program::{self, copy_folder};
use super::record::{Records, Times};
use crate::synth::Tools;

/// The stage that comes last.
const REPORT: &str = "report";

/// Options of a run, beside its suite.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Methods whose maps are made anew, whatever was kept.
    pub redo: Vec<String>,
    /// How many stages are done at once, 1 or more.
    pub jobs: usize,
    /// Where stages are done, if not here.
    pub cluster: Option<Cluster>,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self { redo: Vec::new(), jobs: 1, cluster: None }
    }
}

/// Outcome of a run.
#[derive(Debug)]
pub struct RunSummary {
    /// The page to open.
    pub report: PathBuf,
    /// Stages that ran, and stages whose earlier results were still valid.
    pub ran: usize,
    /// See `ran`.
    pub skipped: usize,
    /// Methods that failed: `<case>/<method>` and why.
    pub failed: BTreeMap<String, String>,
}

/// Runs `suite` in the folder `out`. A method that fails leaves its cells empty and the others run.
pub fn run(
    suite: &Suite,
    out: &Path,
    options: &RunOptions,
    tools: &Tools,
    observer: &mut dyn Observer,
) -> Result<RunSummary, RunError> {
    let (_lock, mut times, done) = stages(suite, out, options, tools, observer)?;
    let pool::Outcome { ran, skipped, failed, .. } = done;
    let folder = out.join("report");
    let start = Instant::now();
    let stages = plan(suite).len();
    observer.stage_begins(REPORT, stages, stages + 1);
    report(out, &folder, tools, &mut |done, total, what| observer.step(REPORT, done, total, what))?;
    observer.stage_ends(REPORT, Some(start.elapsed().as_secs_f64()));
    times.around.drawing = start.elapsed().as_secs_f64() / drawn(suite).max(1e-6);
    times.write()?;
    Ok(RunSummary { report: folder.join("index.html"), ran, skipped, failed })
}

/// Begins the run of `suite` in the folder `out`, unless it has been begun, with what the finished run `first` holds:
/// what does not differ between the two is made once.
pub fn begin_from(first: &Path, suite: &Suite, out: &Path) -> Result<(), RunError> {
    let _lock = claim(suite, out)?;
    let records = out.join("stages");
    if records.exists() {
        return Ok(());
    }
    for kind in StageKind::ALL.iter().filter(|kind| first.join(kind.folder()).is_dir()) {
        copy_folder(&first.join(kind.folder()), &out.join(kind.folder()))?;
    }
    fs::copy(first.join("timing.json"), out.join("timing.json"))?;
    // Last: without a record, whatever a copy that was cut short left is made anew.
    Ok(copy_folder(&first.join("stages"), &records)?)
}

/// Everything but the report.
pub(super) fn stages(
    suite: &Suite,
    out: &Path,
    options: &RunOptions,
    tools: &Tools,
    observer: &mut dyn Observer,
) -> Result<(File, Times, pool::Outcome), RunError> {
    let start = Instant::now();
    observer.suite_begins();
    let methods = preflight::all(suite, &options.redo, tools)?;
    let lock = claim(suite, out)?;
    program::clear_scratch(&program::scratch_prefix(out));
    let renderer = tools.interpreter.fingerprints()?;
    let plan = plan(suite);
    let records = Records::open(out)?;
    let mut times = Times::new(out, &plan);
    let redo = &options.redo;
    let executor = StageExecutor::new(suite, out, tools, &renderer, &methods, redo);
    manifest(suite, &renderer, Ended::default()).write(out)?;
    times.around.start = start.elapsed().as_secs_f64();
    let reading = Instant::now();
    if let Some(cases) = prepare(&executor, &plan, &records)? {
        times.around.scene = reading.elapsed().as_secs_f64() / cases as f64;
    }
    let elsewhere = match &options.cluster {
        Some(cluster) => cluster::run(&executor, &plan, cluster, &records, observer)?,
        None => Elsewhere::default(),
    };
    let made_elsewhere = elsewhere.records.len();
    let records = records.with(elsewhere.records);
    let mut counted = Counted { observer, total: plan.len() + 1 };
    let work = PlanOptions { plan: &plan, jobs: options.jobs, failed: elsewhere.failed };
    let done = pool::run(&executor, work, &records, &mut times, &mut counted);
    times.write()?;
    let mut done = done?;
    done.ran += made_elsewhere;
    done.skipped = done.skipped.saturating_sub(made_elsewhere);
    let left_out = done.left_out.iter().filter_map(|at| plan[*at].cell(suite)).collect();
    let mut contents = BTreeMap::new();
    for resolved in &methods {
        if let Some(parts) = resolved.method.work().identity(resolved)? {
            let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
            contents.insert(resolved.method.id.clone(), hash_parts(&parts));
        }
    }
    let (failed, bytes) = (done.failed.clone(), bytes(&plan, &times));
    manifest(suite, &renderer, Ended { failed, left_out, contents, bytes }).write(out)?;
    Ok((lock, times, done))
}

/// Takes the folder `out` for a run of `suite`, for as long as the result is kept.
pub(super) fn claim(suite: &Suite, out: &Path) -> Result<File, RunError> {
    atomic::refuse_overlap(out, &[&suite.path])?;
    atomic::claim(out)?;
    lock(out)
}

/// Keeps other runs from the folder of a run, for as long as the result is kept.
pub(super) fn lock(run: &Path) -> Result<File, RunError> {
    let lock = File::create(run.join(".lock"))?;
    match lock.try_lock() {
        Ok(()) => Ok(lock),
        Err(TryLockError::WouldBlock) => Err(RunError::Busy(run.to_path_buf())),
        Err(TryLockError::Error(error)) => Err(error.into()),
    }
}

/// Counts the report among the stages.
struct Counted<'a> {
    observer: &'a mut dyn Observer,
    total: usize,
}

impl Observer for Counted<'_> {
    fn stage_begins(&mut self, id: &str, done: usize, _: usize) {
        self.observer.stage_begins(id, done, self.total);
    }

    fn step(&mut self, id: &str, done: u64, total: u64, what: &str) {
        self.observer.step(id, done, total, what);
    }

    fn stage_ends(&mut self, id: &str, seconds: Option<f64>) {
        self.observer.stage_ends(id, seconds);
    }

    fn stage_fails(&mut self, id: &str, reason: &str) {
        self.observer.stage_fails(id, reason);
    }
}

/// Writes the report of the run folder `run` to the folder `out`.
pub fn report(
    run: &Path,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    report::write(run, out, &mut |done, total, case| {
        step(done, total, case);
        !tools.interrupt.load(Ordering::Relaxed)
    })?;
    Ok(())
}

/// Bytes that the stages of each kind left.
fn bytes(plan: &[Stage], times: &Times) -> BTreeMap<String, u64> {
    let kinds: BTreeMap<&str, StageKind> =
        plan.iter().map(|stage| (stage.id.as_str(), stage.kind)).collect();
    let mut bytes = BTreeMap::new();
    for record in times.records() {
        if let Some(kind) = kinds.get(record.id.as_str()) {
            *bytes.entry(kind.folder().to_owned()).or_insert(0) += record.bytes;
        }
    }
    bytes
}

/// Writes the scenes of all cases, and checks those that are still to be rendered: how many, if any.
fn prepare(
    executor: &StageExecutor,
    plan: &[Stage],
    records: &Records,
) -> Result<Option<usize>, RunError> {
    let (suite, out) = (executor.suite, executor.out);
    for case in suite.cases.iter().filter(|case| case.photographed.is_none()) {
        case.write_scene(&out.join(StageKind::Capture.folder()))?;
    }
    let mut pending = Vec::new();
    for stage in plan.iter().filter(|stage| stage.kind == StageKind::Capture && stage.wanted) {
        let key = executor.key(stage, &Contents::new())?.hash;
        if records.find_or_restore(&stage.id, &key, &executor.path(stage))?.is_none() {
            pending.push(&suite.cases[stage.case]);
        }
    }
    preflight::space(suite, &pending, out)?;
    preflight::scenes(suite, &pending, executor.tools)?;
    Ok((!pending.is_empty()).then_some(pending.len()))
}
