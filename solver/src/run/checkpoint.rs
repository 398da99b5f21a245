//! Checkpoints, from which a solve continues after an interrupt or a crash, to the same bytes.
//!
//! A folder next to the maps has the value of every finished stage, and `fit`, written about every half minute within a
//! long fit. Each file begins with the format and a key of all inputs of the solve, so that a file is never used for
//! another solve.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use capture::Capture;
use formats::atomic;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::log::Log;
use crate::backend::Backend;
use crate::config::Config;
use crate::fit::Fit;
use crate::fit::adam::Adam;

/// The version of the file format.
const FORMAT: u32 = 4;
/// Time between two checkpoints of a stage.
const INTERVAL: Duration = Duration::from_secs(30);
/// Largest share of the time for checkpoints: on a slow disk, large textures are stored less often.
const LARGEST_SHARE: f64 = 0.05;
/// The file of the current fit, without its extension; no stage has this name.
const FIT: &str = "fit";
const EXTENSION: &str = "postcard";

/// The folder of a solve's checkpoints.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    folder: PathBuf,
    program: String,
    interval: Duration,
}

impl Checkpoint {
    /// A folder next to the folder `maps`. `program` identifies the program, with its sources if they may change: a
    /// checkpoint of another program is not used.
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

    /// Sets the time between two checkpoints of a fit; zero stores one after every step. The default is half a minute.
    #[must_use]
    pub fn every(self, interval: Duration) -> Self {
        Self { interval, ..self }
    }

    /// Removes the checkpoint. A failure is only logged, since a remaining checkpoint is harmless.
    pub fn remove(folder: &Path) {
        let Ok(entries) = fs::read_dir(folder) else { return };
        let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let ours =
            |path: &PathBuf| path.extension().is_some_and(|extension| extension == EXTENSION);
        for path in paths.filter(ours) {
            let _ = fs::remove_file(&path);
            let _ = fs::remove_file(atomic::partial_path(&path));
        }
        // A folder with other files is not removed.
        match fs::remove_dir(folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                tracing::warn!("{}: cannot be removed: {error}", folder.display());
            }
            _ => {}
        }
    }

    /// The checkpoint of one solve.
    pub(crate) fn of(&self, capture: &Capture, config: &Config, backend: &dyn Backend) -> Open {
        let mut hasher = blake3::Hasher::new();
        let (version, config) = (env!("CARGO_PKG_VERSION"), config.to_toml());
        for part in [version, &self.program, capture.hash(), &config, &backend.name()] {
            hasher.update(&(part.len() as u64).to_le_bytes()).update(part.as_bytes());
        }
        Open {
            folder: self.folder.clone(),
            key: hasher.finalize().to_hex().to_string(),
            interval: self.interval,
            wait: self.interval,
            last: Instant::now(),
        }
    }
}

/// The checkpoint of one solve.
pub(crate) struct Open {
    folder: PathBuf,
    key: String,
    interval: Duration,
    /// Time from one checkpoint of a fit to the next.
    wait: Duration,
    last: Instant,
}

/// The file belongs to another solve, or is damaged.
struct Stale;

/// A fit between two steps.
#[derive(Deserialize)]
pub(super) struct FitMemory {
    pub name: String,
    pub losses: Vec<f64>,
    /// Seconds of the fit so far.
    pub seconds: f64,
    variables: Vec<(Vec<f32>, Adam)>,
    memory: Vec<Vec<f32>>,
}

/// [`FitMemory`] while it is written: the same fields in the same order, borrowed.
#[derive(Serialize)]
struct BorrowedMemory<'a> {
    name: &'a str,
    losses: &'a [f64],
    seconds: f64,
    variables: Vec<(&'a [f32], &'a Adam)>,
    memory: Vec<Vec<f32>>,
}

impl FitMemory {
    /// Restores the fit and returns its losses; `None` if the lengths of the arrays differ.
    pub fn restore(self, fit: &mut dyn Fit) -> Option<Vec<f64>> {
        let fits = fit
            .variables()
            .iter()
            .map(|v| (v.values.len(), v.adam.count()))
            .eq(self.variables.iter().map(|(values, adam)| (values.len(), adam.count())))
            && fit.memory().iter().map(|own| own.len()).eq(self.memory.iter().map(Vec::len));
        if !fits {
            return None;
        }
        for (variable, (values, adam)) in fit.variables().into_iter().zip(self.variables) {
            (*variable.values, *variable.adam) = (values, adam);
        }
        fit.memory().into_iter().zip(self.memory).for_each(|(place, stored)| *place = stored);
        Some(self.losses)
    }
}

impl Open {
    /// Opens the checkpoint of an earlier run, and returns its unfinished fit. Files of another solve are removed.
    pub(super) fn open(&mut self) -> Option<FitMemory> {
        let fit = self.read_file::<FitMemory>(FIT);
        let names = fs::read_dir(&self.folder).ok().into_iter().flatten().flatten();
        let stages = names.filter_map(|entry| {
            let path = entry.path();
            let ours = path.extension().is_some_and(|extension| extension == EXTENSION);
            ours.then(|| path.file_stem()?.to_str().map(str::to_owned))?
        });
        let stale = fit.is_err() || stages.into_iter().any(|stage| !self.is_of_this_solve(&stage));
        if stale {
            tracing::warn!(
                "{}: belongs to another capture, configuration, backend or program; starting from the beginning",
                self.folder.display()
            );
            Checkpoint::remove(&self.folder);
            return None;
        }
        fit.ok().flatten()
    }

    /// The value of a stage and the log after it, if they are stored.
    pub(super) fn stored<T: DeserializeOwned>(&mut self, stage: &str) -> Option<(Log, T)> {
        match self.read_file(&file_name(stage)) {
            Ok(stored) => stored,
            Err(Stale) => {
                tracing::warn!("{}: {stage} is damaged; making it anew", self.folder.display());
                None
            }
        }
    }

    /// Stores the value of a stage and the log after it.
    pub(super) fn store(&mut self, stage: &str, log: &Log, value: &impl Serialize) {
        self.write_file(&file_name(stage), &(log, value));
        // This file belongs to a finished fit.
        let _ = fs::remove_file(self.path(FIT));
    }

    /// Whether it is time to store a fit.
    pub fn is_due(&self) -> bool {
        self.last.elapsed() >= self.wait
    }

    /// Stores a fit after a step.
    pub fn store_fit(&mut self, name: &str, losses: &[f64], seconds: f64, fit: &mut dyn Fit) {
        let memory = fit.memory().into_iter().map(|own| own.clone()).collect();
        let variables = fit.variables();
        let variables = variables.iter().map(|v| (v.values.as_slice(), &*v.adam)).collect();
        self.write_file(FIT, &BorrowedMemory { name, losses, seconds, variables, memory });
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name).with_extension(EXTENSION)
    }

    fn is_of_this_solve(&self, name: &str) -> bool {
        let Ok(bytes) = fs::read(self.path(name)) else { return true };
        let head = postcard::take_from_bytes::<(u32, String)>(&bytes);
        head.is_ok_and(|(head, _)| head == (FORMAT, self.key.clone()))
    }

    /// Reads a file's content; `None` without the file.
    fn read_file<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>, Stale> {
        let Ok(bytes) = fs::read(self.path(name)) else { return Ok(None) };
        let (head, rest) = postcard::take_from_bytes::<(u32, String)>(&bytes).map_err(|_| Stale)?;
        if head != (FORMAT, self.key.clone()) {
            return Err(Stale);
        }
        postcard::from_bytes(rest).map(Some).map_err(|_| Stale)
    }

    /// Writes a file. A failure, such as a full disk, does not stop the solve.
    fn write_file(&mut self, name: &str, content: &impl Serialize) {
        let start = Instant::now();
        let path = self.path(name);
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

/// The file of a stage, without its extension.
fn file_name(stage: &str) -> String {
    stage.replace(' ', "-")
}
