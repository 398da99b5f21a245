//! The report: a run folder as one folder of pages that opens from disk, without a network.
//!
//! [`write`] reads `run.json`, the scores, maps and pictures below a run and leaves
//! `index.html` with its pictures, the scores it was made from, and the baseline that later
//! runs are compared with. Equal runs give equal
//! bytes, except in the section with the wall times.

mod case;
mod curve;
mod difference;
mod light;
#[cfg(feature = "rerun")]
mod live;
#[cfg(not(feature = "rerun"))]
#[path = "live_absent.rs"]
mod live;
mod maps;
mod matrix;
mod methods;
mod metric;
mod page;
mod plates;
mod results;
mod run;
mod sheets;
mod solve;
mod summary;
mod table;
mod tone;
mod views;

#[cfg(test)]
mod fake;
#[cfg(test)]
mod tests;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use solver::atomic::{self, Folder, FolderError};
use solver::picture::PictureError;

pub use live::Live;
use page::Page;
pub use results::write_results;
use run::RunFile;

use crate::compare::{Baseline, CompareError};
use crate::score::ScoreError;

/// What can keep a report from being written; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file or folder of the run cannot be read.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// A file of the run is not what it should be.
    #[error("{path}: is not a valid file of a run: {reason}; run the suite again")]
    Json {
        /// The file.
        path: PathBuf,
        /// What the parser said.
        reason: String,
    },
    /// The run was written by another version.
    #[error("{path}: has format {found}, this program reads {}; run the suite again", FORMAT)]
    Format {
        /// The file.
        path: PathBuf,
        /// The format it states.
        found: u32,
    },
    /// The scores of a method cannot be read.
    #[error(transparent)]
    Scores(#[from] ScoreError),
    /// The baseline cannot be made.
    #[error(transparent)]
    Baseline(#[from] CompareError),
    /// A picture of the run is broken, or one of the report cannot be written.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// Something of the report cannot be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// The report must not be written where it was to be.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The user interrupted.
    #[error("interrupted; the same command makes the report anew")]
    Interrupted,
    /// There is nothing to make a table of.
    #[error("{0}: nothing was scored yet; finish the run with `unshade run`")]
    NoScores(PathBuf),
    /// A solve cannot be shown as it goes.
    #[error("--rerun: {0}")]
    Live(String),
    /// A page could not be laid out.
    #[error("the report's page cannot be laid out: {0}")]
    Template(#[from] minijinja::Error),
}

impl ReportError {
    fn read(path: &Path, reason: io::Error) -> Self {
        Self::Read { path: path.to_path_buf(), reason }
    }

    fn write(path: &Path, reason: io::Error) -> Self {
        Self::Write { path: path.to_path_buf(), reason }
    }
}

/// What a report consists of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportSummary {
    /// The page to open.
    pub index: PathBuf,
    /// Captures that were compared.
    pub cases: usize,
    /// What a later run is compared with; absent while a method has no scores.
    pub baseline: Option<PathBuf>,
}

/// The version of `run.json` that is read.
const FORMAT: u32 = 1;

/// The file that `unshade compare` reads.
const BASELINE: &str = "baseline.json";

/// Stands in every page.
const MARK: &str = "<meta name=\"generator\" content=\"unshade report\">";

/// What hears of the work: how many of how many cases are done, and the next one's name. Says whether to
/// go on.
pub type Hearer<'a> = dyn FnMut(u64, u64, &str) -> bool + 'a;

/// Writes the report of the run folder `run` to the folder `out`, replacing an earlier report. If
/// `hearer` ends it, the earlier report stays.
pub fn write(run: &Path, out: &Path, hearer: &mut Hearer) -> Result<ReportSummary, ReportError> {
    let manifest = RunFile::open(run)?;
    check_place(run, out)?;
    let folder = Folder::begin(out)?;
    let page = match fill(run, &manifest, folder.path(), hearer) {
        Ok(page) => page,
        Err(error) => {
            folder.abandon();
            return Err(error);
        }
    };
    folder.commit()?;
    Ok(ReportSummary {
        index: out.join("index.html"),
        cases: manifest.cases.len(),
        baseline: page.has_every_score().then(|| out.join(BASELINE)),
    })
}

/// Writes everything below `root`.
fn fill(
    run: &Path,
    manifest: &RunFile,
    root: &Path,
    hearer: &mut Hearer,
) -> Result<Page, ReportError> {
    let page = Page::make(run, manifest, root, hearer)?;
    if page.has_every_score() {
        Baseline::of_run(run)?.write(&root.join(BASELINE))?;
    }
    let index = root.join("index.html");
    fs::write(&index, page.html()?).map_err(|error| ReportError::write(&index, error))?;
    Ok(page)
}

/// A report may lie in its run, as `report`, and nowhere else in it.
fn check_place(run: &Path, out: &Path) -> Result<(), FolderError> {
    let own = std::path::absolute(run.join("report")).ok();
    if own.is_some() && own == std::path::absolute(out).ok() {
        return Ok(());
    }
    atomic::apart(out, &[run])
}
