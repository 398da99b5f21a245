//! A run and what it scored.

use std::path::{Path, PathBuf};

use scoring::score::Scores;

use crate::error::ReportError;
use crate::page;
use crate::reference::Reference;
use crate::run::RunFile;

/// A run and what it scored.
pub(super) struct Finished {
    pub folder: PathBuf,
    pub manifest: RunFile,
    /// By case and method, as in the manifest.
    pub scores: Vec<Vec<Option<Scores>>>,
}

impl Finished {
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let manifest = RunFile::open(folder)?;
        let scores = manifest.cases.iter().map(|case| page::read_scores(folder, case));
        let scores: Vec<Vec<_>> = scores.collect::<Result<_, _>>()?;
        if scores.iter().flatten().all(Option::is_none) {
            return Err(ReportError::NoScores(folder.to_path_buf()));
        }
        let folder =
            std::path::absolute(folder).map_err(|error| ReportError::read(folder, error))?;
        Ok(Self { folder, manifest, scores })
    }

    /// The references of the cases.
    pub fn references(&self) -> impl Iterator<Item = Reference> {
        self.manifest.cases.iter().map(|case| Reference::of(&self.folder.join(&case.capture)))
    }

    pub fn title(&self) -> &str {
        self.manifest.title.as_deref().unwrap_or(&self.manifest.suite)
    }
}
