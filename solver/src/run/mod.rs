//! The bookkeeping of a solve: stages and their stored values, progress, losses, times, interrupts, checkpoints.

pub mod checkpoint;
mod clock;
pub(crate) mod error;
mod log;
pub(crate) mod progress;

use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;

use self::checkpoint::{FitMemory, Open};
use self::clock::Clock;
pub use self::clock::Extent;
pub(crate) use self::clock::Work;
use self::error::SolveError;
use self::log::{Cut, Log};
use self::progress::{Callback, Progress};
use crate::backend::Backend;
use crate::backend::resident::{BATCH, DeviceError, Resident};
use crate::fit::Fit;
use crate::solution::{StageRecord, Timing};

/// Time between two downloads of a device's variables: a failure of the device costs at most this time.
const FETCH: Duration = Duration::from_secs(20);
/// Target time of a submission: systems reset a device that does not respond for seconds.
const SUBMISSION: Duration = Duration::from_millis(200);

/// Runs the stages of a solve in their order.
///
/// A stage is a function from values to a value, which is stored; the same solve, started again, reads the stored
/// value. After an interrupt the remaining stages run without steps, so that a solve always ends with maps.
pub(crate) struct Run<'a, 'b> {
    pub backend: &'a dyn Backend,
    progress: &'a mut Callback<'b>,
    final_decay: f32,
    total: usize,
    clock: Clock,
    log: Log,
    cut: Option<Cut>,
    checkpoint: Option<Open>,
    /// The fit during which an earlier run was interrupted, until it continues.
    pending: Option<FitMemory>,
    lap: Instant,
    /// Seconds of this lap in the interrupted run.
    earlier: f64,
}

impl<'a, 'b> Run<'a, 'b> {
    /// A run of the stages of `plan`. The learning rates of every fit fall by the factor `final_decay` over its last
    /// 40 %; 1 keeps them constant.
    pub fn new(
        plan: Vec<Work>,
        final_decay: f32,
        backend: &'a dyn Backend,
        mut checkpoint: Option<Open>,
        progress: &'a mut Callback<'b>,
    ) -> Self {
        Self {
            backend,
            progress,
            final_decay,
            total: plan.iter().map(|stage| stage.steps).sum(),
            clock: Clock::new(plan),
            log: Log::default(),
            cut: None,
            pending: checkpoint.as_mut().and_then(Open::open),
            checkpoint,
            lap: Instant::now(),
            earlier: 0.0,
        }
    }

    /// Returns the value of the next stage of the plan: the stored one, or the result of `make`, which gets the stage's
    /// name.
    pub fn stage<T: Serialize + DeserializeOwned>(
        &mut self,
        name: &str,
        make: impl FnOnce(&mut Self, &str) -> Result<T, SolveError>,
    ) -> Result<T, SolveError> {
        let stored = self.checkpoint.as_mut().and_then(|checkpoint| checkpoint.stored(name));
        if let Some((log, value)) = stored {
            self.log = log;
            self.clock.skip();
            self.lap = Instant::now();
            return Ok(value);
        }
        let value = make(self, name)?;
        self.clock.next();
        if let Some(checkpoint) = self.checkpoint.as_mut().filter(|_| self.cut.is_none()) {
            checkpoint.store(name, &self.log, &value);
        }
        Ok(value)
    }

    /// [`Run::stage`] that `make` begins from a value, which is the result after an interrupt.
    pub fn stage_from<T: Serialize + DeserializeOwned>(
        &mut self,
        name: &str,
        start: T,
        make: impl FnOnce(&mut Self, &str, T) -> Result<T, SolveError>,
    ) -> Result<T, SolveError> {
        self.stage(name, |run, name| match run.is_interrupted() {
            true => Ok(start),
            false => make(run, name, start),
        })
    }

    /// Whether the caller has interrupted the solve. After that no fit takes steps.
    pub fn is_interrupted(&self) -> bool {
        self.cut.is_some()
    }

    /// The stage and step at which the caller interrupted the solve, as text.
    pub fn interrupted(&self) -> Option<String> {
        self.cut.as_ref().map(ToString::to_string)
    }

    /// The losses of all fits, and the wall times.
    pub fn into_log(self) -> (Vec<StageRecord>, Timing) {
        let seconds = self.log.seconds.into_iter().map(|(what, seconds)| (what, seconds.into()));
        (self.log.stages, Timing { seconds: seconds.collect() })
    }

    /// Records the seconds since the last record under a name.
    pub fn record_time(&mut self, what: &str) {
        let now = Instant::now();
        let seconds = self.earlier + now.duration_since(self.lap).as_secs_f64();
        (self.lap, self.earlier) = (now, 0.0);
        match self.log.seconds.iter_mut().find(|(name, _)| name == what) {
            Some((_, sum)) => *sum += seconds,
            None => self.log.seconds.push((what.to_owned(), seconds)),
        }
    }

    /// Takes the steps of a fit and records its losses under its name. Does nothing after an interrupt.
    pub fn fit(&mut self, name: &str, fit: &mut dyn Fit) -> Result<(), SolveError> {
        self.continue_fit(name, fit, vec![])
    }

    /// [`Run::fit`] of a fit that has already taken steps with these losses.
    pub fn continue_fit(
        &mut self,
        name: &str,
        fit: &mut dyn Fit,
        mut losses: Vec<f64>,
    ) -> Result<(), SolveError> {
        if self.is_interrupted() {
            return Ok(());
        }
        losses.append(&mut self.steps(name, fit)?);
        self.record_time(name);
        self.log.stages.push(StageRecord { name: name.to_owned(), loss: losses });
        Ok(())
    }

    /// Takes the steps of a fit without recording them, and returns their losses. Does nothing after an interrupt.
    pub fn unrecorded_fit(
        &mut self,
        name: &str,
        fit: &mut dyn Fit,
    ) -> Result<Vec<f64>, SolveError> {
        let losses = if self.is_interrupted() { vec![] } else { self.steps(name, fit)? };
        self.record_time("starts");
        Ok(losses)
    }

    /// Reports and records the steps of a solver with its own loop, `steps` at most. An interrupt reaches the solver as
    /// [`SolveError::Interrupted`] from a step.
    pub fn foreign_steps<T>(
        &mut self,
        name: &str,
        steps: usize,
        solve: impl FnOnce(&mut dyn FnMut(f64) -> Result<(), SolveError>) -> Result<T, SolveError>,
    ) -> Result<T, SolveError> {
        let mut losses = vec![];
        let value = solve(&mut |loss| {
            losses.push(loss);
            finite(name, losses.len(), &[loss])?;
            self.report(name, losses.len(), steps, &[loss]);
            if self.is_interrupted() { Err(SolveError::Interrupted) } else { Ok(()) }
        })?;
        self.record_time(name);
        self.log.skipped += steps.saturating_sub(losses.len());
        self.log.stages.push(StageRecord { name: name.to_owned(), loss: losses });
        Ok(value)
    }

    fn steps(&mut self, name: &str, fit: &mut dyn Fit) -> Result<Vec<f64>, SolveError> {
        let of = fit.iterations();
        let mut losses = self.restore(name, fit);
        let mut device = self.upload(name, fit);
        // The number of steps in the host's copy of the device's variables, and the time of that copy.
        let (mut known, mut fetched) = (losses.len(), Instant::now());
        let mut pace = Pace::default();
        while losses.len() < of && self.cut.is_none() && !fit.is_converged() {
            let first = losses.len() + 1;
            let decay = |step: usize| decay(self.final_decay, step, of);
            let batch = match &mut device {
                None => Ok(vec![fit.step(self.backend, decay(first))]),
                Some(program) => {
                    let last = of.min(losses.len() + pace.steps());
                    let rate_factors: Vec<f32> = (first..=last).map(decay).collect();
                    pace.time(rate_factors.len(), || program.steps(&rate_factors))
                }
            };
            let Ok(batch) = batch else {
                device = None;
                self.mark_failed(name, known, &mut losses);
                continue;
            };
            finite(name, first, &batch)?;
            losses.extend_from_slice(&batch);
            self.report(name, losses.len(), of, &batch);
            if let Some(program) = &mut device {
                let over = losses.len() == of || self.cut.is_some();
                if !over && fetched.elapsed() < FETCH {
                    continue;
                }
                if program.download(&mut fit.variables()).is_err() {
                    device = None;
                    self.mark_failed(name, known, &mut losses);
                    continue;
                }
                (known, fetched) = (losses.len(), Instant::now());
            }
            self.store_fit(name, &losses, fit);
        }
        if self.cut.is_none() {
            self.log.skipped += of - losses.len();
        }
        Ok(losses)
    }

    /// Uploads the fit to the device, if the device has a program for it.
    fn upload(&self, name: &str, fit: &mut dyn Fit) -> Option<Box<dyn Resident + 'a>> {
        let mut program = self.backend.resident(&fit.job()?)?;
        match program.upload(&fit.variables()) {
            Ok(()) => Some(program),
            Err(_) => {
                tracing::info!("{name}: does not fit on the device");
                None
            }
        }
    }

    /// Returns to the host's copy of a fit whose device failed. The device has logged the reason.
    fn mark_failed(&mut self, name: &str, known: usize, losses: &mut Vec<f64>) {
        tracing::info!("{name}: resuming after step {known}");
        self.log.done -= losses.len() - known;
        losses.truncate(known);
        self.cut = None;
    }

    /// Reports steps to the caller, the last of which is `step`, and records an interrupt.
    fn report(&mut self, stage: &str, step: usize, of: usize, losses: &[f64]) {
        self.log.done += losses.len();
        let mut seconds_left = 0.0;
        losses.iter().for_each(|_| seconds_left = self.clock.tick());
        let progress = Progress {
            stage,
            step,
            steps: of,
            iteration: self.log.done,
            total: self.total - self.log.skipped,
            loss: losses.last().copied().unwrap_or_default(),
            seconds_left,
        };
        if (self.progress)(&progress).is_break() {
            self.cut = Some(Cut { stage: stage.to_owned(), step, of });
        }
    }

    /// Restores a fit from the checkpoint, and returns its losses so far.
    fn restore(&mut self, name: &str, fit: &mut dyn Fit) -> Vec<f64> {
        let Some(memory) = self.pending.take_if(|memory| memory.name == name) else {
            return vec![];
        };
        let seconds = memory.seconds;
        let Some(losses) = memory.restore(fit) else { return vec![] };
        self.log.done += losses.len();
        self.clock.skip_steps(losses.len());
        self.earlier = seconds;
        losses
    }

    /// Stores a fit between two steps, if it is time for a checkpoint.
    fn store_fit(&mut self, name: &str, losses: &[f64], fit: &mut dyn Fit) {
        let Some(checkpoint) = &mut self.checkpoint else { return };
        if self.cut.is_some() || checkpoint.is_due() {
            let seconds = self.earlier + self.lap.elapsed().as_secs_f64();
            checkpoint.store_fit(name, losses, seconds, fit);
        }
    }
}

/// Refuses losses that are not finite. The first loss belongs to step `first`.
fn finite(name: &str, first: usize, losses: &[f64]) -> Result<(), SolveError> {
    match losses.iter().position(|loss| !loss.is_finite()) {
        None => Ok(()),
        Some(at) => Err(SolveError::NotFinite {
            stage: name.to_owned(),
            iteration: first + at,
            loss: losses[at],
        }),
    }
}

/// The number of steps of a submission.
#[derive(Default)]
struct Pace {
    seconds_per_step: Option<f64>,
}

impl Pace {
    fn steps(&self) -> usize {
        // The first submission is one step, which measures the time of a step.
        self.seconds_per_step
            .map_or(1, |s| ((SUBMISSION.as_secs_f64() / s) as usize).clamp(1, BATCH))
    }

    fn time<T>(
        &mut self,
        steps: usize,
        work: impl FnOnce() -> Result<T, DeviceError>,
    ) -> Result<T, DeviceError> {
        let start = Instant::now();
        let done = work();
        self.seconds_per_step = Some(start.elapsed().as_secs_f64() / steps as f64);
        done
    }
}

/// The factor on the learning rates: 1 at first, then falling geometrically to `last` over the final 40 % of a fit.
fn decay(last: f32, iteration: usize, iterations: usize) -> f32 {
    let progress = iteration as f32 / iterations as f32;
    last.powf(((progress - 0.6) / 0.4).max(0.0))
}
