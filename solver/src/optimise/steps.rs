//! The steps of a solve: which there are, what they cost, and what each does.

use super::clock::{Extent, Work};
use super::context::SolveContext;
use super::diffuse::Diffuse;
use super::distance::{distance, distance_steps};
use super::error::SolveError;
use super::found::{Solve, Start};
use super::heights;
use super::highlights::highlights;
use super::normals::Normals;
use super::refinement::refinement;
use super::snapshot::{Snapshot, Unit};
use super::specular::Specular;
use super::specular_floor;
use super::stage::{Stage, State};
use super::stage_runner::StageRunner;
use super::transported::{light, light_and_albedo};
use super::warm_up::WarmUp;
use crate::config::Config;
use crate::model::networks::Networks;

/// A step of a solve; a checkpoint is kept after each of them.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// A short warm-up from the networks of one seed.
    Start(usize),
    WarmUp,
    /// The light under the semantic colours.
    Light,
    /// The light under the semantic colours, its distance, and the highlights that it makes itself.
    Distance(usize),
    /// Light and albedo under explicit transport.
    Transport,
    /// Light and albedo under explicit transport, with the highlights that the light itself makes.
    Highlights,
    /// Normals from heights.
    Heights,
    /// Specular albedo and, without heights, normals.
    NormalsAndSpecular(usize),
    Diffuse(usize),
    /// The transported albedo on the full pictures.
    Albedo,
}

impl Step {
    /// The steps in their order.
    pub fn all(config: &Config) -> Vec<Self> {
        let starts = match config.initialisation.starts {
            0 | 1 => 0,
            starts => starts,
        };
        let mut steps: Vec<Self> = (0..starts).map(Self::Start).collect();
        steps.push(Self::WarmUp);
        if config.transport.enabled {
            let wanted = |steps: usize| steps > 0 && specular_floor::wanted(config);
            steps.push(Self::Light);
            let rounds = 1..=config.reflectance.rounds();
            let rounds = rounds.filter(|_| wanted(config.transport.distance));
            steps.extend(rounds.map(Self::Distance));
            steps.push(Self::Transport);
            steps.extend(wanted(config.transport.highlights).then_some(Self::Highlights));
        }
        if config.height.enabled {
            steps.push(Self::Heights);
        }
        for round in 1..=config.fine_tuning.rounds {
            steps.extend([Self::NormalsAndSpecular(round), Self::Diffuse(round)]);
        }
        if config.transport.enabled {
            steps.push(Self::Albedo);
        }
        steps
    }

    /// How often it reports progress.
    fn iterations(&self, config: &Config, extent: &Extent) -> usize {
        match self {
            Self::Start(_) => config.initialisation.start_iterations,
            // The best start's steps are done.
            Self::WarmUp => match config.initialisation.starts {
                0 | 1 => config.warm_up.iterations,
                _ => {
                    config.warm_up.iterations.saturating_sub(config.initialisation.start_iterations)
                }
            },
            Self::Light => config.transport.probe,
            Self::Transport => config.transport.iterations,
            Self::Distance(round) => distance_steps(config, *round),
            Self::Highlights => config.transport.highlights,
            Self::Heights => heights::steps(&config.height, extent.texture_size, extent.views),
            Self::NormalsAndSpecular(_) | Self::Diffuse(_) => config.fine_tuning.iterations,
            Self::Albedo => config.transport.refinement,
        }
    }

    /// Its cost, measured on two cores with AVX-512; see [`super::clock`].
    pub fn work(&self, config: &Config, extent: &Extent) -> Work {
        let square = |side: usize| (side * side) as f64;
        let pixels = extent.pixels as f64;
        let few = if config.warm_up.half_resolution { 0.25 * pixels } else { pixels };
        let work = |sample: f64, samples: f64, texel: f64, texels: f64| Work {
            preparation: 0.0,
            step: 1e-9 * (sample * samples + texel * texels),
            steps: self.iterations(config, extent),
        };
        let t = &config.transport;
        match self {
            Self::Start(_) | Self::WarmUp => {
                work(73.0, few, 67.0, square(config.warm_up.texture_size))
            }
            Self::Light | Self::Transport => {
                let entries = square(t.texture_size) * (2 * t.rows * t.rows) as f64;
                let rays = entries * square(t.rays_per_cell_side);
                Work { preparation: 45e-9 * rays, ..work(100.0, few, 0.4, entries) }
            }
            Self::Distance(_) | Self::Highlights => {
                let cells = (2 * t.rows * t.rows) as f64;
                let entries = cells * few.min(t.highlight_samples as f64);
                let texels = cells * square(t.texture_size);
                Work { preparation: 25e-9 * entries, ..work(0.4, entries, 0.1, texels) }
            }
            Self::Heights => {
                let share = f64::from(config.height.texture_scale);
                work(25.0, pixels, 15.0, share * share * square(extent.texture_size))
            }
            // Without a network where the normals stay.
            Self::NormalsAndSpecular(_) if config.fine_tuning.deviation_rate == 0.0 => {
                work(4.0, pixels, 3.0, square(extent.texture_size))
            }
            Self::NormalsAndSpecular(_) => work(60.0, pixels, 25.0, square(extent.texture_size)),
            Self::Diffuse(_) | Self::Albedo => work(6.0, pixels, 6.0, square(extent.texture_size)),
        }
    }

    /// Takes the step. After an interrupt it leaves in `solve` what it has found until then.
    pub fn take(
        &self,
        context: &mut SolveContext,
        runner: &mut StageRunner,
        solve: &mut Solve,
    ) -> Result<(), SolveError> {
        if !matches!(self, Self::Start(_) | Self::WarmUp) {
            context.drop_coarse();
        }
        if !matches!(self, Self::Light | Self::Distance(_)) {
            context.drop_far();
        }
        let coarse =
            matches!(self, Self::Light | Self::Distance(_) | Self::Transport | Self::Highlights);
        if !coarse && !matches!(self, Self::Start(_) | Self::WarmUp) {
            context.drop_pictures();
        }
        let (config, backend) = (context.config, context.backend);
        match self {
            Self::Start(number) => start(*number, context, runner, solve)?,
            Self::WarmUp => {
                let mut config = config.clone();
                config.warm_up.iterations = self.iterations(&config, &context.extent());
                let best = solve.best.take();
                if let Some(best) = &best {
                    solve.state = best.state.clone();
                }
                let mut stage = WarmUp::new(&config, context.coarse(), &solve.state);
                let mut losses = vec![];
                if let Some(best) = best {
                    let places = stage.memory().optimisers.into_iter();
                    places.zip(best.optimisers).for_each(|(place, kept)| *place = kept);
                    losses = best.losses;
                }
                runner.stage(&mut stage, &mut solve.state)?;
                runner.began_with(losses);
            }
            Self::Light => {
                let start =
                    State { networks: solve.state.networks.clone(), ..solve.initial.clone() };
                solve.light_estimate = Some(light(runner, context, start)?);
            }
            Self::Transport => {
                let Some(light_estimate) = solve.light_estimate.take() else { return Ok(()) };
                let lighting =
                    light_and_albedo(runner, context, solve.initial.clone(), light_estimate)?;
                // Before the albedo moves there is nothing of use: the networks' is better.
                let begun = config.transport.albedo_frozen_steps;
                let moved =
                    runner.cut().is_none_or(|cut| cut.stage == "transport" && cut.step > begun);
                solve.lighting = moved.then_some(lighting);
            }
            Self::Distance(round) => {
                if let Some(light_estimate) = &mut solve.light_estimate {
                    let spared =
                        distance(runner, context, solve.initial.clone(), light_estimate, *round)?;
                    runner.spare(spared);
                }
            }
            Self::Highlights => {
                if let Some(lighting) = &mut solve.lighting {
                    let spared = highlights(runner, context, lighting)?;
                    runner.spare(spared);
                }
            }
            Self::Heights => {
                let (steps, lighting) =
                    (self.iterations(config, &context.extent()), solve.lighting.as_ref());
                let found = runner.heights(steps, |step| {
                    heights::heights(context, &solve.state, lighting, step)
                })?;
                solve.state.resize(context.size);
                solve.state.deviation = found;
            }
            Self::NormalsAndSpecular(round) => {
                solve.state.resize(context.size);
                let (fine, state) = (context.fine(), &solve.state);
                let (samples, deviation) = (&fine.samples, &fine.deviation);
                let mut stage: Box<dyn Stage> = match config.fine_tuning.deviation_rate {
                    0.0 => {
                        Box::new(Specular::new(config, samples, deviation, state, backend, *round))
                    }
                    _ => Box::new(Normals::new(config, samples, deviation, state, backend, *round)),
                };
                runner.stage(&mut *stage, &mut solve.state)?;
            }
            Self::Diffuse(round) => {
                let (fine, state) = (context.fine(), &solve.state);
                let mut stage =
                    Diffuse::new(config, &fine.samples, &fine.deviation, state, backend, *round);
                runner.stage(&mut stage, &mut solve.state)?;
            }
            Self::Albedo => refinement(context, runner, solve)?,
        }
        Ok(())
    }
}

impl Step {
    /// The textures that the step has changed, for the record.
    pub fn snapshot(&self, context: &SolveContext, solve: &Solve) -> Option<Snapshot> {
        let State { size, diffuse, specular, deviation, .. } = &solve.state;
        let sharp = || context.fine().deviation.textures(deviation).sharp;
        match self {
            Self::Start(_) | Self::Light | Self::Distance(_) => None,
            Self::WarmUp => {
                let new = Snapshot::new("warm-up", Unit::Networks);
                Some(new.diffuse(diffuse, *size).specular(specular, *size))
            }
            Self::Transport | Self::Highlights => {
                let lighting = &solve.lighting.as_ref()?.state;
                let name = if matches!(self, Self::Transport) { "transport" } else { "highlights" };
                Some(Snapshot::new(name, Unit::Transport).diffuse(&lighting.diffuse, lighting.size))
            }
            Self::Heights => {
                Some(Snapshot::new("heights", Unit::Networks).deviation(&sharp(), *size))
            }
            Self::NormalsAndSpecular(round) => {
                let still = context.config.fine_tuning.deviation_rate == 0.0;
                let moved = if still { "specular" } else { "normals and specular" };
                let stage = format!("{moved} {round}");
                let new = Snapshot::new(&stage, Unit::Networks).specular(specular, *size);
                Some(if still { new } else { new.deviation(&sharp(), *size) })
            }
            Self::Diffuse(round) => {
                let stage = format!("diffuse {round}");
                Some(Snapshot::new(&stage, Unit::Networks).diffuse(diffuse, *size))
            }
            Self::Albedo => {
                let diffuse_reflectance = &solve.diffuse_reflectance.as_ref()?.diffuse;
                Some(Snapshot::new("albedo", Unit::Transport).diffuse(diffuse_reflectance, *size))
            }
        }
    }
}

/// Warms up the networks of one seed; what has come furthest is kept.
fn start(
    number: usize,
    context: &SolveContext,
    runner: &mut StageRunner,
    solve: &mut Solve,
) -> Result<(), SolveError> {
    let mut config = context.config.clone();
    config.warm_up.iterations = config.initialisation.start_iterations;
    let networks = Networks::new(&config.networks, config.seed + number as u64);
    let mut state = State { networks, ..solve.initial.clone() };
    let mut stage = WarmUp::new(&config, context.coarse(), &state);
    let losses = runner.trial(&format!("start {}", number + 1), &mut stage, &mut state)?;
    let optimisers = stage.memory().optimisers.into_iter().map(|adam| adam.clone()).collect();
    if runner.cut().is_some() {
        solve.state = state;
        return Ok(());
    }
    let start = Start { losses, state, optimisers };
    if solve.best.as_ref().is_none_or(|best| start.loss() < best.loss()) {
        solve.best = Some(start);
    }
    Ok(())
}
