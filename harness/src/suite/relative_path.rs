//! Paths that a file names relative to itself.

use std::fs;
use std::path::{Path, PathBuf};

/// Stands beside a file that a dictionary was written to, and names the folder that its relative paths start from.
const RELATIVE_TO: &str = ".relative-to";

/// A file that `path` names, which lies beside it.
pub(super) fn beside(path: &Path, name: &str) -> PathBuf {
    let folder = path.parent().unwrap_or(Path::new(""));
    match fs::read_to_string(folder.join(RELATIVE_TO)) {
        Ok(other) => Path::new(&other).join(name),
        Err(_) => folder.join(name),
    }
}

/// The absolute path of the folder that holds a file. The parent of a plain file name is the empty path, which the
/// system refuses as a working directory.
pub(super) fn folder_of(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    absolute.parent().map_or_else(|| PathBuf::from("."), Path::to_path_buf)
}
