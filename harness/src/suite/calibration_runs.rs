//! Runs of one suite that differ in their seeds alone, for a calibration.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::error::RunError;
use super::file::Suite;
use super::observer::Observer;
use super::run::{RunOptions, begin_from, run};
use super::seeds::Vary;
use crate::synth::Tools;

/// Runs of a suite with other seeds each.
#[derive(Clone, Debug)]
pub struct CalibrationRuns {
    /// How many.
    pub seeds: u32,
    /// Which seeds.
    pub vary: Vary,
    /// Their folder, in which each has one.
    pub keep: PathBuf,
}

impl CalibrationRuns {
    /// The folder of the runs of the tolerances `out` where none is named: beside them.
    pub fn beside(out: &Path) -> PathBuf {
        let stem = out.file_stem().unwrap_or_default().to_string_lossy();
        out.with_file_name(format!("{stem}-runs"))
    }

    /// Makes the runs that are not there yet, and returns the folders of all; or the methods that failed in one
    /// (`<case>/<method>`) and why.
    #[allow(clippy::type_complexity)]
    pub fn make(
        &self,
        suite: &Suite,
        tools: &Tools,
        observer: &mut dyn Observer,
    ) -> Result<Result<Vec<PathBuf>, BTreeMap<String, String>>, RunError> {
        let mut folders: Vec<PathBuf> = Vec::new();
        for round in 1..=self.seeds {
            let folder = self.keep.join(format!("seed-{round:02}"));
            let suite = suite.reseeded(round, self.vary)?;
            if let (Some(first), true) = (folders.first(), self.vary.keeps_captures()) {
                begin_from(first, &suite, &folder)?;
            }
            observer.message(&format!("calibrate: run {round} of {}", self.seeds));
            let summary = run(&suite, &folder, &RunOptions::default(), tools, observer)?;
            if !summary.failed.is_empty() {
                return Ok(Err(summary.failed));
            }
            folders.push(folder);
        }
        Ok(Ok(folders))
    }
}
