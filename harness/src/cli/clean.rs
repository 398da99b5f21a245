//! `unshade clean`.

use std::path::Path;

use crate::suite::{self, RunError};

/// Says what each kind takes, and what was removed of it.
pub(super) fn clean(run: &Path, keep: &[String]) -> Result<(), RunError> {
    let cleaned = suite::clean(run, keep)?;
    for part in &cleaned.parts {
        let what = match part.removed {
            0 => format!("{} stay", suite::in_bytes(part.bytes)),
            removed => format!("{} removed", suite::in_bytes(removed)),
        };
        say!("{:<9} {what}", part.name);
    }
    for path in &cleaned.foreign {
        eprintln!(
            "unshade: {}: was not written by unshade, or holds what was not; it stays",
            path.display()
        );
    }
    Ok(())
}
