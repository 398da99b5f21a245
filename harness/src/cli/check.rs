//! `unshade check`.

use std::path::Path;

use scoring::check::{self, CheckError};

use super::exit::{CHECK_FAILED, DONE};

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
        " (with --capture, maps are also compared with its photographs and mesh)"
    };
    say!("{}: nothing found{without}", maps.display());
    Ok(DONE)
}
