//! Files and folders that are written completely or not at all: everything is
//! written beside its target as `<name>.partial` and renamed at the end.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The place where `target` is written before it is complete.
pub fn partial_path(target: &Path) -> PathBuf {
    let mut name = target.file_name().unwrap_or_default().to_os_string();
    name.push(".partial");
    target.with_file_name(name)
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
    let mut file = BufWriter::new(fs::File::create(&partial)?);
    content(&mut file)?;
    file.into_inner()?.sync_all()?;
    fs::rename(&partial, target)
}

/// A folder under construction; without [`Folder::commit`] the target never appears.
#[derive(Debug)]
pub struct Folder {
    target: PathBuf,
    partial: PathBuf,
}

impl Folder {
    /// Starts an empty folder beside `target`; what an interrupted attempt left there is removed.
    pub fn begin(target: &Path) -> io::Result<Self> {
        let partial = partial_path(target);
        remove_folder(&partial)?;
        fs::create_dir_all(&partial)?;
        Ok(Self { target: target.to_path_buf(), partial })
    }

    /// Where to write.
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Puts the complete folder in the target's place, replacing what was there.
    pub fn commit(self) -> io::Result<()> {
        remove_folder(&self.target)?;
        fs::rename(&self.partial, &self.target)
    }
}

/// Removes a folder with all that is in it, if it is there.
pub fn remove_folder(path: &Path) -> io::Result<()> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_abandoned_folder_never_appears_and_a_committed_one_replaces() {
        let root = tempfile::tempdir().unwrap();
        let target = root.path().join("maps");
        let abandoned = Folder::begin(&target).unwrap();
        fs::write(abandoned.path().join("half"), "x").unwrap();
        assert!(!target.exists());
        let second = Folder::begin(&target).unwrap();
        assert!(!second.path().join("half").exists(), "leftovers of the first attempt are gone");
        second.commit().unwrap();
        assert!(target.is_dir());
        Folder::begin(&target).unwrap().commit().unwrap();
        assert!(!partial_path(&target).exists());
    }
}
