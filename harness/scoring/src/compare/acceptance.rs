//! Changes that somebody accepted, with a reason: a TOML file that is reviewed as code is.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::Path;

use formats::atomic;
use serde::Deserialize;

use super::CompareError;
use super::row_id::RowId;
use super::tolerance::matches;
use super::verdict::{Comparison, Judged, Verdict};

/// Accepted changes; a later one counts before an earlier one.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Acceptances {
    format: u32,
    #[serde(default, rename = "accepted")]
    entries: Vec<Acceptance>,
}

/// One acceptance.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Acceptance {
    /// Pattern of row ids, as on the command line; `*` stands for any text.
    pub rows: String,
    /// The reason.
    pub reason: String,
    /// The last day that it holds, `YYYY-MM-DD`; for good without one.
    #[serde(default)]
    pub until: Option<String>,
    /// The values that were accepted, by row.
    #[serde(default)]
    pub values: BTreeMap<String, f64>,
    /// Rows that need not be there.
    #[serde(default)]
    pub missing: BTreeSet<String>,
}

impl Acceptances {
    /// Reads a file; one that is not there accepts nothing.
    pub fn read(path: &Path) -> Result<Self, CompareError> {
        let text = match fs::read_to_string(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            text => text.map_err(|error| CompareError::io(path, error))?,
        };
        let all: Self =
            toml::from_str(&text).map_err(|error| CompareError::text(path, error.message()))?;
        if all.format != 1 {
            let reason = format!("has format {}, this version reads 1", all.format);
            return Err(CompareError::text(path, reason));
        }
        let dated = |entry: &&Acceptance| entry.until.as_deref().is_some_and(|day| !is_day(day));
        if let Some(entry) = all.entries.iter().find(dated) {
            let until = entry.until.as_deref().unwrap_or_default();
            return Err(CompareError::text(path, format!("until = {until:?} is not YYYY-MM-DD")));
        }
        Ok(all)
    }

    /// The acceptance of a row's value, if there is one.
    pub(super) fn of(&self, row: &Judged) -> Option<&Acceptance> {
        self.entries.iter().rev().find(|entry| match (row.current, row.baseline) {
            (Some(new), Some(_)) => {
                let metric = RowId::parse(&row.id).map(|id| id.metric);
                let gain = |old| metric.map_or(f64::NEG_INFINITY, |m| m.direction.gain(old, new));
                entry.values.get(&row.id).is_some_and(|accepted| gain(*accepted) >= -row.allowed)
            }
            _ => entry.missing.contains(&row.id),
        })
    }
}

/// Returns whether a text has the form `YYYY-MM-DD`.
pub fn is_day(text: &str) -> bool {
    let form =
        |(at, c): (usize, char)| if at == 4 || at == 7 { c == '-' } else { c.is_ascii_digit() };
    let number = |range: std::ops::Range<usize>| text.get(range).and_then(|part| part.parse().ok());
    text.len() == 10
        && text.chars().enumerate().all(form)
        && number(5..7).is_some_and(|month: u32| (1..=12).contains(&month))
        && number(8..10).is_some_and(|day: u32| (1..=31).contains(&day))
}

impl Comparison {
    /// Takes what somebody accepted, until `today` (`YYYY-MM-DD`) is past its date, off the regressions.
    ///
    /// Accepted is a value, not a row: what moves on from it, for the worse, is a regression again.
    pub fn accept(&mut self, acceptances: &Acceptances, today: &str) {
        for row in self.rows.iter_mut().filter(|row| row.verdict.is_regression()) {
            let Some(found) = acceptances.of(row) else { continue };
            if found.until.as_deref().is_some_and(|until| until < today) {
                let until = found.until.as_deref().unwrap_or_default();
                row.reason = format!("was accepted until {until}: {}", found.reason);
            } else {
                row.verdict = Verdict::Accepted;
                row.reason = format!("accepted: {}", found.reason);
            }
        }
        self.sort();
    }

    /// Adds the regressions that `rows` matches to the file at `path`, behind what stands there; the
    /// number of them.
    pub fn write_acceptance(
        &self,
        path: &Path,
        rows: &str,
        reason: &str,
        until: Option<&str>,
    ) -> Result<usize, CompareError> {
        if let Some(until) = until.filter(|until| !is_day(until)) {
            return Err(CompareError::Day(until.to_owned()));
        }
        let accepted: Vec<&Judged> = self
            .rows
            .iter()
            .filter(|row| row.verdict.is_regression() && matches(rows, &row.id))
            .collect();
        if accepted.is_empty() {
            return Err(CompareError::NothingToAccept(CompareError::line(rows)));
        }
        // Read first: what cannot be read is not added to.
        Acceptances::read(path)?;
        let mut text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(_) => "# Changes of scores that were accepted: reviewed as code is.\nformat = 1\n"
                .to_owned(),
        };
        // A text of JSON is one of TOML.
        let quoted = |text: &str| serde_json::Value::from(text).to_string();
        // Writing to a string cannot fail.
        let _ =
            write!(text, "\n[[accepted]]\nrows = {}\nreason = {}\n", quoted(rows), quoted(reason));
        if let Some(until) = until {
            let _ = writeln!(text, "until = {}", quoted(until));
        }
        let missing: Vec<String> = accepted
            .iter()
            .filter(|row| row.current.is_none())
            .map(|row| quoted(&row.id))
            .collect();
        if !missing.is_empty() {
            let _ = writeln!(text, "missing = [{}]", missing.join(", "));
        }
        let _ = writeln!(text, "[accepted.values]");
        for row in &accepted {
            if let Some(value) = row.current {
                let _ = writeln!(text, "{} = {value:?}", quoted(&row.id));
            }
        }
        atomic::write_file(path, text.as_bytes()).map_err(|error| CompareError::io(path, error))?;
        Ok(accepted.len())
    }
}
