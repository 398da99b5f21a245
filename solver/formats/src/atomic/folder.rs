//! A folder that appears completely or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::mark::{self, Owner};
use super::{FolderError, partial_path, place, with_suffix};

/// A folder under construction; without [`Folder::commit`] the target never appears.
///
/// The old folder is renamed to `<name>.replaced` and removed only when the new one is in its place,
/// and all is on the disk before anything is renamed: at every moment, a power cut included, one of
/// the two is whole. What a cut left is put in order by the next [`Folder::begin`].
#[derive(Debug)]
pub struct Folder {
    /// The path as the user wrote it.
    named: PathBuf,
    target: PathBuf,
    partial: PathBuf,
    replaced: PathBuf,
}

/// A step of [`Folder::commit`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    Mark,
    SyncNew,
    SetOldAside,
    PutNewInPlace,
    SyncParent,
    RemoveOld,
}

impl Folder {
    /// Starts an empty folder beside `target`; what an interrupted attempt left there is removed.
    /// Refused if the target is not ours to replace.
    pub fn begin(target: &Path) -> Result<Self, FolderError> {
        Self::resume(target, "")
    }

    /// [`Folder::begin`] that keeps the files of an interrupted attempt with the same non-empty `key`.
    pub fn resume(target: &Path, key: &str) -> Result<Self, FolderError> {
        place::not_current(target)?;
        // A link stays and its folder is replaced.
        let real = place::resolve(target);
        let folder = Self {
            named: target.to_path_buf(),
            partial: partial_path(&real),
            replaced: with_suffix(&real, ".replaced"),
            target: real,
        };
        folder.recover()?;
        folder.check_replaceable()?;
        let started = mark::owner(&folder.partial).map_err(FolderError::io(&folder.partial))?;
        match started {
            Owner::Started(earlier) if !key.is_empty() && earlier == key => return Ok(folder),
            Owner::Foreign => return Err(FolderError::NotOurs(folder.partial)),
            _ => {}
        }
        remove_folder(&folder.partial)
            .and_then(|()| fs::create_dir_all(&folder.partial))
            .and_then(|()| mark::start(&folder.partial, key))
            .map_err(FolderError::io(&folder.partial))?;
        Ok(folder)
    }

    /// The folder to write to.
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Gives up: nothing of it stays.
    pub fn abandon(self) {
        let _ = remove_folder(&self.partial);
    }

    /// Puts the complete folder in the target's place, replacing an earlier one of ours.
    pub fn commit(self) -> Result<(), FolderError> {
        self.commit_by_steps(|_| Ok(()))
    }

    /// `before` hears of every step and may fail, as tests do.
    pub(super) fn commit_by_steps(
        &self,
        mut before: impl FnMut(Step) -> io::Result<()>,
    ) -> Result<(), FolderError> {
        let parent = self.target.parent().unwrap_or(Path::new("."));
        // Hours may have passed since the beginning.
        self.check_replaceable()?;
        let here = |result: io::Result<()>| result.map_err(FolderError::io(&self.named));
        here(before(Step::Mark))?;
        let files = mark::files_below(&self.partial).map_err(FolderError::io(&self.named))?;
        here(mark::finish(&self.partial, &files))?;
        here(before(Step::SyncNew))?;
        here(sync_below(&self.partial))?;
        here(before(Step::SetOldAside))?;
        let occupied = self.target.exists();
        if occupied {
            here(fs::rename(&self.target, &self.replaced))?;
        }
        here(before(Step::PutNewInPlace))?;
        here(fs::rename(&self.partial, &self.target))?;
        here(before(Step::SyncParent))?;
        here(sync(parent))?;
        here(before(Step::RemoveOld))?;
        if occupied {
            here(remove_folder(&self.replaced))?;
        }
        Ok(())
    }

    /// Puts in order what an interrupted commit left.
    fn recover(&self) -> Result<(), FolderError> {
        let at = |reason| FolderError::io(&self.replaced)(reason);
        match mark::owner(&self.replaced).map_err(at)? {
            Owner::Absent => Ok(()),
            Owner::Foreign => Err(FolderError::NotOurs(self.replaced.clone())),
            _ if self.target.exists() => remove_folder(&self.replaced).map_err(at),
            _ => fs::rename(&self.replaced, &self.target).map_err(at),
        }
    }

    fn check_replaceable(&self) -> Result<(), FolderError> {
        let io = |reason| FolderError::io(&self.named)(reason);
        let listed = match mark::owner(&self.target).map_err(io)? {
            Owner::Absent | Owner::Nobody => return Ok(()),
            Owner::Finished(listed) => listed,
            _ => return Err(FolderError::NotOurs(self.named.clone())),
        };
        let foreign =
            mark::files_below(&self.target).map_err(io)?.into_iter().find(|f| !listed.contains(f));
        match foreign {
            None => Ok(()),
            Some(file) => Err(FolderError::Foreign { folder: self.named.clone(), file }),
        }
    }
}

/// Removes a folder of ours with all that is in it, if it is there: the mark last, so that what an
/// interruption leaves is still known for ours.
pub fn remove_folder(path: &Path) -> io::Result<()> {
    let entries = match fs::read_dir(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries?,
    };
    for entry in entries {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else if entry.file_name() != mark::MARK {
            fs::remove_file(entry.path())?;
        }
    }
    fs::remove_dir_all(path)
}

/// Everything below `folder` is on the disk: files, then the folders that name them.
fn sync_below(folder: &Path) -> io::Result<()> {
    let files = mark::files_below(folder)?;
    let mut folders: Vec<&Path> = files.iter().flat_map(|f| f.ancestors().skip(1)).collect();
    folders.sort();
    folders.dedup();
    // Together, so that the system writes them in one go.
    files.par_iter().try_for_each(|file| sync(&folder.join(file)))?;
    sync(&folder.join(mark::MARK))?;
    folders.into_iter().try_for_each(|inner| sync(&folder.join(inner)))?;
    sync(folder)
}

fn sync(path: &Path) -> io::Result<()> {
    match fs::File::open(path)?.sync_all() {
        // Some file systems cannot sync a folder, and have no need to.
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
        result => result,
    }
}
