//! Removes of a run what it can make again.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use formats::atomic::{Folder, FolderError, MARK, remove_folder};
use scoring::run::RunFile;

use super::earlier::{self, Bound};
use super::error::RunError;
use super::executor::DEBUG;
use super::plan::StageKind;
use super::run::lock;
use super::size::size_of;

/// The folders of a run, beside its records.
const PARTS: [&str; 10] = [
    "captures",
    "lights",
    "maps",
    "relit",
    "scores",
    "logs",
    DEBUG,
    "report",
    earlier::FOLDER,
    STORE,
];
/// Folder that an interrupted run on a cluster leaves: outputs by their content.
const STORE: &str = "store";

/// The outcome for a folder of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The folder.
    pub name: &'static str,
    /// Whether it was to stay.
    pub kept: bool,
    /// Bytes that stay, without what is no content.
    pub bytes: u64,
    /// Bytes that were removed.
    pub removed: u64,
}

/// Outcome for a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cleaned {
    /// Each folder of it that there is.
    pub parts: Vec<Part>,
    /// Files that stay because unshade did not write them.
    pub foreign: Vec<PathBuf>,
}

/// Removes every folder of `run` but those that `keep` names, of an empty `keep` none, and outputs of earlier settings
/// that are beyond the bound. Only what stages of the run left is removed, and nothing that holds a file of somebody
/// else.
pub fn clean(run: &Path, keep: &[String], bound: Bound) -> Result<Cleaned, RunError> {
    if let Some(unknown) = keep.iter().find(|name| !PARTS.contains(&name.as_str())) {
        return Err(RunError::Keep { name: unknown.clone(), known: PARTS.join(", ") });
    }
    let mark = run.join(MARK);
    if !mark.is_file() || !run.join("stages").is_dir() {
        return Err(RunError::NoRun(run.to_path_buf()));
    }
    let _lock = lock(run)?;
    let mut cleaned = Cleaned::default();
    for name in PARTS.into_iter().filter(|name| run.join(name).is_dir()) {
        let kept = keep.is_empty() || keep.iter().any(|other| other == name);
        let before = size_of(&run.join(name))?;
        if !kept {
            remove_part(run, name, &mut cleaned.foreign)?;
        } else if name == earlier::FOLDER {
            earlier::bound(run, bound)?;
        }
        let bytes = size_of(&run.join(name))?;
        cleaned.parts.push(Part { name, kept, bytes, removed: before.saturating_sub(bytes) });
    }
    Ok(cleaned)
}

/// Removes one folder of a run, as far as it is ours.
fn remove_part(run: &Path, name: &str, foreign: &mut Vec<PathBuf>) -> Result<(), RunError> {
    let part = run.join(name);
    if name == "report" {
        return remove_ours(&part, foreign);
    }
    if name == earlier::FOLDER {
        earlier::bound(run, Bound { bytes: Some(0), ..Bound::default() })?;
        foreign.extend(part.exists().then_some(part));
        return Ok(());
    }
    if name == STORE {
        return remove_store(&part, foreign);
    }
    let kind = StageKind::ALL.into_iter().find(|kind| kind.folder() == name);
    for id in ids(run)? {
        let Some((word, place)) = id.split_once('.') else { continue };
        let place = part.join(place.replace('.', "/"));
        match kind {
            None if word == StageKind::Maps.name() && name == DEBUG => {
                match fs::remove_dir_all(&place) {
                    Err(error) if error.kind() != io::ErrorKind::NotFound => {
                        return Err(error.into());
                    }
                    _ => {}
                }
            }
            None if word == StageKind::Maps.name() => remove_file(&place.with_extension("txt"))?,
            Some(kind) if kind.name() != word => continue,
            Some(StageKind::Scores) => remove_file(&place.with_extension("json"))?,
            Some(StageKind::Capture) => {
                remove_ours(&place, foreign)?;
                remove_file(&place.with_extension("toml"))?;
            }
            Some(_) => remove_ours(&place, foreign)?,
            None => continue,
        }
        // The case's folder, once it is empty, and nothing else.
        if let Some(case) = place.parent().filter(|case| *case != part) {
            let _ = fs::remove_dir(case);
        }
    }
    let _ = fs::remove_dir(&part);
    if part.exists() {
        let left = fs::read_dir(&part)?.collect::<Result<Vec<_>, _>>()?;
        let left = left.into_iter().map(|entry| entry.path());
        foreign.extend(
            left.filter(|path| !foreign.iter().any(|known| known.starts_with(path)))
                .collect::<Vec<_>>(),
        );
    }
    Ok(())
}

/// Ids of a run's stages, with dots, sorted: those of its suite, and those that were finished for an earlier
/// state of it.
fn ids(run: &Path) -> io::Result<Vec<String>> {
    let mut ids = Vec::new();
    // The records below are enough for a run that has no manifest yet.
    if let Ok(manifest) = RunFile::open(run) {
        let captures = manifest.cases.iter();
        ids.extend(captures.map(|case| format!("{}.{}", StageKind::Capture.name(), case.id)));
        ids.extend(
            manifest.methods().map(|(case, method)| {
                format!("{}.{}.{}", StageKind::Maps.name(), case.id, method.id)
            }),
        );
    }
    for entry in fs::read_dir(run.join("stages"))? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        ids.extend(name.strip_suffix(".json").map(str::to_owned));
    }
    ids.retain(|id| is_plain(id));
    ids.sort();
    ids.dedup();
    Ok(ids)
}

/// Names of cases and methods between single dots: whatever a file says, nothing beside the run is meant.
fn is_plain(id: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    id.split('.').all(|part| !part.is_empty() && part.chars().all(plain))
}

/// Removes a folder that unshade would replace.
fn remove_ours(path: &Path, foreign: &mut Vec<PathBuf>) -> Result<(), RunError> {
    if !path.exists() {
        return Ok(());
    }
    match Folder::begin(path) {
        Ok(folder) => {
            folder.abandon();
            Ok(remove_folder(path)?)
        }
        Err(FolderError::Foreign { .. } | FolderError::NotOurs(_)) => {
            foreign.push(path.to_path_buf());
            Ok(())
        }
        Err(error) => Err(error.into()),
    }
}

/// Removes what `synth/unshade/cluster/store.py` writes: files that are named by hashes.
fn remove_store(store: &Path, foreign: &mut Vec<PathBuf>) -> Result<(), RunError> {
    for (folder, ending) in [("objects", "tar"), ("keys", "json")] {
        let folder = store.join(folder);
        for entry in fs::read_dir(&folder).into_iter().flatten() {
            let path = entry?.path();
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let hash = stem.len() == 64 && stem.chars().all(|c| c.is_ascii_hexdigit());
            if hash && path.is_file() && path.extension().is_some_and(|found| found == ending) {
                remove_file(&path)?;
            }
        }
        let _ = fs::remove_dir(&folder);
    }
    let _ = fs::remove_dir(store);
    foreign.extend(store.exists().then(|| store.to_path_buf()));
    Ok(())
}

fn remove_file(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        result => result,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_never_leads_out_of_the_run() {
        for id in ["capture.ada-studio", "maps.ada-studio.mean_texture"] {
            assert!(is_plain(id), "{id}");
        }
        for id in ["capture..", "capture./etc/x", "maps.a.../b", "capture.a/b", "", "capture."] {
            assert!(!is_plain(id), "{id}");
        }
    }
}
