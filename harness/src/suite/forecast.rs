//! Forecast of a run's time and disc, before it begins.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use formats::atomic::claimable;

use super::cost::{Costs, drawn};
use super::error::RunError;
use super::executor::{Contents, StageExecutor};
use super::file::Suite;
use super::plan::{StageKind, plan};
use super::preflight;
use super::record::{Around, Records, costs_of};
use super::run::RunOptions;
use super::size::in_words;
use crate::synth::Tools;

/// Seconds around the stages, on two cores.
const AROUND: Around = Around { start: 0.7, scene: 1.0, drawing: 0.2 };

/// Forecast for the stages of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageForecast {
    /// Stages of which earlier results are valid.
    pub cached: usize,
    /// Stages to be done.
    pub pending: usize,
    /// Number of pending stages that are estimated from timings of runs.
    pub measured: usize,
    /// Seconds of those to be done, one after the other.
    pub seconds: f64,
    /// Bytes that they leave.
    pub bytes: f64,
}

/// Forecast for a run.
#[derive(Clone, Debug, Default)]
pub struct Forecast {
    /// By kind of stage.
    pub kinds: BTreeMap<&'static str, StageForecast>,
    order: Vec<&'static str>,
    /// Seconds that are no stage's: programs and scenes that are read, the report.
    pub around: f64,
    /// Seconds of the longest line of stages that wait for one another.
    longest: f64,
    jobs: usize,
    free: Option<u64>,
}

/// Estimates a run of `suite` in the folder `out`, from the timings of `out` and of the runs `costs`, and refuses what
/// the run would refuse. Nothing is written.
pub fn forecast(
    suite: &Suite,
    out: &Path,
    costs: &[PathBuf],
    options: &RunOptions,
    tools: &Tools,
) -> Result<Forecast, RunError> {
    claimable(out)?;
    let RunOptions { redo, jobs, .. } = options;
    let methods = preflight::all(suite, redo, tools)?;
    let renderer = tools.interpreter.fingerprints()?;
    let executor = StageExecutor::new(suite, out, tools, &renderer, &methods, redo);
    let mut known = Costs::default();
    let mut around = None;
    for run in [out].into_iter().chain(costs.iter().map(PathBuf::as_path)) {
        let (records, measured) = costs_of(run);
        if records.is_empty() && run != out {
            return Err(RunError::NoRun(run.to_path_buf()));
        }
        if !records.is_empty() {
            around.get_or_insert(measured);
        }
        known.add(records);
    }
    let around = around.unwrap_or(AROUND);
    let records = Records::of(out);
    let mut contents = Contents::new();
    let mut forecast = Forecast { jobs: *jobs, free: preflight::free(out), ..Forecast::default() };
    let (mut ends, mut captures) = (Vec::new(), Vec::new());
    for stage in plan(suite) {
        let key = executor.key(&stage, &contents).ok();
        let key = key.filter(|_| !executor.is_redo(&stage));
        let kept =
            key.and_then(|key| records.seems_valid(&stage.id, &key.hash, &executor.path(&stage)));
        let before = stage.after.iter().map(|at| ends[*at]).fold(0.0, f64::max);
        let stages = forecast.kinds.entry(stage.kind.name()).or_default();
        let seconds = match kept {
            Some(output) => {
                contents.insert(stage.id.clone(), output);
                stages.cached += 1;
                0.0
            }
            None if !stage.wanted => 0.0,
            None => {
                if stage.kind == StageKind::Capture {
                    captures.push(&suite.cases[stage.case]);
                }
                let cost = known.estimate(suite, &stage);
                stages.pending += 1;
                stages.measured += usize::from(cost.measured);
                stages.seconds += cost.seconds;
                stages.bytes += cost.bytes;
                cost.seconds
            }
        };
        ends.push(before + seconds);
    }
    preflight::space(suite, &captures, out)?;
    preflight::scenes(suite, &captures, tools)?;
    forecast.longest = ends.into_iter().fold(0.0, f64::max);
    forecast.order = StageKind::ALL.into_iter().map(StageKind::name).collect();
    let drawing = if around.drawing > 0.0 { around.drawing } else { AROUND.drawing };
    forecast.around = around.start + around.scene * captures.len() as f64 + drawing * drawn(suite);
    Ok(forecast)
}

impl Forecast {
    /// Everything, by one process.
    pub fn seconds(&self) -> f64 {
        self.kinds.values().map(|stages| stages.seconds).sum::<f64>() + self.around
    }

    /// Bytes that are added.
    pub fn bytes(&self) -> f64 {
        self.kinds.values().map(|stages| stages.bytes).sum()
    }

    fn pending(&self) -> impl Iterator<Item = &StageForecast> {
        self.kinds.values().filter(|stages| stages.pending > 0)
    }
}

impl fmt::Display for Forecast {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "{:<9}{:>8}{:>8}{:>10}{:>12}", "stage", "cached", "to do", "time", "disc")?;
        for name in &self.order {
            let Some(stages) = self.kinds.get(name) else { continue };
            let (time, bytes) = (seconds(stages.seconds), in_words(stages.bytes as u64));
            writeln!(f, "{name:<9}{:>8}{:>8}{time:>10}{bytes:>12}", stages.cached, stages.pending)?;
        }
        writeln!(f, "{:<9}{:>8}{:>8}{:>10}{:>12}", "rest", "", "", seconds(self.around), "")?;
        let (total, bytes) = (self.seconds(), self.bytes() as u64);
        write!(f, "in all: {}, {} of disc", seconds(total), in_words(bytes))?;
        if let Some(free) = self.free {
            write!(f, " of {} that are free", in_words(free))?;
        }
        if self.jobs > 1 {
            let minimum =
                ((total - self.around) / self.jobs as f64).max(self.longest) + self.around;
            let jobs = self.jobs;
            write!(
                f,
                "\nwith --jobs {jobs}: from {} if one leaves the other processors idle",
                seconds(minimum)
            )?;
        }
        let guessed: usize = self.pending().map(|stages| stages.pending - stages.measured).sum();
        if guessed > 0 {
            write!(
                f,
                "\nno timings yet for {guessed} of the stages, using defaults for two cores; --costs RUN uses \
                 those of another run"
            )?;
        }
        Ok(())
    }
}

/// To two digits or so, which is what an estimate is worth.
fn seconds(seconds: f64) -> String {
    match seconds {
        ..120.0 => format!("{:.0} s", seconds.max(0.0)),
        ..7200.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}
