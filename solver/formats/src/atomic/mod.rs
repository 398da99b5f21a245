//! Files and folders that are written completely or not at all, and never over what is not ours.
//!
//! Everything is written beside its target as `<name>.partial` and renamed at the end. A folder
//! carries a mark that lists its files: only a folder that has it, and nothing beside what it lists,
//! is ever replaced.

mod error;
mod folder;
mod mark;
mod place;

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub use error::FolderError;
pub use folder::{Folder, remove_folder};
pub use mark::{MARK, claim, claimable};
pub use place::{refuse_overlap, require_space};

/// The place where `target` is written before it is complete.
pub fn partial_path(target: &Path) -> PathBuf {
    with_suffix(target, ".partial")
}

/// Writes `bytes` to `target`; an interrupted call leaves the old file as it was.
pub fn write_file(target: &Path, bytes: &[u8]) -> io::Result<()> {
    write_with(target, |file| file.write_all(bytes))
}

/// Writes what `content` writes to `target`; an interrupted call leaves the old file as it was.
pub fn write_with(
    target: &Path,
    content: impl FnOnce(&mut BufWriter<fs::File>) -> io::Result<()>,
) -> io::Result<()> {
    let partial = partial_path(target);
    let written = fs::File::create(&partial).and_then(|file| {
        let mut file = BufWriter::new(file);
        content(&mut file)?;
        file.into_inner()?.sync_all()?;
        fs::rename(&partial, target)
    });
    if written.is_err() {
        // A full disk has no use for half a file; the first error is the one that tells.
        let _ = fs::remove_file(&partial);
    }
    written
}

fn with_suffix(target: &Path, suffix: &str) -> PathBuf {
    let mut name = target.file_name().unwrap_or_default().to_os_string();
    name.push(suffix);
    target.with_file_name(name)
}

#[cfg(test)]
mod tests;
