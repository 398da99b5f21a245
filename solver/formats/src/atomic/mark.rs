//! The mark of a folder that unshade wrote.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::FolderError;

/// The file that tells a folder of ours from others. It is no content of the folder.
pub const MARK: &str = ".unshade";

/// First line of a finished folder's mark; the paths of its files follow, one a line.
const FINISHED: &str = "unshade folder 1: it may be replaced while it holds nothing but";
/// First line of the mark of a folder under construction; its key follows.
const STARTED: &str = "unshade folder 1: under construction";
/// The mark of a folder that only ever grows, such as a run's.
const GROWING: &str = "unshade folder 1: a run\n";

/// Ownership of a folder, as its mark tells it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// There is no such folder.
    Absent,
    /// An empty folder: no data can be lost.
    Nobody,
    /// Under construction, with this key.
    Started(String),
    /// Finished: the paths of its files.
    Finished(BTreeSet<PathBuf>),
    /// Somebody else's.
    Foreign,
}

pub(super) fn owner(folder: &Path) -> io::Result<Owner> {
    let mut entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Owner::Absent),
        // A file in its place, and not in that of a folder above.
        Err(error) if error.kind() == ErrorKind::NotADirectory && folder.is_file() => {
            return Ok(Owner::Foreign);
        }
        Err(error) => return Err(error),
    };
    if entries.next().is_none() {
        return Ok(Owner::Nobody);
    }
    let text = match fs::read_to_string(folder.join(MARK)) {
        Ok(text) => text,
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::InvalidData) => {
            return Ok(Owner::Foreign);
        }
        Err(error) => return Err(error),
    };
    let mut lines = text.lines();
    Ok(match lines.next() {
        Some(STARTED) => Owner::Started(lines.next().unwrap_or_default().to_owned()),
        Some(FINISHED) => Owner::Finished(lines.map(PathBuf::from).collect()),
        _ => Owner::Foreign,
    })
}

/// Marks a folder as under construction.
pub(super) fn start(folder: &Path, key: &str) -> io::Result<()> {
    fs::write(folder.join(MARK), format!("{STARTED}\n{key}\n"))
}

/// Marks a folder as finished with the files it has.
pub(super) fn finish(folder: &Path, files: &[PathBuf]) -> io::Result<()> {
    let mut text = format!("{FINISHED}\n");
    for file in files {
        text.push_str(&file.to_string_lossy());
        text.push('\n');
    }
    fs::write(folder.join(MARK), text)
}

/// Every file below `folder` but the mark, relative to it, sorted.
pub(super) fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next)? {
            let entry = entry?;
            let path = entry.path();
            // A link to a folder is a file of this folder: what it points to lies elsewhere.
            if entry.file_type()?.is_dir() {
                folders.push(path);
            } else if let Ok(relative) = path.strip_prefix(folder)
                && relative != Path::new(MARK)
            {
                files.push(relative.to_path_buf());
            }
        }
    }
    files.sort();
    Ok(files)
}

/// Refuses what [`claim`] would refuse, and writes nothing.
pub fn claimable(folder: &Path) -> Result<(), FolderError> {
    let growing = fs::read_to_string(folder.join(MARK)).is_ok_and(|text| text == GROWING);
    match owner(folder).map_err(FolderError::io(folder))? {
        Owner::Absent | Owner::Nobody => Ok(()),
        _ if growing => Ok(()),
        _ => Err(FolderError::NotOurs(folder.to_path_buf())),
    }
}

/// Takes `folder`, which is made if it is not there, for a run that grows in it. Refused if it holds
/// anything that is not a run's.
pub fn claim(folder: &Path) -> Result<(), FolderError> {
    fs::create_dir_all(folder).map_err(FolderError::io(folder))?;
    claimable(folder)?;
    let mark = folder.join(MARK);
    fs::write(&mark, GROWING).map_err(FolderError::io(&mark))
}
