//! The baseline of a branch: of the commit where this one left it, or of the nearest before.

use std::path::{Path, PathBuf};
use std::process::Command;

use scoring::compare::CompareError;

/// How far back a baseline is looked for, commits of the branch itself.
const FARTHEST: &str = "200";

/// `<folder>/<commit>.json` of the merge base of `HEAD` and `branch`, or of the nearest commit before it
/// that has one.
pub(super) fn baseline(branch: &str, folder: &Path) -> Result<PathBuf, CompareError> {
    let wrong = |reason: String| CompareError::Branch { branch: branch.to_owned(), reason };
    let base = git(&["merge-base", "HEAD", branch]).map_err(&wrong)?;
    let list = ["rev-list", "--first-parent", "--max-count", FARTHEST, base.as_str()];
    let commits = git(&list).map_err(&wrong)?;
    let files = commits.lines().map(|commit| folder.join(format!("{commit}.json")));
    files.into_iter().find(|file| file.is_file()).ok_or_else(|| {
        let short = base.get(..12).unwrap_or(&base);
        wrong(format!(
            "{} has no baseline of {short}, where this commit left the branch, nor of the {FARTHEST} \
             before; keep each run's report/baseline.json of the branch there as <commit>.json",
            folder.display()
        ))
    })
}

/// The commit that is checked out; none outside a repository.
pub(super) fn head() -> Option<String> {
    git(&["rev-parse", "HEAD"]).ok()
}

fn git(arguments: &[&str]) -> Result<String, String> {
    let done = Command::new("git").args(arguments).output().map_err(|error| {
        format!("git cannot be started: {error}; install it, or name a baseline")
    })?;
    if done.status.success() {
        return Ok(String::from_utf8_lossy(&done.stdout).trim().to_owned());
    }
    let said = String::from_utf8_lossy(&done.stderr);
    let said = said.trim().lines().next().unwrap_or("it found no common commit");
    Err(format!("git {}: {said}; fetch the branch with its history (depth 0)", arguments[0]))
}
