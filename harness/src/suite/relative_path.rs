//! Paths that a file names relative to itself.

use std::fs;
use std::path::{Path, PathBuf};

/// Stands beside a file that a dictionary was written to, and names the folder that its relative paths start from.
const RELATIVE_TO: &str = ".relative-to";

/// The file `name` in the folder that the relative paths of the file `path` start from.
pub(super) fn beside(path: &Path, name: &str) -> PathBuf {
    start_of(path).join(name)
}

/// The absolute path of the folder that the relative paths of the file `path` start from. The parent of a plain file
/// name is the empty path, which the system refuses as a working directory.
pub(super) fn folder_of(path: &Path) -> PathBuf {
    let folder = start_of(path);
    let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
    std::path::absolute(&folder).unwrap_or(folder)
}

fn start_of(path: &Path) -> PathBuf {
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::read_to_string(folder.join(RELATIVE_TO)).map_or_else(|_| folder.to_owned(), PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mark_of_a_written_dictionary_names_the_folder_of_its_relative_paths() {
        let folder = tempfile::tempdir().unwrap();
        let suite = folder.path().join("suite.toml");
        assert_eq!(folder_of(&suite).join("mine.py"), folder.path().join("mine.py"));
        std::fs::write(folder.path().join(RELATIVE_TO), "/elsewhere").unwrap();
        assert_eq!(folder_of(&suite).join("mine.py"), Path::new("/elsewhere/mine.py"));
        assert_eq!(beside(&suite, "a.toml"), Path::new("/elsewhere/a.toml"));
    }
}
