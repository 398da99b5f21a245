//! Hashes of large folders, such as all packages of an interpreter: a file is read again only if its size, its times or
//! its inode changed.

use std::collections::BTreeMap;
use std::env;
use std::fs::{self, Metadata};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use formats::atomic;
use formats::content_hash::{hash_parts, hash_path};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Compiled copies of Python's sources.
const NO_SOURCE: &str = "__pycache__";
/// A file may change twice within a tick of the clock that its times come from.
const TICK: Duration = Duration::from_secs(2);

/// A file as it was when it was hashed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Known {
    stamp: [i64; 6],
    hash: String,
}

/// Hashes of folders, kept in `$XDG_CACHE_HOME/unshade/trees`.
#[derive(Default)]
pub(super) struct TreeHashes {
    folder: Option<PathBuf>,
    /// Hashes that this run has computed.
    once: Mutex<BTreeMap<Vec<PathBuf>, String>>,
}

impl TreeHashes {
    /// Those of this machine's user.
    pub fn of_user() -> Self {
        let set = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let cache = set("XDG_CACHE_HOME").or_else(|| Some(set("HOME")?.join(".cache")));
        Self { folder: cache.map(|cache| cache.join("unshade/trees")), once: Mutex::default() }
    }

    /// The hash of all files at and below `paths`, as they were when this was first asked.
    pub fn once(&self, paths: &[PathBuf]) -> io::Result<String> {
        let mut once = self.once.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(hash) = once.get(paths) {
            return Ok(hash.clone());
        }
        let hash = self.hash(paths)?;
        once.insert(paths.to_vec(), hash.clone());
        Ok(hash)
    }

    /// The hash of all files at and below `paths`, as they are. Links are not followed.
    pub fn hash(&self, paths: &[PathBuf]) -> io::Result<String> {
        let names: Vec<_> = paths.iter().map(|path| path.to_string_lossy()).collect();
        let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
        let file =
            self.folder.as_ref().map(|folder| folder.join(format!("{}.json", hash_parts(&names))));
        let read = |file: &PathBuf| serde_json::from_slice(&fs::read(file).ok()?).ok();
        let known: BTreeMap<String, Known> = file.as_ref().and_then(read).unwrap_or_default();
        let settled = SystemTime::now() - TICK;
        let found: BTreeMap<String, Known> = files(paths)?
            .into_par_iter()
            .map(|(path, metadata)| {
                let (name, stamp) = (path.to_string_lossy().into_owned(), stamp(&metadata));
                let hash = match known.get(&name).filter(|known| known.stamp == stamp) {
                    Some(known) => known.hash.clone(),
                    None => content(&path, &metadata),
                };
                (name, Known { stamp, hash })
            })
            .collect();
        if let Some(file) = file.filter(|_| found != known) {
            let settled = settled.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
            let is_settled = |known: &Known| {
                [known.stamp[2], known.stamp[4]].iter().all(|at| *at < settled.as_secs() as i64)
            };
            let kept: BTreeMap<_, _> =
                found.iter().filter(|(_, known)| is_settled(known)).collect();
            // A folder that cannot be written costs time only.
            let _ = fs::create_dir_all(file.parent().unwrap_or(&file))
                .and_then(|()| atomic::write_file(&file, &serde_json::to_vec(&kept)?));
        }
        let parts: Vec<&str> =
            found.iter().flat_map(|(name, known)| [&**name, &*known.hash]).collect();
        Ok(hash_parts(&parts))
    }
}

fn stamp(metadata: &Metadata) -> [i64; 6] {
    let [size, inode] = [metadata.size(), metadata.ino()].map(u64::cast_signed);
    let modified = [metadata.mtime(), metadata.mtime_nsec()];
    let changed = [metadata.ctime(), metadata.ctime_nsec()];
    [size, inode, modified[0], modified[1], changed[0], changed[1]]
}

fn content(path: &Path, metadata: &Metadata) -> String {
    let read = if metadata.is_symlink() {
        fs::read_link(path).map(|target| format!("to {}", target.display()))
    } else {
        hash_path(path)
    };
    // What cannot be read decides nothing.
    read.unwrap_or_default()
}

fn files(paths: &[PathBuf]) -> io::Result<Vec<(PathBuf, Metadata)>> {
    let mut files = Vec::new();
    let mut open = paths.to_vec();
    while let Some(path) = open.pop() {
        let metadata = match fs::symlink_metadata(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            metadata => metadata?,
        };
        if !metadata.is_dir() {
            // Nothing but files can be read.
            if metadata.is_file() || metadata.is_symlink() {
                files.push((path, metadata));
            }
        } else if path.file_name().is_none_or(|name| name != NO_SOURCE) {
            match fs::read_dir(&path) {
                Err(error) if error.kind() == io::ErrorKind::PermissionDenied => {}
                entries => {
                    for entry in entries? {
                        open.push(entry?.path());
                    }
                }
            }
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_file_is_found_and_the_rest_is_not_read_again() {
        let root = tempfile::tempdir().unwrap();
        let (tree, file) = (root.path().join("tree"), root.path().join("tree/package/a.py"));
        fs::create_dir_all(tree.join("package/__pycache__")).unwrap();
        fs::write(&file, "x = 1").unwrap();
        let hashes =
            || TreeHashes { folder: Some(root.path().join("kept")), once: Mutex::default() };
        let hash = || hashes().hash(std::slice::from_ref(&tree)).unwrap();
        let first = hash();
        fs::write(tree.join("package/__pycache__/a.pyc"), "compiled").unwrap();
        assert_eq!(hash(), first);
        // Of equal size, and within a tick.
        fs::write(&file, "x = 2").unwrap();
        assert_ne!(hash(), first);
        fs::write(&file, "x = 1").unwrap();
        assert_eq!(hash(), first);
        // Old files are known by their stamp alone.
        let kept = fs::read_dir(root.path().join("kept")).unwrap().next().unwrap().unwrap().path();
        let metadata = fs::symlink_metadata(&file).unwrap();
        let known = Known { stamp: stamp(&metadata), hash: "as it was".to_owned() };
        let text = serde_json::to_vec(&BTreeMap::from([(file.to_string_lossy(), known)])).unwrap();
        fs::write(&kept, text).unwrap();
        assert_ne!(hash(), first);
    }
}
