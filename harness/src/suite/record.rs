//! What a run folder remembers of its finished stages.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use formats::atomic;
use formats::content_hash::hash_path;
use serde::{Deserialize, Serialize};

use super::program::Usage;

/// A finished stage: what went in, what came out.
#[derive(Serialize, Deserialize)]
struct Finished {
    key: String,
    content: String,
}

/// How an output came about, beside what it was made from. It is no content: two runs differ in it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Made {
    /// When, in UTC.
    #[serde(default)]
    pub at: String,
    /// By what, in words.
    #[serde(default)]
    pub from: String,
    /// What a program took.
    #[serde(flatten)]
    pub usage: Option<Usage>,
}

/// Seconds that a stage took when it last ran, and whether this run could skip it.
#[derive(Clone, Serialize, Deserialize)]
struct Time {
    id: String,
    seconds: f64,
    cached: bool,
    #[serde(default)]
    made: Made,
}

#[derive(Default, Serialize, Deserialize)]
struct Times {
    stages: Vec<Time>,
}

/// The records below `RUN/stages` and the wall times in `RUN/timing.json`.
pub(super) struct Records {
    run: PathBuf,
    earlier: BTreeMap<String, Time>,
    times: Times,
}

impl Records {
    pub(super) fn open(run: &Path) -> io::Result<Self> {
        fs::create_dir_all(run.join("stages"))?;
        let earlier: Times = fs::read(run.join("timing.json"))
            .ok()
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .unwrap_or_default();
        let earlier = earlier.stages.into_iter().map(|time| (time.id.clone(), time)).collect();
        Ok(Self { run: run.to_path_buf(), earlier, times: Times::default() })
    }

    fn path(&self, id: &str) -> PathBuf {
        self.run.join("stages").join(format!("{}.json", id.replace('/', ".")))
    }

    /// The content hash of a stage that was finished with this key and whose output is intact.
    pub(super) fn finished(&self, id: &str, key: &str, output: &Path) -> Option<String> {
        let record: Finished = serde_json::from_slice(&fs::read(self.path(id)).ok()?).ok()?;
        let valid = record.key == key && hash_path(output).ok()? == record.content;
        valid.then_some(record.content)
    }

    /// Notes a finished stage and returns the hash of its output.
    pub(super) fn note(&mut self, id: &str, key: &str, output: &Path) -> io::Result<String> {
        let content = hash_path(output)?;
        let record = Finished { key: key.to_owned(), content: content.clone() };
        atomic::write_file(&self.path(id), &serde_json::to_vec_pretty(&record)?)?;
        Ok(content)
    }

    /// Keeps the time of the run that did the work of a stage.
    pub(super) fn keep_time(&mut self, id: &str) -> io::Result<()> {
        let made = Made::default();
        let unknown = Time { id: id.to_owned(), seconds: 0.0, cached: true, made };
        let earlier = self.earlier.get(id).cloned().unwrap_or(unknown);
        self.add(Time { cached: true, ..earlier })
    }

    /// Notes the time of a stage that ran just now.
    pub(super) fn note_time(&mut self, id: &str, seconds: f64, made: Made) -> io::Result<()> {
        let now = chrono::DateTime::<chrono::Utc>::from(SystemTime::now());
        let at = now.format("%Y-%m-%d %H:%M UTC").to_string();
        self.add(Time { id: id.to_owned(), seconds, cached: false, made: Made { at, ..made } })
    }

    fn add(&mut self, time: Time) -> io::Result<()> {
        self.times.stages.push(time);
        let bytes = serde_json::to_vec_pretty(&self.times)?;
        atomic::write_file(&self.run.join("timing.json"), &bytes)
    }
}
