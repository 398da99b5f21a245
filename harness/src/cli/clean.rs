//! `unshade clean`.

use std::path::Path;

use super::outcome::Outcome;
use crate::suite::{self, Bound, Observer, RunError};

/// Shows the size of each kind of folder, and what was removed of it.
pub(super) fn clean(
    run: &Path,
    keep: &[String],
    bound: Bound,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let cleaned = suite::clean(run, keep, bound)?;
    for path in &cleaned.foreign {
        let path = path.display();
        let why = "kept, since unshade did not write all files in it";
        observer.message(&format!("unshade: {path}: {why}"));
    }
    let line = |part: &suite::Part| {
        let [stay, removed] = [part.bytes, part.removed].map(suite::in_bytes);
        let what = match (part.bytes, part.removed) {
            (_, 0) => format!("{stay} kept"),
            (0, _) => format!("{removed} removed"),
            _ => format!("{removed} removed, {stay} kept"),
        };
        format!("{:<9} {what}", part.name)
    };
    Ok(Outcome { lines: cleaned.parts.iter().map(line).collect(), ..Outcome::default() })
}
