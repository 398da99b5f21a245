//! `unshade check`.

use std::path::Path;

use scoring::check;

use super::exit::CHECK_FAILED;
use super::outcome::Outcome;
use crate::suite::{self, Observer, RunError};

/// Shows each finding on a line of its own; the exit code says whether there is any.
pub(super) fn check(maps: &Path, capture: Option<&Path>) -> Result<Outcome, RunError> {
    let findings = check::check(maps, capture)?;
    let outcome = if findings.is_empty() {
        let without = if capture.is_some() {
            ""
        } else {
            " (--capture also compares maps with its photographs and mesh)"
        };
        Outcome::line(format!("{}: no faults found{without}", maps.display()))
    } else {
        let lines = findings.iter().map(ToString::to_string).collect();
        Outcome { code: CHECK_FAILED, lines, ..Outcome::default() }
    };
    outcome.with(&findings)
}

/// Shows what keeps a submission from being accepted, and what is likely wrong with it.
pub(super) fn submission(
    folder: &Path,
    captures: Option<&Path>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let checked = suite::check_submission(folder, captures)?;
    for (case, finding) in &checked.findings {
        observer.message(&format!("{case}: {finding}"));
    }
    if !checked.faults.is_empty() {
        return Ok(Outcome { code: CHECK_FAILED, lines: checked.faults, ..Outcome::default() });
    }
    let (cases, of) = (checked.cases, checked.of);
    Ok(Outcome::line(format!("{}: accepted, {cases} of {of}", folder.display())))
}
