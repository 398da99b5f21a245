//! Checkpoints: what a solve needs to go on after an interrupt or a fall, to the same bytes.
//!
//! A folder beside the maps with two files: `solve`, written at the end of every step, and `stage`,
//! written about every half minute within a long one. Each begins with the format and a key of
//! everything that the result depends on, so that neither is ever used for another solve.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use capture::Capture;
use formats::atomic;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::adam::Adam;
use super::found::Solve;
use super::log::Log;
use super::stage::{Memory, Stage, State};
use crate::backend::Backend;
use crate::config::Config;

/// Counts the changes of what is written.
const FORMAT: u32 = 3;
/// Time between two checkpoints of a stage.
const INTERVAL: Duration = Duration::from_secs(30);
/// A checkpoint may take this share of the time: large textures on a slow disk are kept less often.
const LARGEST_SHARE: f64 = 0.05;
const SOLVE: &str = "solve.postcard";
const STAGE: &str = "stage.postcard";

/// Where a solve keeps its checkpoints.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    folder: PathBuf,
    program: String,
    interval: Duration,
}

impl Checkpoint {
    /// Beside the folder `maps`. `program` names the program that solves, down to its sources if
    /// they may change: a checkpoint of another program is not used.
    pub fn beside(maps: &Path, program: &str) -> Self {
        let mut name = maps.file_name().unwrap_or_default().to_os_string();
        name.push(".checkpoint");
        let folder = maps.with_file_name(name);
        Self { folder, program: program.to_owned(), interval: INTERVAL }
    }

    /// The folder of its files.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Time between two checkpoints of a stage, zero for one after every step; half a minute if
    /// nothing is said.
    #[must_use]
    pub fn every(self, interval: Duration) -> Self {
        Self { interval, ..self }
    }

    /// Takes the checkpoint away. One that stays does no harm, so a failure is only logged.
    pub fn remove(folder: &Path) {
        for file in [SOLVE, STAGE] {
            let _ = fs::remove_file(folder.join(file));
            let _ = fs::remove_file(atomic::partial_path(&folder.join(file)));
        }
        // What else may lie there is not ours.
        match fs::remove_dir(folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                tracing::warn!("{}: cannot be removed: {error}", folder.display());
            }
            _ => {}
        }
    }

    /// The checkpoint of one solve.
    pub(super) fn of(&self, capture: &Capture, config: &Config, backend: &dyn Backend) -> Open {
        let mut hasher = blake3::Hasher::new();
        let (version, config) = (env!("CARGO_PKG_VERSION"), config.to_toml());
        for part in [version, &self.program, capture.hash(), &config, &backend.name()] {
            hasher.update(&(part.len() as u64).to_le_bytes()).update(part.as_bytes());
        }
        Open {
            folder: self.folder.clone(),
            key: hasher.finalize().to_hex().to_string(),
            finished: 0,
            interval: self.interval,
            wait: self.interval,
            last: Instant::now(),
        }
    }
}

/// The checkpoint of one solve.
pub(super) struct Open {
    folder: PathBuf,
    key: String,
    /// Finished steps at the last [`Open::save`].
    finished: usize,
    interval: Duration,
    /// Until the next checkpoint of a stage.
    wait: Duration,
    last: Instant,
}

/// A file that is not of this solve.
struct Stale;

/// The memory of a stage from step to step.
#[derive(Deserialize)]
pub(super) struct StageMemory {
    /// Steps of the solve that were finished when the stage began.
    finished: usize,
    pub name: String,
    pub losses: Vec<f64>,
    /// That it has run.
    pub seconds: f64,
    state: State,
    optimisers: Vec<Adam>,
    own: Vec<Vec<f32>>,
}

/// [`StageMemory`] while it is written: the same fields in the same order, borrowed.
#[derive(Serialize)]
struct BorrowedMemory<'a> {
    finished: usize,
    name: &'a str,
    losses: &'a [f64],
    seconds: f64,
    state: &'a State,
    memory: Memory<'a>,
}

impl StageMemory {
    /// Puts everything back in its place and returns the losses; nothing if the places differ.
    pub fn restore(self, stage: &mut dyn Stage, state: &mut State) -> Option<Vec<f64>> {
        let lengths = |state: &State| {
            let networks = state.networks.parameters.len();
            [networks, state.diffuse.len(), state.specular.len(), state.deviation.len()]
        };
        let Memory { optimisers, own } = stage.memory();
        let alike = optimisers.iter().map(|adam| adam.count());
        let fits = lengths(state) == lengths(&self.state)
            && alike.eq(self.optimisers.iter().map(Adam::count))
            && own.iter().map(|own| own.len()).eq(self.own.iter().map(Vec::len));
        if !fits {
            return None;
        }
        *state = self.state;
        optimisers.into_iter().zip(self.optimisers).for_each(|(place, kept)| *place = kept);
        own.into_iter().zip(self.own).for_each(|(place, kept)| *place = kept);
        Some(self.losses)
    }
}

impl Open {
    /// The checkpoint of an earlier run, if it is of this solve.
    pub fn read(&mut self) -> Option<(Log, Solve, Option<StageMemory>)> {
        let kept = self.read_file::<(Log, Solve)>(SOLVE);
        let stage = self.read_file::<StageMemory>(STAGE);
        if matches!(kept, Err(Stale)) || matches!(stage, Err(Stale)) {
            tracing::warn!(
                "{}: belongs to another capture, configuration, backend or program; starting from the beginning",
                self.folder.display()
            );
            Checkpoint::remove(&self.folder);
        }
        let (log, solve) = kept.ok().flatten()?;
        self.finished = solve.finished;
        let stage = stage.ok().flatten().filter(|stage| stage.finished == solve.finished);
        Some((log, solve, stage))
    }

    /// Keeps what has been found at the end of a step.
    pub fn save(&mut self, log: &Log, solve: &Solve) {
        self.finished = solve.finished;
        self.write_file(SOLVE, &(log, solve));
        // It is of a step that is over.
        let _ = fs::remove_file(self.folder.join(STAGE));
    }

    /// Whether it is time to keep a stage.
    pub fn is_due(&self) -> bool {
        self.last.elapsed() >= self.wait
    }

    /// Keeps a stage after a step.
    pub fn save_stage(
        &mut self,
        name: &str,
        losses: &[f64],
        seconds: f64,
        stage: &mut dyn Stage,
        state: &State,
    ) {
        let (finished, memory) = (self.finished, stage.memory());
        self.write_file(STAGE, &BorrowedMemory { finished, name, losses, seconds, state, memory });
    }

    /// A file's content; nothing if there is none.
    fn read_file<T: DeserializeOwned>(&self, file: &str) -> Result<Option<T>, Stale> {
        let Ok(bytes) = fs::read(self.folder.join(file)) else { return Ok(None) };
        let (head, rest) = postcard::take_from_bytes::<(u32, String)>(&bytes).map_err(|_| Stale)?;
        if head != (FORMAT, self.key.clone()) {
            return Err(Stale);
        }
        postcard::from_bytes(rest).map(Some).map_err(|_| Stale)
    }

    /// Without a checkpoint a solve is as good, so a full disk is no reason to stop it.
    fn write_file(&mut self, file: &str, content: &impl Serialize) {
        let start = Instant::now();
        let path = self.folder.join(file);
        let written = fs::create_dir_all(&self.folder).and_then(|()| {
            atomic::write_with(&path, |out| {
                let all = (FORMAT, &self.key, content);
                postcard::to_io(&all, out).map(drop).map_err(io::Error::other)
            })
        });
        if let Err(error) = written {
            tracing::warn!("{}: no checkpoint: {error}", path.display());
        }
        self.last = Instant::now();
        if !self.interval.is_zero() {
            self.wait = self.interval.max(start.elapsed().div_f64(LARGEST_SHARE));
        }
    }
}
