//! The bookkeeping of a solve: progress, losses, times, interrupts, checkpoints.

use std::time::{Duration, Instant};

use super::checkpoint::{Open, StageMemory};
use super::clock::{Clock, Work};
use super::error::SolveError;
use super::found::Solve;
use super::log::{Cut, Log};
use super::progress::{Callback, Progress};
use super::stage::{Stage, State};
use crate::backend::Backend;
use crate::backend::resident::{BATCH, DeviceError, Resident};
use crate::config::Config;
use crate::solution::{StageRecord, Timing};

/// Between two copies of what a device moves: a failure costs no more than that.
const FETCH: Duration = Duration::from_secs(20);
/// A submission takes about this long: systems reset a device that does not answer for seconds.
const SUBMISSION: Duration = Duration::from_millis(200);

/// Runs stages, and keeps the books of a solve.
pub(super) struct StageRunner<'a, 'b> {
    pub backend: &'a dyn Backend,
    progress: &'a mut Callback<'b>,
    final_decay: f32,
    total: usize,
    clock: Clock,
    log: Log,
    cut: Option<Cut>,
    checkpoint: Option<Open>,
    /// The stage that a checkpoint was kept of, until it goes on.
    pending: Option<StageMemory>,
    lap: Instant,
    /// Seconds of this lap before the checkpoint that the run goes on from.
    earlier: f64,
}

impl<'a, 'b> StageRunner<'a, 'b> {
    /// For the parts `work`.
    pub fn new(
        config: &Config,
        work: Vec<Work>,
        backend: &'a dyn Backend,
        progress: &'a mut Callback<'b>,
    ) -> Self {
        Self {
            backend,
            progress,
            final_decay: config.adam.final_decay,
            total: work.iter().map(|part| part.steps).sum(),
            clock: Clock::new(work),
            log: Log::default(),
            cut: None,
            checkpoint: None,
            pending: None,
            lap: Instant::now(),
            earlier: 0.0,
        }
    }

    /// Where the caller stopped the solve, if he did: then no stage has any steps left.
    pub fn cut(&self) -> Option<&Cut> {
        self.cut.as_ref()
    }

    /// The log, and the wall times.
    pub fn into_log(self) -> (Vec<StageRecord>, Timing) {
        let seconds = self.log.seconds.into_iter().map(|(what, seconds)| (what, seconds.into()));
        (self.log.stages, Timing { seconds: seconds.collect() })
    }

    /// State that an earlier run left in its checkpoint, if any; from here on this run keeps it.
    pub fn resume(&mut self, mut checkpoint: Open) -> Option<Solve> {
        let kept = checkpoint.read();
        self.checkpoint = Some(checkpoint);
        let (log, solve, stage) = kept?;
        self.clock.skip_parts(solve.finished);
        self.log = log;
        self.pending = stage;
        Some(solve)
    }

    /// The next part begins.
    pub fn next_part(&mut self) {
        self.clock.next();
    }

    /// Keeps what has been found at the end of a step.
    pub fn save(&mut self, solve: &Solve) {
        if let Some(checkpoint) = &mut self.checkpoint {
            checkpoint.save(&self.log, solve);
        }
    }

    /// Notes the seconds since the last lap.
    pub fn lap(&mut self, what: &str) {
        let now = Instant::now();
        let seconds = self.earlier + now.duration_since(self.lap).as_secs_f64();
        (self.lap, self.earlier) = (now, 0.0);
        match self.log.seconds.iter_mut().find(|(name, _)| name == what) {
            Some((_, sum)) => *sum += seconds,
            None => self.log.seconds.push((what.to_owned(), seconds)),
        }
    }

    /// The height solve with its progress, `of` steps at most; it hears of an interrupt as an error
    /// of its steps.
    pub fn heights(
        &mut self,
        of: usize,
        solve: impl FnOnce(
            &mut dyn FnMut(f64) -> Result<(), SolveError>,
        ) -> Result<Vec<f32>, SolveError>,
    ) -> Result<Vec<f32>, SolveError> {
        let name = "heights";
        let mut losses = vec![];
        let deviation = solve(&mut |loss| {
            losses.push(loss);
            if !loss.is_finite() {
                let (stage, iteration) = (name.to_owned(), losses.len());
                return Err(SolveError::NotFinite { stage, iteration, loss });
            }
            self.report(name, losses.len(), of, &[loss]);
            if self.cut.is_some() { Err(SolveError::Interrupted) } else { Ok(()) }
        })?;
        self.lap(name);
        self.spare(of.saturating_sub(losses.len()));
        self.log.stages.push(StageRecord { name: name.to_owned(), loss: losses });
        Ok(deviation)
    }

    /// Does a stage's steps.
    pub fn stage(&mut self, stage: &mut dyn Stage, state: &mut State) -> Result<(), SolveError> {
        if self.cut.is_some() {
            return Ok(());
        }
        let name = stage.name();
        let loss = self.steps(&name, stage, state)?;
        self.lap(&name);
        self.log.stages.push(StageRecord { name, loss });
        Ok(())
    }

    /// Steps turn out not to be needed.
    pub fn spare(&mut self, steps: usize) {
        self.log.spared += steps;
    }

    /// The last stage went on from these steps.
    pub fn began_with(&mut self, losses: Vec<f64>) {
        if let Some(last) = self.log.stages.last_mut() {
            last.loss.splice(0..0, losses);
        }
    }

    /// Does the steps of a start, which is no stage of the record, and returns the losses.
    pub fn trial(
        &mut self,
        name: &str,
        stage: &mut dyn Stage,
        state: &mut State,
    ) -> Result<Vec<f64>, SolveError> {
        let losses = self.steps(name, stage, state)?;
        self.lap("starts");
        Ok(losses)
    }

    fn steps(
        &mut self,
        name: &str,
        stage: &mut dyn Stage,
        state: &mut State,
    ) -> Result<Vec<f64>, SolveError> {
        let of = stage.iterations();
        let mut losses = self.recall(name, stage, state);
        let mut device = self.take_in(name, stage, state);
        // Steps that the host's copy of a device's values has seen, and when it was made.
        let (mut known, mut fetched) = (losses.len(), Instant::now());
        let mut pace = Pace::default();
        while losses.len() < of && self.cut.is_none() && !stage.is_over() {
            let first = losses.len() + 1;
            let decay = |step: usize| decay(self.final_decay, step, of);
            let batch = match &mut device {
                None => Ok(vec![stage.step(state, self.backend, decay(first))]),
                Some(program) => {
                    let last = of.min(losses.len() + pace.steps());
                    let rate_factors: Vec<f32> = (first..=last).map(decay).collect();
                    pace.time(rate_factors.len(), || program.steps(&rate_factors))
                }
            };
            let Ok(batch) = batch else {
                device = None;
                self.fall_back(name, known, &mut losses);
                continue;
            };
            if let Some(at) = batch.iter().position(|loss| !loss.is_finite()) {
                let stage = name.to_owned();
                return Err(SolveError::NotFinite {
                    stage,
                    iteration: first + at,
                    loss: batch[at],
                });
            }
            losses.extend_from_slice(&batch);
            self.report(name, losses.len(), of, &batch);
            if let Some(program) = &mut device {
                let over = losses.len() == of || self.cut.is_some();
                if !over && fetched.elapsed() < FETCH {
                    continue;
                }
                if program.download(&mut stage.variables(state)).is_err() {
                    device = None;
                    self.fall_back(name, known, &mut losses);
                    continue;
                }
                (known, fetched) = (losses.len(), Instant::now());
            }
            self.remember(name, &losses, stage, state);
        }
        if self.cut.is_none() {
            self.spare(of - losses.len());
        }
        Ok(losses)
    }

    /// The stage as a program of the device, if it has one for it.
    fn take_in(
        &self,
        name: &str,
        stage: &mut dyn Stage,
        state: &mut State,
    ) -> Option<Box<dyn Resident + 'a>> {
        let mut program = self.backend.resident(&stage.job()?)?;
        match program.upload(&stage.variables(state)) {
            Ok(()) => Some(program),
            Err(_) => {
                tracing::info!("{name}: does not fit on the device");
                None
            }
        }
    }

    /// Goes back to what the host has seen of a stage whose device failed. The device has said why.
    fn fall_back(&mut self, name: &str, known: usize, losses: &mut Vec<f64>) {
        tracing::info!("{name}: resuming after step {known}");
        self.log.done -= losses.len() - known;
        losses.truncate(known);
        self.cut = None;
    }

    /// Tells the caller of steps, of which `step` was the last, and hears whether to go on.
    fn report(&mut self, stage: &str, step: usize, of: usize, losses: &[f64]) {
        self.log.done += losses.len();
        let mut seconds_left = 0.0;
        losses.iter().for_each(|_| seconds_left = self.clock.tick());
        let progress = Progress {
            stage,
            step,
            steps: of,
            iteration: self.log.done,
            total: self.total - self.log.spared,
            loss: losses.last().copied().unwrap_or_default(),
            seconds_left,
        };
        if (self.progress)(&progress).is_break() {
            self.cut = Some(Cut { stage: stage.to_owned(), step, of });
        }
    }

    /// Brings a stage to where a checkpoint left it; the losses until there.
    fn recall(&mut self, name: &str, stage: &mut dyn Stage, state: &mut State) -> Vec<f64> {
        let Some(memory) = self.pending.take_if(|memory| memory.name == name) else {
            return vec![];
        };
        let seconds = memory.seconds;
        let Some(losses) = memory.restore(stage, state) else { return vec![] };
        self.log.done += losses.len();
        self.clock.skip_steps(losses.len());
        self.earlier = seconds;
        losses
    }

    /// Keeps a checkpoint within a stage, if it is time for one.
    fn remember(&mut self, name: &str, losses: &[f64], stage: &mut dyn Stage, state: &State) {
        let Some(checkpoint) = &mut self.checkpoint else { return };
        if self.cut.is_some() || checkpoint.is_due() {
            let seconds = self.earlier + self.lap.elapsed().as_secs_f64();
            checkpoint.save_stage(name, losses, seconds, stage, state);
        }
    }
}

/// How many steps make a submission.
#[derive(Default)]
struct Pace {
    seconds_per_step: Option<f64>,
}

impl Pace {
    fn steps(&self) -> usize {
        // The first step alone shows how long one takes.
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

/// The share of the learning rate: whole at first, then falling geometrically to `last` over the
/// final 40 % of a stage.
fn decay(last: f32, iteration: usize, iterations: usize) -> f32 {
    let progress = iteration as f32 / iterations as f32;
    last.powf(((progress - 0.6) / 0.4).max(0.0))
}
