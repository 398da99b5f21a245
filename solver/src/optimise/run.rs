//! The bookkeeping of a solve: progress, losses, times, interruption.

use std::ops::ControlFlow;
use std::time::Instant;

use super::solve::{Callback, Progress};
use super::stage::{Stage, State, WarmUp};
use crate::backend::Backend;
use crate::config::Config;
use crate::error::SolveError;
use crate::model::networks::Networks;
use crate::model::samples::Samples;
use crate::solution::{StageRecord, Timing};

/// The bookkeeping of a solve.
pub(super) struct Run<'a, 'b> {
    pub backend: &'a dyn Backend,
    progress: &'a mut Callback<'b>,
    final_share: f32,
    done: usize,
    total: usize,
    pub stages: Vec<StageRecord>,
    pub timing: Timing,
    lap: Instant,
}

impl<'a, 'b> Run<'a, 'b> {
    pub fn new(config: &Config, backend: &'a dyn Backend, progress: &'a mut Callback<'b>) -> Self {
        let (fine, first) = (&config.fine_tuning, &config.initialisation);
        let (t, h) = (&config.transport, &config.height);
        let trials = if first.starts > 1 { first.starts * first.start_iterations } else { 0 };
        Self {
            backend,
            progress,
            final_share: config.adam.final_share,
            done: 0,
            total: trials
                + config.warm_up.iterations
                + 2 * fine.rounds * fine.iterations
                + if t.enabled { t.probe + t.iterations + t.refinement } else { 0 }
                + if h.enabled { h.linearisations * h.reweightings * h.steps } else { 0 },
            stages: vec![],
            timing: Timing::default(),
            lap: Instant::now(),
        }
    }

    pub fn lap(&mut self, what: &str) {
        let now = Instant::now();
        let seconds = now.duration_since(self.lap).as_secs_f64();
        self.timing.seconds.insert(what.to_owned(), seconds.into());
        self.lap = now;
    }

    /// The initial weights from which a short warm-up comes furthest.
    pub fn best_start(
        &mut self,
        config: &Config,
        samples: &Samples,
        state: &State,
    ) -> Result<Networks, SolveError> {
        let first = &config.initialisation;
        let mut trial = config.clone();
        trial.warm_up.iterations = first.start_iterations;
        let mut best = (f64::INFINITY, state.networks.clone());
        for start in 0..if first.starts > 1 { first.starts } else { 0 } {
            let networks = Networks::new(&config.networks, config.seed + start as u64);
            let mut state = State { networks: networks.clone(), ..state.clone() };
            let mut warm_up = WarmUp::new(&trial, samples, &state);
            let losses = self.steps(&format!("start {}", start + 1), &mut warm_up, &mut state)?;
            let tail = &losses[losses.len() - losses.len().div_ceil(10)..];
            let loss = tail.iter().sum::<f64>() / tail.len() as f64;
            if loss < best.0 {
                best = (loss, networks);
            }
        }
        self.lap("starts");
        Ok(best.1)
    }

    /// The height solve with its progress.
    pub fn relief(
        &mut self,
        solve: impl FnOnce(
            &mut dyn FnMut(f64) -> Result<(), SolveError>,
        ) -> Result<Vec<f32>, SolveError>,
    ) -> Result<Vec<f32>, SolveError> {
        let mut losses = vec![];
        let bend = solve(&mut |loss| {
            losses.push(loss);
            self.done += 1;
            let (iteration, total) = (self.done, self.total);
            let progress = Progress { stage: "relief", iteration, total, loss };
            match (self.progress)(&progress) {
                ControlFlow::Continue(()) => Ok(()),
                ControlFlow::Break(()) => Err(SolveError::Interrupted),
            }
        })?;
        self.lap("relief");
        self.stages.push(StageRecord { name: "relief".to_owned(), loss: losses });
        Ok(bend)
    }

    pub fn stage(&mut self, stage: &mut dyn Stage, state: &mut State) -> Result<(), SolveError> {
        let name = stage.name();
        let loss = self.steps(&name, stage, state)?;
        self.lap(&name);
        self.stages.push(StageRecord { name, loss });
        Ok(())
    }

    /// Does a stage's steps and returns the losses.
    fn steps(
        &mut self,
        name: &str,
        stage: &mut dyn Stage,
        state: &mut State,
    ) -> Result<Vec<f64>, SolveError> {
        let iterations = stage.iterations();
        let mut losses = Vec::with_capacity(iterations);
        for iteration in 1..=iterations {
            let share = share(self.final_share, iteration, iterations);
            let loss = stage.step(state, self.backend, share);
            if !loss.is_finite() {
                return Err(SolveError::NotFinite { stage: name.to_owned(), iteration, loss });
            }
            losses.push(loss);
            self.done += 1;
            let (iteration, total) = (self.done, self.total);
            let progress = Progress { stage: name, iteration, total, loss };
            if (self.progress)(&progress).is_break() {
                return Err(SolveError::Interrupted);
            }
        }
        Ok(losses)
    }
}

/// The share of the learning rate: whole at first, then falling geometrically to `last` over the
/// final 40 % of a stage.
fn share(last: f32, iteration: usize, iterations: usize) -> f32 {
    let progress = iteration as f32 / iterations as f32;
    last.powf(((progress - 0.6) / 0.4).max(0.0))
}
