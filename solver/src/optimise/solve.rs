//! The order of the steps, from a capture to a solution.

use std::ops::ControlFlow;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::adam::Adam;
use super::checkpoint::Checkpoint;
use super::clock::Work;
use super::deviation::Relief;
use super::diffuse::Diffuse;
use super::finish::{finish, finishing};
use super::heights;
use super::highlights::{MOST_SAMPLES, distance, highlights};
use super::lit::Lit;
use super::run::Run;
use super::site::{Site, map_size, texture_size};
use super::snapshot::{Snapshot, Unit};
use super::specular::Specular;
use super::stage::{Stage, State};
use super::transported::{Physical, Probed, light, light_and_albedo, refined};
use super::veil;
use super::warm_up::WarmUp;
use crate::atomic::{self, Folder};
use crate::backend::Backend;
use crate::capture::{Camera, Capture};
use crate::config::Config;
use crate::error::{CaptureError, MapsError, SolveError};
use crate::memory::{self, Estimate};
use crate::model::networks::Networks;
use crate::solution::{Solution, ViewLayers};

/// Where a solve stands.
#[derive(Clone, Debug)]
pub struct Progress<'a> {
    /// The stage at work.
    pub stage: &'a str,
    /// Steps done of the stage.
    pub step: usize,
    /// Steps of the stage.
    pub steps: usize,
    /// Steps done over all stages.
    pub iteration: usize,
    /// Steps of all stages; fewer from where the light proves to need no further rounds.
    pub total: usize,
    /// The loss before the last step.
    pub loss: f64,
    /// Seconds until the maps are there, as far as one can tell.
    pub seconds_left: f64,
}

pub(super) type Callback<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + 'a;

/// Takes the layers of a training view.
pub type LayerSink<'a> = dyn FnMut(&ViewLayers) -> Result<(), MapsError> + 'a;

/// How a solve is run. Nothing in it changes a map.
#[derive(Default)]
pub struct Options<'a> {
    /// Where to keep what is needed to go on after an interrupt or a fall.
    pub checkpoint: Option<Checkpoint>,
    /// Takes the layers of the training views one after the other, if the configuration wants them:
    /// of many large views, memory has no room.
    pub layers: Option<&'a mut LayerSink<'a>>,
}

/// [`solve_on`] into the folder `maps`, with a checkpoint beside it (`<maps>.checkpoint`) from which
/// the same call goes on after an interrupt, to the same bytes. `program` tells apart programs that
/// would not: a checkpoint of another one is not used, nor of another backend.
pub fn solve_into(
    backend: &dyn Backend,
    maps: &Path,
    program: &str,
    capture: &Capture,
    config: &Config,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    // Now, so that what cannot be written is known before the work.
    atomic::apart(maps, &[&capture.folder]).map_err(MapsError::from)?;
    atomic::require_space(maps, bytes_on_disk(capture, config)).map_err(MapsError::from)?;
    let folder = Folder::begin(maps).map_err(MapsError::from)?;
    let checkpoint = Checkpoint::beside(maps, program);
    let kept = checkpoint.folder().to_path_buf();
    let mut layers = |view: &ViewLayers| view.write_layers(folder.path());
    let options = Options { checkpoint: Some(checkpoint), layers: Some(&mut layers) };
    let solution = match solve_on(backend, capture, config, options, progress) {
        Ok(solution) => solution,
        Err(error) => {
            folder.abandon();
            return Err(error);
        }
    };
    solution.write_into(folder.path())?;
    folder.commit().map_err(MapsError::from)?;
    if solution.record.interrupted.is_none() {
        Checkpoint::remove(&kept);
    }
    Ok(solution)
}

/// About what a maps folder takes on the disk, uncompressed: maps of 11 channels, and nine for every
/// withheld view; of every training view as well, in halves, if its layers are kept.
fn bytes_on_disk(capture: &Capture, config: &Config) -> u64 {
    let pixels = |camera: &Camera| (camera.width * camera.height) as u64;
    let withheld: u64 = capture.withheld.iter().map(pixels).sum();
    let train: u64 = capture.train.iter().map(|view| pixels(&view.camera)).sum();
    let solved = texture_size(config.fine_tuning.texture_size, train as usize);
    let layers = if config.records.layers { train * 9 * 2 } else { 0 };
    let side = map_size(config.fine_tuning.texture_size, solved) as u64;
    side * side * 11 * 4 + withheld * 9 * 4 + layers
}

/// Decomposes a capture into maps. `progress` is called after every step (a device that takes in whole
/// stages: every submission) and may stop the solve, which then makes maps of what it has and says so
/// in [`crate::Record::interrupted`].
///
/// The same capture, configuration and backend give the same solution for any number of threads.
pub fn solve_on(
    backend: &dyn Backend,
    capture: &Capture,
    config: &Config,
    options: Options<'_>,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    config.validate()?;
    Estimate::new(capture, config).fits(memory::available())?;
    let _hoard = memory::Hoard::begin();
    let mut site = Site::new(backend, capture, config);
    let steps = Step::all(config);
    let mut work: Vec<Work> = steps.iter().map(|step| step.work(&site)).collect();
    work.push(finishing(&site));
    let mut run = Run::new(config, work, backend, progress);
    let checkpoint = options.checkpoint.map(|checkpoint| checkpoint.of(capture, config, backend));
    let mut solve = match checkpoint.and_then(|checkpoint| run.resume(checkpoint)) {
        Some(solve) => solve,
        None => {
            let solve = Solve::new(&site)?;
            run.lap("preparation");
            run.save(&solve);
            solve
        }
    };
    for step in &steps[solve.finished.min(steps.len())..] {
        step.take(&mut site, &mut run, &mut solve)?;
        if config.records.stages {
            solve.snapshots.extend(step.snapshot(&site, &solve));
        }
        if run.cut().is_some() {
            break;
        }
        solve.finished += 1;
        run.next_part();
        run.save(&solve);
    }
    finish(&site, run, solve, options.layers)
}

/// What a solve has found so far: with the capture and the configuration, all that is needed to go
/// on from the end of a step.
#[derive(Serialize, Deserialize)]
pub(super) struct Solve {
    /// Steps that are finished.
    pub finished: usize,
    /// What the textures start from.
    pub initial: State,
    /// The best of the starts so far, with which the warm-up goes on.
    pub best: Option<Start>,
    /// The networks' own model of the pictures.
    pub state: State,
    /// The light that the semantic colours show, until the albedo moves too.
    pub probed: Option<Probed>,
    /// Light and albedo under explicit transport.
    pub lit: Option<Lit>,
    /// The diffuse albedo of the maps, if it is not the networks'.
    pub physical: Option<Physical>,
    /// The textures after every stage.
    pub snapshots: Vec<Snapshot>,
}

/// A short warm-up from the networks of one seed.
#[derive(Serialize, Deserialize)]
pub(super) struct Start {
    losses: Vec<f64>,
    state: State,
    optimisers: Vec<Adam>,
}

impl Start {
    /// How far it has come: the mean of the last tenth of its losses.
    fn loss(&self) -> f64 {
        let tail = &self.losses[self.losses.len() - self.losses.len().div_ceil(10)..];
        tail.iter().sum::<f64>() / tail.len() as f64
    }
}

impl Solve {
    fn new(site: &Site) -> Result<Self, SolveError> {
        if site.coarse().is_empty() {
            return Err(CaptureError::NothingVisible(site.capture.folder.clone()).into());
        }
        let initial = site.initial_state();
        let state = initial.clone();
        Ok(Self {
            finished: 0,
            initial,
            best: None,
            state,
            probed: None,
            lit: None,
            physical: None,
            snapshots: vec![],
        })
    }
}

/// A step of a solve; a checkpoint is kept after each of them.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// A short warm-up from the networks of one seed.
    Start(usize),
    WarmUp,
    /// The light under the semantic colours.
    Light,
    /// The same with the highlights that the light itself makes.
    Distance,
    /// Light and albedo under explicit transport.
    Transport,
    /// The same with the highlights that the light itself makes.
    Highlights,
    /// Normals from heights.
    Heights,
    /// Specular albedo and, without heights, normals.
    Relief(usize),
    Diffuse(usize),
    /// The transported albedo on the full pictures.
    Albedo,
}

impl Step {
    /// The steps in their order.
    fn all(config: &Config) -> Vec<Self> {
        let starts = match config.initialisation.starts {
            0 | 1 => 0,
            starts => starts,
        };
        let mut steps: Vec<Self> = (0..starts).map(Self::Start).collect();
        steps.push(Self::WarmUp);
        if config.transport.enabled {
            let wanted = |steps: usize| steps > 0 && veil::wanted(config);
            steps.push(Self::Light);
            steps.extend(wanted(config.transport.distance).then_some(Self::Distance));
            steps.push(Self::Transport);
            steps.extend(wanted(config.transport.highlights).then_some(Self::Highlights));
        }
        if config.height.enabled {
            steps.push(Self::Heights);
        }
        for round in 1..=config.fine_tuning.rounds {
            steps.extend([Self::Relief(round), Self::Diffuse(round)]);
        }
        if config.transport.enabled {
            steps.push(Self::Albedo);
        }
        steps
    }

    /// How often it reports progress.
    fn iterations(&self, site: &Site) -> usize {
        let config = site.config;
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
            Self::Distance => config.transport.distance,
            Self::Highlights => config.transport.highlights,
            Self::Heights => heights::steps(&config.height, site.size),
            Self::Relief(_) | Self::Diffuse(_) => config.fine_tuning.iterations,
            Self::Albedo => config.transport.refinement,
        }
    }

    /// What it costs, measured on two cores with AVX-512; see [`super::clock`].
    fn work(&self, site: &Site) -> Work {
        let config = site.config;
        let square = |side: usize| (side * side) as f64;
        let pixels = site.pixels as f64;
        let few = if config.warm_up.half_resolution { 0.25 * pixels } else { pixels };
        let work = |sample: f64, samples: f64, texel: f64, texels: f64| Work {
            preparation: 0.0,
            step: 1e-9 * (sample * samples + texel * texels),
            steps: self.iterations(site),
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
            Self::Distance | Self::Highlights => {
                let cells = (2 * t.rows * t.rows) as f64;
                let entries = cells * few.min(MOST_SAMPLES as f64);
                let texels = cells * square(t.texture_size);
                Work { preparation: 25e-9 * entries, ..work(0.4, entries, 0.1, texels) }
            }
            Self::Heights => {
                let share = f64::from(config.height.texture_share);
                work(25.0, pixels, 15.0, share * share * square(site.size))
            }
            // Without a network where the normals stay.
            Self::Relief(_) if config.fine_tuning.deviation_rate == 0.0 => {
                work(4.0, pixels, 3.0, square(site.size))
            }
            Self::Relief(_) => work(60.0, pixels, 25.0, square(site.size)),
            Self::Diffuse(_) | Self::Albedo => work(6.0, pixels, 6.0, square(site.size)),
        }
    }

    /// Takes the step. After an interrupt it leaves in `solve` what it has found until then.
    fn take(&self, site: &mut Site, run: &mut Run, solve: &mut Solve) -> Result<(), SolveError> {
        if !matches!(self, Self::Start(_) | Self::WarmUp) {
            site.drop_coarse();
        }
        if !matches!(self, Self::Light | Self::Distance) {
            site.drop_far();
        }
        let coarse =
            matches!(self, Self::Light | Self::Distance | Self::Transport | Self::Highlights);
        if !coarse && !matches!(self, Self::Start(_) | Self::WarmUp) {
            site.drop_pictures();
        }
        let (config, backend) = (site.config, site.backend);
        match self {
            Self::Start(number) => start(*number, site, run, solve)?,
            Self::WarmUp => {
                let mut config = config.clone();
                config.warm_up.iterations = self.iterations(site);
                let best = solve.best.take();
                if let Some(best) = &best {
                    solve.state = best.state.clone();
                }
                let mut stage = WarmUp::new(&config, site.coarse(), &solve.state);
                let mut losses = vec![];
                if let Some(best) = best {
                    let places = stage.memory().optimisers.into_iter();
                    places.zip(best.optimisers).for_each(|(place, kept)| *place = kept);
                    losses = best.losses;
                }
                run.stage(&mut stage, &mut solve.state)?;
                run.began_with(losses);
            }
            Self::Light => {
                let start =
                    State { networks: solve.state.networks.clone(), ..solve.initial.clone() };
                solve.probed = Some(light(run, site, start)?);
            }
            Self::Transport => {
                let Some(probed) = solve.probed.take() else { return Ok(()) };
                let lit = light_and_albedo(run, site, solve.initial.clone(), probed)?;
                // Before the albedo moves there is nothing of use: the networks' is better.
                let begun = config.transport.hold;
                let moved =
                    run.cut().is_none_or(|cut| cut.stage == "transport" && cut.step > begun);
                solve.lit = moved.then_some(lit);
            }
            Self::Distance => {
                if let Some(probed) = &mut solve.probed {
                    let spared = distance(run, site, solve.initial.clone(), probed)?;
                    run.spare(spared);
                }
            }
            Self::Highlights => {
                if let Some(lit) = &mut solve.lit {
                    let spared = highlights(run, site, lit)?;
                    run.spare(spared);
                }
            }
            Self::Heights => {
                let (steps, lit) = (self.iterations(site), solve.lit.as_ref());
                let bend =
                    run.relief(steps, |step| heights::heights(site, &solve.state, lit, step))?;
                solve.state.resize(site.size);
                solve.state.deviation = bend;
            }
            Self::Relief(round) => {
                solve.state.resize(site.size);
                let (fine, state) = (site.fine(), &solve.state);
                let (samples, deviation) = (&fine.samples, &fine.deviation);
                let mut stage: Box<dyn Stage> = match config.fine_tuning.deviation_rate {
                    0.0 => {
                        Box::new(Specular::new(config, samples, deviation, state, backend, *round))
                    }
                    _ => Box::new(Relief::new(config, samples, deviation, state, backend, *round)),
                };
                run.stage(&mut *stage, &mut solve.state)?;
            }
            Self::Diffuse(round) => {
                let (fine, state) = (site.fine(), &solve.state);
                let mut stage =
                    Diffuse::new(config, &fine.samples, &fine.deviation, state, backend, *round);
                run.stage(&mut stage, &mut solve.state)?;
            }
            Self::Albedo => albedo(site, run, solve)?,
        }
        Ok(())
    }
}

impl Step {
    /// What the step has changed, for the record.
    fn snapshot(&self, site: &Site, solve: &Solve) -> Option<Snapshot> {
        let State { size, diffuse, specular, deviation, .. } = &solve.state;
        let bend = || site.fine().deviation.textures(deviation).sharp;
        match self {
            Self::Start(_) | Self::Light | Self::Distance => None,
            Self::WarmUp => {
                let new = Snapshot::new("warm-up", Unit::Networks);
                Some(new.diffuse(diffuse, *size).specular(specular, *size))
            }
            Self::Transport | Self::Highlights => {
                let lit = &solve.lit.as_ref()?.state;
                let name = if matches!(self, Self::Transport) { "transport" } else { "highlights" };
                Some(Snapshot::new(name, Unit::Transport).diffuse(&lit.diffuse, lit.size))
            }
            Self::Heights => Some(Snapshot::new("relief", Unit::Networks).bend(&bend(), *size)),
            Self::Relief(round) => {
                let stage = format!("normals and specular {round}");
                let new = Snapshot::new(&stage, Unit::Networks).specular(specular, *size);
                let still = site.config.fine_tuning.deviation_rate == 0.0;
                Some(if still { new } else { new.bend(&bend(), *size) })
            }
            Self::Diffuse(round) => {
                let stage = format!("diffuse {round}");
                Some(Snapshot::new(&stage, Unit::Networks).diffuse(diffuse, *size))
            }
            Self::Albedo => {
                let physical = &solve.physical.as_ref()?.diffuse;
                Some(Snapshot::new("albedo", Unit::Transport).diffuse(physical, *size))
            }
        }
    }
}

/// Warms up the networks of one seed; what has come furthest is kept.
fn start(number: usize, site: &Site, run: &mut Run, solve: &mut Solve) -> Result<(), SolveError> {
    let mut config = site.config.clone();
    config.warm_up.iterations = config.initialisation.start_iterations;
    let networks = Networks::new(&config.networks, config.seed + number as u64);
    let mut state = State { networks, ..solve.initial.clone() };
    let mut stage = WarmUp::new(&config, site.coarse(), &state);
    let losses = run.trial(&format!("start {}", number + 1), &mut stage, &mut state)?;
    let optimisers = stage.memory().optimisers.into_iter().map(|adam| adam.clone()).collect();
    if run.cut().is_some() {
        solve.state = state;
        return Ok(());
    }
    let start = Start { losses, state, optimisers };
    if solve.best.as_ref().is_none_or(|best| start.loss() < best.loss()) {
        solve.best = Some(start);
    }
    Ok(())
}

/// The albedo under explicit transport on the final texture; after an interrupt as coarse as it is.
pub(super) fn albedo(site: &Site, run: &mut Run, solve: &mut Solve) -> Result<(), SolveError> {
    if let (Some(lit), None) = (&solve.lit, &solve.physical) {
        solve.state.resize(site.size);
        let (fine, state) = (site.fine(), &solve.state);
        let (samples, deviation) = (&fine.samples, &fine.deviation);
        solve.physical = Some(refined(run, site.config, samples, deviation, state, lit)?);
    }
    Ok(())
}
