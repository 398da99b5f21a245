//! History of a suite's scores: a line of JSON for each comparison, in a file that only grows.

use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

use serde::Serialize;

use super::CompareError;
use super::row_id::RowId;
use super::verdict::Comparison;

/// One line of the file.
#[derive(Serialize)]
struct Record<'a> {
    format: u32,
    at: &'a str,
    commit: Option<&'a str>,
    suite: &'a str,
    passed: bool,
    differences: &'a [String],
    /// Means over the cases, of whole regions, by `<method>/<subject>[/<light>]/<metric>@<place>`.
    values: BTreeMap<String, f64>,
}

impl Comparison {
    /// Adds a line to the file at `path`: of the current run, at the time `at`, of the commit that is
    /// checked out.
    pub fn append_history(
        &self,
        path: &Path,
        at: &str,
        commit: Option<&str>,
    ) -> Result<(), CompareError> {
        let record = Record {
            format: 1,
            at,
            commit,
            suite: &self.suite,
            passed: self.passed(),
            differences: &self.differences,
            values: self.means(),
        };
        let mut line =
            serde_json::to_string(&record).map_err(|error| CompareError::text(path, error))?;
        line.push('\n');
        // One write, so that two jobs that end together do not mix their lines.
        let written = OpenOptions::new().create(true).append(true).open(path);
        written
            .and_then(|mut file| file.write_all(line.as_bytes()))
            .map_err(|error| CompareError::io(path, error))
    }

    /// Each score that has a value, averaged over the cases that have it.
    fn means(&self) -> BTreeMap<String, f64> {
        let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
        for row in &self.rows {
            let (Some(value), Ok(id)) = (row.current, RowId::parse(&row.id)) else { continue };
            let of_method = row.id.strip_prefix(id.case).map(|rest| rest.trim_start_matches('/'));
            if let Some(name) = of_method.filter(|_| id.is_whole()) {
                let sum = sums.entry(name.to_owned()).or_default();
                *sum = (sum.0 + value, sum.1 + 1.0);
            }
        }
        sums.into_iter().map(|(name, (sum, n))| (name, sum / n)).collect()
    }
}
