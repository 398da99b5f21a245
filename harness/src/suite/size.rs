//! How much of the disk an output takes.

use std::fs;
use std::io;
use std::path::Path;

use formats::atomic::MARK;

/// Files in which equal outputs may differ, left out so that their sizes are equal too.
const NOT_CONTENT: [&str; 2] = ["timing.json", MARK];

/// Bytes of a file, or of the content of all files below a folder; of nothing, 0.
pub(super) fn size_of(path: &Path) -> io::Result<u64> {
    let mut bytes = 0;
    let mut found = vec![path.to_path_buf()];
    while let Some(path) = found.pop() {
        let kind = match fs::symlink_metadata(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            kind => kind?,
        };
        if kind.is_dir() {
            for entry in fs::read_dir(&path)? {
                found.push(entry?.path());
            }
        } else if path.file_name().is_none_or(|name| NOT_CONTENT.iter().all(|known| name != *known))
        {
            bytes += kind.len();
        }
    }
    Ok(bytes)
}

/// Bytes in the unit that people say.
pub fn in_words(bytes: u64) -> String {
    match bytes {
        0..1_000_000 => format!("{} kB", bytes.div_ceil(1000)),
        1_000_000..1_000_000_000 => format!("{:.1} MB", bytes as f64 / 1e6),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}
