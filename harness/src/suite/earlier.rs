//! Outputs of earlier settings of a stage, so that going back to those settings computes nothing:
//! `RUN/earlier/<stage>/<key>`.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use formats::atomic::{self, FolderError, MARK, remove_folder};
use serde::{Deserialize, Serialize};

use super::error::RunError;
use super::finished::{Finished, Record};
use super::plan::StageKind;
use super::size::size_of;

/// The run's folder of such outputs.
pub(super) const FOLDER: &str = "earlier";
/// Files of an entry: the output, what its program printed, and its record, which makes the entry valid.
const OUTPUT: &str = "output";
const LOG: &str = "log.txt";
const RECORD: &str = "stage.json";

#[derive(Serialize, Deserialize)]
struct Stage {
    finished: Finished,
    record: Record,
}

/// The earlier outputs of one stage.
pub(super) struct Earlier {
    folder: PathBuf,
    /// Where the log of its program lies, of a stage that makes maps.
    log: Option<PathBuf>,
}

impl Earlier {
    /// Those of the stage `id` of a run.
    pub fn of(run: &Path, id: &str) -> Self {
        let name = id.strip_prefix(StageKind::Maps.name()).and_then(|rest| rest.strip_prefix('/'));
        Self {
            folder: run.join(FOLDER).join(id.replace('/', ".")),
            log: name.map(|name| run.join("logs").join(format!("{name}.txt"))),
        }
    }

    fn entry(&self, key: &str) -> PathBuf {
        self.folder.join(key)
    }

    /// Where the output with this key lies, if it is there.
    pub fn output(&self, key: &str) -> PathBuf {
        self.entry(key).join(OUTPUT)
    }

    /// The records of the output with this key.
    pub fn find(&self, key: &str) -> Option<(Finished, Record)> {
        let bytes = fs::read(self.entry(key).join(RECORD)).ok()?;
        let Stage { finished, record } = serde_json::from_slice(&bytes).ok()?;
        (finished.key == key).then_some((finished, record))
    }

    /// Moves an output here.
    pub fn put(
        &self,
        finished: &Finished,
        record: &Record,
        output: &Path,
    ) -> Result<(), FolderError> {
        let entry = self.entry(&finished.key);
        let at = || FolderError::io(&entry);
        self.remove(&finished.key).map_err(at())?;
        fs::create_dir_all(&entry).map_err(at())?;
        if let Some(log) = self.log.as_ref().filter(|log| log.is_file()) {
            fs::rename(log, entry.join(LOG)).map_err(at())?;
        }
        let stage = Stage { finished: finished.clone(), record: record.clone() };
        let text = serde_json::to_vec_pretty(&stage).map_err(io::Error::from).map_err(at())?;
        atomic::write_file(&entry.join(RECORD), &text).map_err(at())?;
        fs::rename(output, entry.join(OUTPUT)).map_err(at())
    }

    /// Moves the output with this key to its place, which holds nothing or what is not finished.
    pub fn put_back(&self, key: &str, output: &Path) -> Result<(), FolderError> {
        let entry = self.entry(key);
        refuse_foreign(output)?;
        let moved = || -> io::Result<()> {
            remove(output)?;
            if let Some(folder) = output.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::rename(entry.join(OUTPUT), output)?;
            if let Some(log) = self.log.as_ref().filter(|_| entry.join(LOG).is_file()) {
                fs::rename(entry.join(LOG), log)?;
            }
            self.remove(key)
        };
        moved().map_err(FolderError::io(&entry))
    }

    /// Removes the output with this key, if it is here.
    pub fn remove(&self, key: &str) -> io::Result<()> {
        if key.is_empty() {
            return Ok(());
        }
        remove(&self.entry(key))?;
        // The last one takes the stage's folder with it.
        let _ = fs::remove_dir(&self.folder);
        Ok(())
    }
}

/// Refuses a folder that holds a file of somebody else, as it would not be replaced either.
pub(super) fn refuse_foreign(folder: &Path) -> Result<(), FolderError> {
    let listed = match fs::read_to_string(folder.join(MARK)) {
        Ok(text) => text.lines().skip(1).map(PathBuf::from).collect(),
        Err(_) => BTreeSet::new(),
    };
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(&next).into_iter().flatten() {
            let path = entry.map_err(FolderError::io(&next))?.path();
            let file = path.strip_prefix(folder).unwrap_or(&path).to_path_buf();
            if path.is_dir() && !path.is_symlink() {
                open.push(path);
            } else if file != Path::new(MARK) && !listed.contains(&file) {
                return Err(FolderError::Foreign { folder: folder.to_path_buf(), file });
            }
        }
    }
    Ok(())
}

fn remove(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return remove_folder(path);
    }
    match fs::remove_file(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        result => result,
    }
}

/// Limits on the outputs of earlier settings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bound {
    /// Bytes of all together; the oldest go first.
    pub bytes: Option<u64>,
    /// Age since it was set aside, seconds.
    pub seconds: Option<f64>,
}

/// Removes earlier outputs of a run until the rest is within the bound.
pub(super) fn bound(run: &Path, bound: Bound) -> Result<(), RunError> {
    let mut entries = Vec::new();
    for stage in folders(&run.join(FOLDER))? {
        for entry in folders(&stage)?.into_iter().filter(|entry| is_key(entry)) {
            // Of an entry without a record nothing can be had.
            let since = fs::metadata(entry.join(RECORD)).and_then(|record| record.modified());
            entries.push((since.unwrap_or(SystemTime::UNIX_EPOCH), size_of(&entry)?, entry));
        }
    }
    entries.sort();
    let (mut bytes, now) = (entries.iter().map(|entry| entry.1).sum::<u64>(), SystemTime::now());
    for (since, size, entry) in entries {
        let age = now.duration_since(since).unwrap_or_default().as_secs_f64();
        if bound.bytes.is_some_and(|most| most == 0 || bytes > most)
            || bound.seconds.is_some_and(|most| age > most)
        {
            remove(&entry)?;
            let _ = entry.parent().map(fs::remove_dir);
            bytes -= size;
        }
    }
    let _ = fs::remove_dir(run.join(FOLDER));
    Ok(())
}

fn is_key(entry: &Path) -> bool {
    let name = entry.file_name().unwrap_or_default().to_string_lossy();
    name.len() == 64 && name.chars().all(|c| c.is_ascii_hexdigit())
}

fn folders(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?.collect::<io::Result<Vec<_>>>()?,
    };
    let paths = entries.into_iter().map(|entry| entry.path());
    Ok(paths.filter(|path| path.is_dir() && !path.is_symlink()).collect())
}
