//! Records of a run folder on its finished stages.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use formats::atomic;
use formats::content_hash::hash_path;
use serde::{Deserialize, Serialize};

use super::plan::Task;
use super::program::Usage;
use super::size::size_of;

/// A finished stage: what went in, what came out.
#[derive(Serialize, Deserialize)]
struct Finished {
    key: String,
    content: String,
}

/// How an output came about, beside what it was made from. It is no content: two runs differ in it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Made {
    /// When, in UTC.
    #[serde(default)]
    pub at: String,
    /// By what, in words.
    #[serde(default)]
    pub from: String,
    /// Time and memory that a program took.
    #[serde(flatten)]
    pub usage: Option<Usage>,
}

/// A finished stage with what it cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The stage.
    pub id: String,
    /// The hash of its output.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub content: String,
    /// Wall time of the run that did it.
    pub seconds: f64,
    /// Size of its output, without what is no content.
    #[serde(default)]
    pub bytes: u64,
    /// How much there was to do, see [`cost`](super::cost).
    #[serde(default)]
    pub work: f64,
    /// Size of the output as bare numbers, bytes.
    #[serde(default)]
    pub raw: f64,
    /// Key of the records that it is compared with, see [`cost`](super::cost).
    #[serde(default)]
    pub what: String,
    /// How it came about.
    #[serde(default)]
    pub made: Made,
}

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
    earlier: BTreeMap<String, Record>,
}

impl Records {
    /// Records of a folder that need not be there; nothing is written.
    pub fn of(run: &Path) -> Self {
        Self { run: run.to_path_buf(), earlier: costs_of(run).0 }
    }

    pub fn open(run: &Path) -> io::Result<Self> {
        fs::create_dir_all(run.join("stages"))?;
        Ok(Self::of(run))
    }

    /// With what stages cost that were done elsewhere.
    pub fn with(mut self, records: Vec<Record>) -> Self {
        self.earlier.extend(records.into_iter().map(|record| (record.id.clone(), record)));
        self
    }

    fn path(&self, id: &str) -> PathBuf {
        self.run.join("stages").join(format!("{}.json", id.replace('/', ".")))
    }

    /// The content hash of a stage that was finished with this key and whose output is intact.
    pub fn finished(&self, id: &str, key: &str, output: &Path) -> Option<String> {
        let record: Finished = serde_json::from_slice(&fs::read(self.path(id)).ok()?).ok()?;
        let valid = record.key == key && hash_path(output).ok()? == record.content;
        valid.then_some(record.content)
    }

    /// Notes a finished stage and returns the hash of its output.
    pub fn note(&self, id: &str, key: &str, output: &Path) -> io::Result<String> {
        let content = hash_path(output)?;
        self.adopt(id, key, &content)?;
        Ok(content)
    }

    /// Record of a stage whose output is kept, with its cost in the run that did it.
    pub fn kept(&self, id: &str, content: String, output: &Path) -> io::Result<Record> {
        let mut record = self.earlier.get(id).cloned().unwrap_or_default();
        (record.id, record.content) = (id.to_owned(), content);
        record.bytes = size_of(output)?;
        Ok(record)
    }

    /// As [`Self::finished`], without reading the output: it is there, and as large as it was.
    pub fn seems_finished(&self, id: &str, key: &str, output: &Path) -> Option<String> {
        let record: Finished = serde_json::from_slice(&fs::read(self.path(id)).ok()?).ok()?;
        let bytes = size_of(output).ok().filter(|bytes| *bytes > 0)?;
        let as_large = self.earlier.get(id).is_none_or(|known| known.bytes == bytes);
        (record.key == key && as_large).then_some(record.content)
    }

    /// Takes what somewhere else was made for finished here.
    pub fn adopt(&self, id: &str, key: &str, content: &str) -> io::Result<()> {
        let record = Finished { key: key.to_owned(), content: content.to_owned() };
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
    pub fn new(run: &Path, plan: &[Task]) -> Self {
        let order = plan.iter().enumerate().map(|(at, task)| (task.id.clone(), at)).collect();
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
