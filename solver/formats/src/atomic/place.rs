//! Checks of the place of an output.

use std::path::{Path, PathBuf};

use super::FolderError;

/// Refuses an output that is, holds or lies in one of the `inputs`.
pub fn refuse_overlap(out: &Path, inputs: &[&Path]) -> Result<(), FolderError> {
    let resolved = resolve(out);
    for input in inputs {
        let place = resolve(input);
        let relation = if resolved == place {
            "is the same as"
        } else if place.starts_with(&resolved) {
            "contains"
        } else if resolved.starts_with(&place) {
            "is inside"
        } else {
            continue;
        };
        let (out, input) = (out.to_path_buf(), input.to_path_buf());
        return Err(FolderError::Input { out, relation, input });
    }
    Ok(())
}

/// Refuses the current folder and those above it.
pub(super) fn not_current(target: &Path) -> Result<(), FolderError> {
    let here = std::env::current_dir().map_err(FolderError::io(Path::new(".")))?;
    if resolve(&here).starts_with(resolve(target)) {
        return Err(FolderError::Current(target.to_path_buf()));
    }
    Ok(())
}

/// The real place of a path that need not be there yet: links of the part that is there are followed.
pub(super) fn resolve(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    for known in absolute.ancestors() {
        if let Ok(real) = known.canonicalize() {
            return match absolute.strip_prefix(known) {
                Ok(rest) if rest.as_os_str().is_empty() => real,
                Ok(rest) => real.join(rest),
                Err(_) => real,
            };
        }
    }
    absolute
}

/// Refuses to begin what will not fit: `bytes` on the disk that `path`, which need not be there yet,
/// lies on. Where the system does not say what is free, nothing is refused.
pub fn require_space(path: &Path, bytes: u64) -> Result<(), FolderError> {
    let absolute = resolve(path);
    let Some(state) = absolute.ancestors().find_map(|at| rustix::fs::statvfs(at).ok()) else {
        return Ok(());
    };
    let free = state.f_bavail.saturating_mul(state.f_frsize);
    if free >= bytes {
        return Ok(());
    }
    let megabytes = |bytes: u64| bytes.div_ceil(1_000_000);
    let (needed, free) = (megabytes(bytes), free / 1_000_000);
    Err(FolderError::Space { path: path.to_path_buf(), needed, free })
}
