//! The comparison itself, and how it is told.

use std::fmt::Write;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::CompareError;
use super::baseline::{Baseline, Entry};
use super::tolerance::{Rule, Tolerances};
use crate::metrics::Metric;

/// What became of a score.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Beyond the tolerance, for the worse: a regression.
    Worse,
    /// In the baseline alone: a regression.
    Missing,
    /// Beyond the tolerance, for the better.
    Better,
    /// Not in the baseline.
    New,
    /// Within the tolerance.
    Same,
}

impl Verdict {
    /// Whether it fails the comparison.
    pub fn is_regression(self) -> bool {
        matches!(self, Self::Worse | Self::Missing)
    }

    fn word(self) -> &'static str {
        match self {
            Self::Worse => "WORSE",
            Self::Missing => "MISSING",
            Self::Better => "better",
            Self::New => "new",
            Self::Same => "same",
        }
    }
}

/// A score beside its baseline.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// `<case>/<solver>/<row id>`.
    pub id: String,
    /// What became of it.
    pub verdict: Verdict,
    /// What it was.
    pub baseline: Option<f64>,
    /// What it is.
    pub current: Option<f64>,
    /// How far it may move.
    pub allowed: f64,
    /// Unit of the three.
    pub unit: &'static str,
    /// Why it may move so far.
    pub reason: String,
}

/// Verdicts on every score, regressions first.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The suite's name.
    pub suite: String,
    /// Sorted by verdict, then by id.
    pub rows: Vec<Judged>,
}

/// Judges every score of `current` and of `baseline`.
pub fn compare(
    current: &Baseline,
    baseline: &Baseline,
    tolerances: &Tolerances,
) -> Result<Comparison, CompareError> {
    if current.suite != baseline.suite {
        let (run, baseline) = (current.suite.clone(), baseline.suite.clone());
        return Err(CompareError::Suites { run, baseline });
    }
    let mut rows = Vec::new();
    for (id, old) in &baseline.rows {
        rows.push(judge(id, Some(old), current.rows.get(id), tolerances)?);
    }
    for (id, new) in current.rows.iter().filter(|(id, _)| !baseline.rows.contains_key(*id)) {
        rows.push(judge(id, None, Some(new), tolerances)?);
    }
    rows.sort_by(|a, b| (a.verdict, &a.id).cmp(&(b.verdict, &b.id)));
    Ok(Comparison { suite: baseline.suite.clone(), rows })
}

fn judge(
    id: &str,
    old: Option<&Entry>,
    new: Option<&Entry>,
    tolerances: &Tolerances,
) -> Result<Judged, CompareError> {
    let rule = tolerances.rule(id)?;
    let metric = metric_of(id)?;
    let (baseline, current) = (old.and_then(|old| old.value), new.and_then(|new| new.value));
    let allowed = baseline.map_or(0.0, |baseline| rule.allowed(baseline));
    let verdict = match (baseline, current) {
        (Some(old), Some(new)) => weigh(metric, rule, old, new),
        (Some(_), None) => Verdict::Missing,
        // A row that was and is not defined, unless it has gone altogether.
        (None, None) if old.is_some() && new.is_none() => Verdict::Missing,
        (None, None) if old.is_some() => Verdict::Same,
        (None, _) => Verdict::New,
    };
    let (id, reason) = (id.to_owned(), rule.reason.clone());
    Ok(Judged { id, verdict, baseline, current, allowed, unit: metric.unit, reason })
}

fn weigh(metric: &Metric, rule: &Rule, old: f64, new: f64) -> Verdict {
    let allowed = rule.allowed(old);
    let gain = metric.direction.gain(old, new);
    if rule.either_way && (new - old).abs() > allowed || gain < -allowed {
        Verdict::Worse
    } else if gain > allowed {
        Verdict::Better
    } else {
        Verdict::Same
    }
}

/// The metric of `.../<metric>@<region>:<scale>`.
fn metric_of(id: &str) -> Result<&'static Metric, CompareError> {
    let name = id.split('@').next().and_then(|head| head.rsplit('/').next()).unwrap_or_default();
    Metric::find(name).map_err(|source| CompareError::Metric { id: CompareError::line(id), source })
}

impl Judged {
    /// `28.104 -> 27.402 dB, allowed 0.1`.
    fn change(&self) -> String {
        let shown = |value: Option<f64>| value.map_or("none".to_owned(), |v| format!("{v:.5}"));
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let (old, new) = (shown(self.baseline), shown(self.current));
        format!("{old} -> {new}{unit}, allowed {:.5}", self.allowed)
    }
}

impl Comparison {
    /// Whether nothing is worse or missing.
    pub fn passed(&self) -> bool {
        !self.rows.iter().any(|row| row.verdict.is_regression())
    }

    /// How many scores have a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.rows.iter().filter(|row| row.verdict == verdict).count()
    }

    /// What moved, one line each, and the sums.
    pub fn table(&self) -> String {
        let moved: Vec<&Judged> =
            self.rows.iter().filter(|row| row.verdict != Verdict::Same).collect();
        let width = moved.iter().map(|row| row.id.len()).max().unwrap_or(0);
        let mut text = String::new();
        for row in moved {
            let reason = if row.verdict == Verdict::Worse {
                format!(" ({})", row.reason)
            } else {
                String::new()
            };
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{:8}{:width$}  {}{reason}",
                row.verdict.word(),
                row.id,
                row.change(),
            );
        }
        let counts =
            [Verdict::Worse, Verdict::Missing, Verdict::Better, Verdict::New, Verdict::Same].map(
                |verdict| format!("{} {}", self.count(verdict), verdict.word().to_lowercase()),
            );
        let outcome = if self.passed() { "no regression" } else { "REGRESSION" };
        let _ = writeln!(text, "{}: {outcome}: {}", self.suite, counts.join(", "));
        text
    }

    /// JUnit XML: a suite per case and solver, a test per score; no times, so that equal
    /// comparisons give equal text.
    pub fn junit(&self) -> Result<String, CompareError> {
        let mut report = Report::new(format!("unshade compare {}", self.suite));
        let mut suites: Vec<TestSuite> = Vec::new();
        let mut rows: Vec<&Judged> = self.rows.iter().collect();
        rows.sort_by(|a, b| a.id.cmp(&b.id));
        for row in rows {
            let cut = row.id.match_indices('/').nth(1).map_or(0, |(at, _)| at);
            let (method, name) = (&row.id[..cut], row.id[cut..].trim_start_matches('/'));
            let status = if row.verdict.is_regression() {
                let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_type(row.verdict.word());
                status.set_message(format!("{} ({})", row.change(), row.reason));
                status
            } else {
                TestCaseStatus::success()
            };
            let mut case = TestCase::new(name, status);
            case.set_classname(method);
            if !row.verdict.is_regression() {
                case.set_system_out(format!("{}: {}", row.verdict.word(), row.change()));
            }
            if suites.last().is_none_or(|suite| suite.name.as_str() != method) {
                suites.push(TestSuite::new(method));
            }
            suites.iter_mut().last().map(|suite| suite.add_test_case(case));
        }
        report.add_test_suites(suites);
        Ok(report.to_string()?)
    }
}
