//! The measured spread of scores between runs that differ in their seeds, or in the last digits, alone: a change is
//! held against.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use formats::atomic;
use serde::Deserialize;
use serde_json::Value;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::CompareError;

/// The fewest runs that a spread is estimated from.
pub const MIN_RUNS: usize = 4;

/// Probability of a change that `sees` states.
const POWER: f64 = 0.9;

/// Confidence with which "same" excludes a change that matters.
const SAME: f64 = 0.95;

/// The lower limit of a standard deviation, as a share of the change that matters: other processors round
/// differently.
pub(super) const MIN_RELATIVE_SD: f64 = 0.02;

/// The measured spread of a suite's scores.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// The suite's name.
    pub suite: String,
    /// Hash of the suite's text.
    pub suite_hash: Option<String>,
    /// Hash of the capture, of the cases that had the same in every run: their spread is of the methods' seeds
    /// alone, and says nothing of other captures.
    #[serde(default)]
    pub captures: BTreeMap<String, String>,
    /// Versions that made the runs.
    #[serde(default)]
    pub versions: BTreeMap<String, Value>,
    /// Runs that differed in nothing else.
    pub runs: usize,
    /// Probability that a comparison of two such runs calls any row better or worse.
    pub false_alarms: f64,
    /// The critical value of a difference, in standard deviations; absent if nothing moves.
    #[serde(default)]
    pub critical: Option<f64>,
    /// By row id.
    pub rows: BTreeMap<String, Spread>,
}

/// Spread of a row over seeds.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// True if the other three are of the logarithm: shares of the value, for errors, which chance
    /// multiplies; else they are in the metric's unit.
    #[serde(default)]
    pub relative: bool,
    /// Standard deviation over the runs.
    pub sd: f64,
    /// The smallest change worth reporting: the default tolerance.
    pub matters: f64,
    /// The change that a comparison of two runs sees with probability 0.9.
    pub sees: f64,
    /// The probability of seeing the change that matters.
    pub power: f64,
}

/// Limits on the difference of two values of a row, or of their means over runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// A larger difference is a change.
    pub change: f64,
    /// A smaller one is none, at 95 % confidence that a change that matters is excluded; below 0 where
    /// no difference is small enough.
    pub same: f64,
}

impl Calibration {
    /// The row of the file for this spread, if a change of `matters` matters.
    pub(super) fn spread(&self, relative: bool, sd: f64, matters: f64) -> Spread {
        let row = Spread { relative, sd, matters, sees: 0.0, power: 0.0 };
        let change = self.limits(&row, 1).change;
        let of_two = row.limited_sd() * std::f64::consts::SQRT_2;
        let normal = Normal::standard();
        let sees = change + normal.inverse_cdf(POWER) * of_two;
        let beyond = |edge: f64| if of_two > 0.0 { normal.sf(edge / of_two) } else { 0.0 };
        Spread { sees, power: beyond(change - matters) + beyond(change + matters), ..row }
    }

    /// Limits for a run's value against a baseline that is the mean of `baseline_runs` runs.
    pub fn limits(&self, row: &Spread, baseline_runs: u64) -> Limits {
        let of_difference = row.limited_sd() * (1.0 + 1.0 / baseline_runs.max(1) as f64).sqrt();
        // A row that never moved has the critical value of those that did.
        let change = self.critical.unwrap_or(0.0).max(self.student(SAME)) * of_difference;
        Limits { change, same: (row.matters - self.student(SAME) * of_difference).min(change) }
    }

    fn student(&self, confidence: f64) -> f64 {
        // At least three degrees of freedom: both writer and reader refuse fewer runs.
        StudentsT::new(0.0, 1.0, (self.runs.max(2) - 1) as f64)
            .map_or(f64::INFINITY, |student| student.inverse_cdf(confidence))
    }

    /// Bonferroni's limit at `false_alarms`, as if rows were independent, in standard deviations.
    pub fn bonferroni(&self) -> f64 {
        let moving = self.rows.values().filter(|row| row.sd > 0.0).count().max(1);
        self.student(1.0 - self.false_alarms / (2 * moving) as f64)
    }

    /// The file's text, one row a line.
    pub fn to_toml(&self) -> String {
        // A text of JSON is one of TOML.
        let text = |text: &str| Value::from(text).to_string();
        let mut lines = format!(
            "# Variation of a suite's scores with the seeds, or with rounding alone, measured by\n# `unshade calibrate`.\n\
             # sd: standard deviation; matters: the default tolerance; sees: the change that a comparison detects \
             with\n# probability {POWER}; power: the probability of detecting a change of `matters`; relative: as \
             shares of the value.\nformat = 2\n\n[calibration]\nsuite = {}\n",
            text(&self.suite)
        );
        if let Some(hash) = &self.suite_hash {
            // Writing to a string cannot fail.
            let _ = writeln!(lines, "suite_hash = {}", text(hash));
        }
        let _ = writeln!(lines, "runs = {}\nfalse_alarms = {:?}", self.runs, self.false_alarms);
        if let Some(critical) = self.critical {
            let _ = writeln!(lines, "critical = {critical:.3}");
        }
        lines.push_str("\n[calibration.versions]\n");
        for (name, version) in &self.versions {
            let version = version.as_str().map_or_else(|| version.to_string(), str::to_owned);
            let _ = writeln!(lines, "{} = {}", text(name), text(&version));
        }
        if !self.captures.is_empty() {
            lines.push_str(
                "\n# Cached captures: these tolerances apply to runs with the same captures.\n\
                 [calibration.captures]\n",
            );
        }
        for (case, capture) in &self.captures {
            let _ = writeln!(lines, "{} = {}", text(case), text(capture));
        }
        lines.push_str("\n[calibration.rows]\n");
        for (id, row) in &self.rows {
            let Spread { relative, sd, matters, sees, power } = row;
            let relative = if *relative { "relative = true, " } else { "" };
            let _ = writeln!(
                lines,
                "{} = {{ {relative}sd = {sd:.3e}, matters = {matters:.3e}, sees = {sees:.3e}, power = {power:.3} }}",
                text(id)
            );
        }
        lines
    }

    /// Writes the file, completely or not at all.
    pub fn write(&self, path: &Path) -> Result<(), CompareError> {
        atomic::write_file(path, self.to_toml().as_bytes())
            .map_err(|error| CompareError::io(path, error))
    }

    /// The reason why the file cannot be used, if there is one.
    pub(super) fn fault(&self) -> Option<String> {
        let amount = |value: f64| value.is_finite() && value >= 0.0;
        if self.runs < MIN_RUNS {
            return Some(format!("has {} runs, at least {MIN_RUNS} are needed", self.runs));
        }
        if !(self.false_alarms > 0.0 && self.false_alarms < 1.0) {
            return Some("false_alarms is not between 0 and 1".to_owned());
        }
        if !amount(self.critical.unwrap_or(0.0)) {
            return Some("critical is negative or infinite".to_owned());
        }
        let bad = self.rows.iter().find(|(_, row)| !amount(row.sd) || !amount(row.matters));
        bad.map(|(id, _)| format!("the row {id:?} has a negative or infinite spread"))
    }
}

impl Spread {
    /// The distance of two values, in the unit of the other numbers.
    pub fn distance(&self, old: f64, new: f64) -> f64 {
        match self.relative {
            _ if old == new => 0.0,
            // No error is infinitely better than some, and some infinitely worse than none.
            true if old <= 0.0 || new <= 0.0 => f64::INFINITY,
            true => (new / old).ln().abs(),
            false => (new - old).abs(),
        }
    }

    /// A distance from the value `old`, towards larger values, in the metric's unit.
    pub fn in_unit(&self, distance: f64, old: f64) -> f64 {
        if self.relative { old.abs() * distance.exp_m1() } else { distance }
    }

    fn limited_sd(&self) -> f64 {
        self.sd.max(MIN_RELATIVE_SD * self.matters)
    }
}
