//! `unshade clean`.

use std::path::Path;

use crate::suite::{self, Bound, RunError};

/// Says what each kind takes, and what was removed of it.
pub(super) fn clean(run: &Path, keep: &[String], bound: Bound) -> Result<(), RunError> {
    let cleaned = suite::clean(run, keep, bound)?;
    for part in &cleaned.parts {
        let [stay, removed] = [part.bytes, part.removed].map(suite::in_bytes);
        let what = match (part.bytes, part.removed) {
            (_, 0) => format!("{stay} kept"),
            (0, _) => format!("{removed} removed"),
            _ => format!("{removed} removed, {stay} kept"),
        };
        say!("{:<9} {what}", part.name);
    }
    for path in &cleaned.foreign {
        eprintln!("unshade: {}: kept, since unshade did not write all files in it", path.display());
    }
    Ok(())
}
