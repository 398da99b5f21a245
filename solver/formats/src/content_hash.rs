//! Content hashes: what decides whether a finished stage is still valid.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::cancel;

/// Wall times differ from run to run, and the mark of a folder says nothing that its files do not.
const NOT_CONTENT: [&str; 2] = ["timing.json", crate::atomic::MARK];

/// The BLAKE3 hash of a file, or of every path and file below a folder in sorted order.
pub fn hash_path(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    if path.is_dir() {
        for file in files_below(path)? {
            let name = file.strip_prefix(path).unwrap_or(&file).to_string_lossy().into_owned();
            cancel::check();
            let bytes = fs::read(&file)?;
            hasher.update(name.as_bytes()).update(&[0]);
            hasher.update(&(bytes.len() as u64).to_le_bytes()).update(&bytes);
        }
    } else {
        hasher.update(&fs::read(path)?);
    }
    Ok(hasher.finalize().to_hex().to_string())
}

/// The BLAKE3 hash of named parts; no two different lists give the same text to hash.
pub fn hash_parts(parts: &[&str]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in parts {
        hasher.update(&(part.len() as u64).to_le_bytes()).update(part.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path
                .file_name()
                .is_some_and(|name| !NOT_CONTENT.iter().any(|known| name == *known))
            {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}
