//! Short warm-ups from the networks of several seeds, because about every other one never learns the
//! highlights. The warm-up goes on with the one that has come furthest; half of them are given up
//! halfway.

use std::mem;

use serde::{Deserialize, Serialize};

use super::adam::Adam;
use super::run::Run;
use super::site::Site;
use super::solve::Solve;
use super::stage::{Stage, State, WarmUp};
use crate::config::Config;
use crate::error::SolveError;
use crate::model::networks::Networks;

/// The short warm-up of one seed.
#[derive(Serialize, Deserialize)]
pub(super) struct Start {
    number: usize,
    pub losses: Vec<f64>,
    pub state: State,
    pub optimisers: Vec<Adam>,
}

impl Start {
    /// How far it has come: the mean of the last tenth of its losses.
    fn loss(&self) -> f64 {
        let tail = &self.losses[self.losses.len() - self.losses.len().div_ceil(10)..];
        tail.iter().sum::<f64>() / tail.len() as f64
    }

    /// Goes on to step `until`.
    fn advance(&mut self, until: usize, site: &Site, run: &mut Run) -> Result<(), SolveError> {
        let mut config = site.config.clone();
        config.warm_up.iterations = config.initialisation.start_iterations;
        let mut stage = WarmUp::new(&config, site.coarse(), &self.state);
        put_back(&mut stage, mem::take(&mut self.optimisers));
        let name = format!("start {}", self.number + 1);
        run.trial(&name, &mut stage, &mut self.state, &mut self.losses, until)?;
        self.optimisers = stage.memory().optimisers.into_iter().map(|adam| adam.clone()).collect();
        Ok(())
    }
}

/// Begins with the networks of one seed; after the last of them the worse half is given up.
pub(super) fn first_half(
    number: usize,
    site: &Site,
    run: &mut Run,
    solve: &mut Solve,
) -> Result<(), SolveError> {
    let config = site.config;
    let networks = Networks::new(&config.networks, config.seed + number as u64);
    let state = State { networks, ..solve.initial.clone() };
    let mut start = Start { number, losses: vec![], state, optimisers: vec![] };
    start.advance(halfway(config), site, run)?;
    if run.cut().is_some() {
        solve.state = start.state;
        return Ok(());
    }
    solve.starts.push(start);
    if solve.starts.len() == config.initialisation.starts {
        solve.starts.sort_by(|a, b| a.loss().total_cmp(&b.loss()));
        solve.starts.truncate(finalists(config.initialisation.starts));
    }
    Ok(())
}

/// Goes on with one of those that are left.
pub(super) fn second_half(
    place: usize,
    site: &Site,
    run: &mut Run,
    solve: &mut Solve,
) -> Result<(), SolveError> {
    let start = &mut solve.starts[place];
    start.advance(site.config.initialisation.start_iterations, site, run)?;
    if run.cut().is_some() {
        solve.state = start.state.clone();
    }
    Ok(())
}

/// What has come furthest.
pub(super) fn best(starts: Vec<Start>) -> Option<Start> {
    starts.into_iter().min_by(|a, b| a.loss().total_cmp(&b.loss()))
}

/// Steps of every start until the worse half is given up.
pub(super) fn halfway(config: &Config) -> usize {
    config.initialisation.start_iterations.div_ceil(2)
}

/// How many go on then.
pub(super) fn finalists(starts: usize) -> usize {
    starts.div_ceil(2)
}

/// Lets a stage go on with the optimisers that an earlier one had, if there was one.
pub(super) fn put_back(stage: &mut dyn Stage, optimisers: Vec<Adam>) {
    stage.memory().optimisers.into_iter().zip(optimisers).for_each(|(place, kept)| *place = kept);
}
