//! Records of a run folder on its finished stages, and on those of earlier settings.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use formats::atomic::{self, FolderError};
use formats::content_hash::hash_path;
use serde::{Deserialize, Serialize};

use super::earlier::{Earlier, refuse_foreign};
use super::finished::{Finished, Record};
use super::output::OutputHashes;
use super::plan::Stage;
use super::size::size_of;

/// A stage in `RUN/timing.json`, and whether the last run could skip it.
#[derive(Clone, Serialize, Deserialize)]
struct Time {
    #[serde(flatten)]
    record: Record,
    #[serde(default)]
    cached: bool,
}

/// `RUN/timing.json`.
#[derive(Default, Serialize, Deserialize)]
struct TimesFile {
    stages: Vec<Time>,
    #[serde(default)]
    around: Around,
}

/// Seconds of a run that are no stage's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Around {
    /// Finding programs and versions.
    pub start: f64,
    /// Reading the scenes of cases that are to be rendered, for each.
    pub scene: f64,
    /// The report, for each million pixels that it draws.
    #[serde(default)]
    pub drawing: f64,
}

/// Now, as results say it.
pub(super) fn now() -> String {
    let now = chrono::DateTime::<chrono::Utc>::from(SystemTime::now());
    now.format("%Y-%m-%d %H:%M UTC").to_string()
}

/// Records of `RUN/timing.json` by stage, and the time around them; empty without the file.
pub(super) fn costs_of(run: &Path) -> (BTreeMap<String, Record>, Around) {
    let file: TimesFile = fs::read(run.join("timing.json"))
        .ok()
        .and_then(|bytes| serde_json::from_slice(&bytes).ok())
        .unwrap_or_default();
    let records = file.stages.into_iter().map(|time| (time.record.id.clone(), time.record));
    (records.collect(), file.around)
}

/// The records below `RUN/stages`.
pub(super) struct Records {
    run: PathBuf,
    /// Costs of the stages in earlier runs.
    costs: BTreeMap<String, Record>,
}

impl Records {
    /// Records of a folder that need not be there; nothing is written.
    pub fn of(run: &Path) -> Self {
        Self { run: run.to_path_buf(), costs: costs_of(run).0 }
    }

    pub fn open(run: &Path) -> io::Result<Self> {
        fs::create_dir_all(run.join("stages"))?;
        Ok(Self::of(run))
    }

    /// Adds the costs of stages that were executed elsewhere.
    pub fn with(mut self, records: Vec<Record>) -> Self {
        self.costs.extend(records.into_iter().map(|record| (record.id.clone(), record)));
        self
    }

    fn path(&self, id: &str) -> PathBuf {
        self.run.join("stages").join(format!("{}.json", id.replace('/', ".")))
    }

    fn stated(&self, id: &str) -> Option<Finished> {
        serde_json::from_slice(&fs::read(self.path(id)).ok()?).ok()
    }

    fn earlier(&self, id: &str) -> Earlier {
        Earlier::of(&self.run, id)
    }

    /// Returns the record of an intact output with this key. Moves it back from the run's folder of earlier
    /// results if it is there.
    pub fn find_or_restore(
        &self,
        id: &str,
        key: &str,
        output: &Path,
    ) -> Result<Option<Record>, FolderError> {
        let intact = |found: &Finished, path: &Path| {
            found.key == key && hash_path(path).is_ok_and(|hash| hash == found.output.content)
        };
        if let Some(found) = self.stated(id).filter(|found| intact(found, output)) {
            return self.kept(id, found.output, output).map(Some).map_err(FolderError::io(output));
        }
        let earlier = self.earlier(id);
        let Some((found, record)) = earlier.find(key) else { return Ok(None) };
        if !intact(&found, &earlier.output(key)) {
            return Ok(None);
        }
        self.set_aside(id, key, output)?;
        // The record first: without its output it is not valid, and the output is still found where it lies.
        self.write(id, key, &found.output).map_err(FolderError::io(output))?;
        earlier.put_back(key, output)?;
        Ok(Some(record))
    }

    /// Checks an output by its size alone; nothing is read or moved, unlike in [`Self::find_or_restore`].
    pub fn seems_valid(&self, id: &str, key: &str, output: &Path) -> Option<OutputHashes> {
        let as_large = |_: &Finished| {
            let bytes = size_of(output).ok().filter(|bytes| *bytes > 0);
            let known = self.costs.get(id).map(|known| known.bytes);
            bytes.is_some_and(|bytes| known.is_none_or(|known| known == bytes))
        };
        let here = self.stated(id).filter(|found| found.key == key).filter(as_large);
        let found = here.or_else(|| {
            let (found, _) = self.earlier(id).find(key)?;
            self.earlier(id).output(key).exists().then_some(found)
        });
        found.map(|found| found.output)
    }

    /// Keeps the output of a stage that is about to be made with another `key` among those of earlier settings. An
    /// output that nobody stated a key of stays where it is.
    pub fn set_aside(&self, id: &str, key: &str, output: &Path) -> Result<(), FolderError> {
        let Some(found) = self.stated(id).filter(|found| found.key != key) else { return Ok(()) };
        if !output.exists() {
            return Ok(());
        }
        refuse_foreign(output)?;
        let record =
            self.kept(id, found.output.clone(), output).map_err(FolderError::io(output))?;
        self.earlier(id).put(&found, &record, output)?;
        fs::remove_file(self.path(id)).map_err(FolderError::io(output))
    }

    /// Removes what was kept of a stage with this key: it is made anew.
    pub fn forget(&self, id: &str, key: &str) -> io::Result<()> {
        self.earlier(id).remove(key)
    }

    /// The record of a stage whose output is kept, with its cost in the run that did it.
    fn kept(&self, id: &str, hashes: OutputHashes, output: &Path) -> io::Result<Record> {
        let mut record = self.costs.get(id).cloned().unwrap_or_default();
        (record.id, record.output) = (id.to_owned(), hashes);
        record.bytes = size_of(output)?;
        Ok(record)
    }

    /// Writes the key and the hashes of a finished output to `stages/<id>.json`.
    pub fn write(&self, id: &str, key: &str, output: &OutputHashes) -> io::Result<()> {
        let record = Finished { key: key.to_owned(), output: output.clone() };
        atomic::write_file(&self.path(id), &serde_json::to_vec_pretty(&record)?)
    }
}

/// Between two writes of the times: a study's file has megabytes.
const PAUSE: Duration = Duration::from_secs(1);

/// The wall times in `RUN/timing.json`, in the order of the plan however the stages ended.
pub(super) struct Times {
    file: PathBuf,
    order: BTreeMap<String, usize>,
    stages: BTreeMap<usize, Time>,
    pub around: Around,
    written: Option<Instant>,
}

impl Times {
    pub fn new(run: &Path, plan: &[Stage]) -> Self {
        let order = plan.iter().enumerate().map(|(at, stage)| (stage.id.clone(), at)).collect();
        let file = run.join("timing.json");
        Self { file, order, stages: BTreeMap::new(), around: costs_of(run).1, written: None }
    }

    /// Adds a stage, and writes the file if that was not just done.
    pub fn add(&mut self, record: Record, cached: bool) -> io::Result<()> {
        if let Some(at) = self.order.get(&record.id) {
            self.stages.insert(*at, Time { record, cached });
        }
        match self.written {
            Some(written) if written.elapsed() < PAUSE => Ok(()),
            _ => self.write(),
        }
    }

    pub fn write(&mut self) -> io::Result<()> {
        self.written = Some(Instant::now());
        let file =
            TimesFile { stages: self.stages.values().cloned().collect(), around: self.around };
        atomic::write_file(&self.file, &serde_json::to_vec_pretty(&file)?)
    }

    /// The finished stages of this run, in the order of the plan.
    pub fn records(&self) -> impl Iterator<Item = &Record> {
        self.stages.values().map(|time| &time.record)
    }
}
