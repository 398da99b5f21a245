//! The report: a run folder as one folder of pages that opens from disk, without a network.
//!
//! [`write`] reads `run.json`, the scores, maps and pictures below a run and leaves
//! `index.html` with its pictures, the scores it was made from, and the baseline that later
//! runs are compared with. Equal runs give equal
//! bytes, except in the section with the wall times.

mod case;
mod changed;
mod comparison_figures;
mod contact_sheets;
mod curve;
mod difference;
mod error;
mod exports;
mod figures;
mod float_picture;
mod framing;
mod heads;
mod lead;
mod light;
mod link;
mod maps;
mod matrix;
mod methods;
mod metric;
mod page;
mod reference;
mod results;
mod run;
mod save;
mod score_key;
mod site;
mod solve;
mod summary;
mod table;
pub mod tone;
mod views;

#[cfg(test)]
mod sample_run;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use formats::atomic::{self, FolderError};

pub use changed::write_changes;
pub use error::ReportError;
pub use figures::{FigureKind, FigureRequest, write_figure};
use link::WayToRun;
pub use metric::subjects;
use page::Page;
pub use page::ProgressCallback;
pub use results::{failures_in_lines, means_in_lines, write_results};
use run::RunFile;
pub use site::{SiteSummary, write_site};

use scoring::compare::Baseline;

/// Files and size of a written report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportSummary {
    /// The page to open.
    pub index: PathBuf,
    /// Captures that were compared.
    pub cases: usize,
    /// The baseline for later runs; absent while a method is not scored, or where nothing can be scored.
    pub baseline: Option<PathBuf>,
}

/// The file that `unshade compare` reads.
const BASELINE: &str = "baseline.json";

/// Writes the report of the run folder `run` to the folder `out`, replacing an earlier report. If
/// `progress` ends it, the earlier report stays.
pub fn write(
    run: &Path,
    out: &Path,
    progress: &mut ProgressCallback,
) -> Result<ReportSummary, ReportError> {
    let manifest = RunFile::open(run)?;
    check_place(run, out)?;
    let way = WayToRun::new(run, out).map_err(|error| ReportError::read(run, error))?;
    let page: Page =
        save::write_folder(out, |folder| fill(run, &manifest, folder, &way, progress))?;
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
    way: &WayToRun,
    progress: &mut ProgressCallback,
) -> Result<Page, ReportError> {
    let page = Page::make(run, manifest, root, way, progress)?;
    if page.has_every_score() {
        Baseline::of_run(run)?.write(&root.join(BASELINE))?;
    }
    save::write_file(&root.join("index.html"), page.html()?)?;
    Ok(page)
}

/// A report may lie in its run, as `report`, and nowhere else in it.
fn check_place(run: &Path, out: &Path) -> Result<(), FolderError> {
    let own = std::path::absolute(run.join("report")).ok();
    if own.is_some() && own == std::path::absolute(out).ok() {
        return Ok(());
    }
    atomic::refuse_overlap(out, &[run])
}
