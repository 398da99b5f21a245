//! `unshade check`.

use std::path::Path;

use scoring::check::{self, CheckError};

use super::exit::{CHECK_FAILED, DONE};
use crate::suite::{self, RunError};

/// Prints each finding on a line of its own; the exit code says whether there is any.
pub(super) fn check(maps: &Path, capture: Option<&Path>) -> Result<u8, CheckError> {
    let findings = check::check(maps, capture)?;
    for finding in &findings {
        say!("{finding}");
    }
    if !findings.is_empty() {
        return Ok(CHECK_FAILED);
    }
    let without = if capture.is_some() {
        ""
    } else {
        " (--capture also compares maps with its photographs and mesh)"
    };
    say!("{}: no faults found{without}", maps.display());
    Ok(DONE)
}

/// Prints what keeps a submission from being accepted, and what is likely wrong with it.
pub(super) fn submission(folder: &Path, captures: Option<&Path>) -> Result<u8, RunError> {
    let checked = suite::check_submission(folder, captures)?;
    for (case, finding) in &checked.findings {
        eprintln!("{case}: {finding}");
    }
    for fault in &checked.faults {
        say!("{fault}");
    }
    if !checked.faults.is_empty() {
        return Ok(CHECK_FAILED);
    }
    say!("{}: accepted, {} of {}", folder.display(), checked.cases, checked.of);
    Ok(DONE)
}
