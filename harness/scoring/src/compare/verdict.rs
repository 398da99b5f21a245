//! Verdicts on scores: better, same, worse, or more than the runs can tell.

use serde::Serialize;

use super::CompareError;
use super::baseline::{Baseline, Entry};
use super::calibration::{Limits, Spread};
use super::context::{differences, other_capture};
use super::row_id::RowId;
use super::tolerance::{Rule, Tolerances};
use crate::metrics::Metric;

/// Verdict on a score.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Beyond the tolerance, for the worse: a regression.
    Worse,
    /// In the baseline alone: a regression.
    Missing,
    /// A regression that somebody accepted, with a reason.
    Accepted,
    /// Beyond the tolerance, for the better.
    Better,
    /// Not in the baseline.
    New,
    /// No change was seen, and one that matters is not excluded.
    CannotTell,
    /// Within the tolerance.
    Same,
}

/// All of them, in order.
pub const VERDICTS: [Verdict; 7] = [
    Verdict::Worse,
    Verdict::Missing,
    Verdict::Accepted,
    Verdict::Better,
    Verdict::New,
    Verdict::CannotTell,
    Verdict::Same,
];

impl Verdict {
    /// Returns whether it fails the comparison.
    pub fn is_regression(self) -> bool {
        matches!(self, Self::Worse | Self::Missing)
    }

    /// As tables have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Worse => "worse",
            Self::Missing => "missing",
            Self::Accepted => "accepted",
            Self::Better => "better",
            Self::New => "new",
            Self::CannotTell => "cannot tell",
            Self::Same => "same",
        }
    }
}

/// A score beside its baseline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// `<case>/<solver>/<row id>`.
    pub id: String,
    /// Verdict on the change.
    pub verdict: Verdict,
    /// The baseline's value.
    pub baseline: Option<f64>,
    /// The run's value.
    pub current: Option<f64>,
    /// The largest change that is tolerated.
    pub allowed: f64,
    /// Unit of the three.
    pub unit: &'static str,
    /// The reason of the tolerance, or of the acceptance.
    pub reason: String,
    /// True if `allowed` is from a measured spread and not from a default tolerance.
    pub measured: bool,
}

/// Verdicts on every score, regressions first.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The suite's name.
    pub suite: String,
    /// Differences between the two beside the scores, in words; with any, like is not compared with
    /// like.
    pub differences: Vec<String>,
    /// The tolerances that decide, in one sentence.
    pub tolerances: String,
    /// Sorted by verdict, then by id.
    pub rows: Vec<Judged>,
    /// The light of each case, as it is shown.
    pub(super) lights: Vec<(String, String)>,
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
    if let Some(case) = other_capture(current, baseline, tolerances) {
        return Err(CompareError::Captures { case: CompareError::line(case) });
    }
    let mut rows = Vec::new();
    for (id, old) in &baseline.rows {
        rows.push(judge(id, Some(old), current.rows.get(id), tolerances, baseline.runs)?);
    }
    for (id, new) in current.rows.iter().filter(|(id, _)| !baseline.rows.contains_key(*id)) {
        rows.push(judge(id, None, Some(new), tolerances, baseline.runs)?);
    }
    let cases = baseline.cases.iter().chain(&current.cases);
    let lights = cases.map(|(id, case)| (id.clone(), case.light.clone())).collect();
    let mut comparison = Comparison {
        suite: baseline.suite.clone(),
        differences: differences(current, baseline, tolerances),
        tolerances: in_words(tolerances, &rows),
        rows,
        lights,
    };
    comparison.sort();
    Ok(comparison)
}

fn judge(
    id: &str,
    old: Option<&Entry>,
    new: Option<&Entry>,
    tolerances: &Tolerances,
    runs: u64,
) -> Result<Judged, CompareError> {
    let rule = tolerances.rule(id)?;
    let metric = RowId::parse(id)?.metric;
    let (baseline, current) = (old.and_then(|old| old.value), new.and_then(|new| new.value));
    let limits = limits(id, baseline, tolerances, rule, runs);
    let verdict = match (baseline, current) {
        (Some(old), Some(new)) => limits.weigh(metric, old, new),
        (Some(_), None) => Verdict::Missing,
        // A row that was and is not defined, unless it has gone altogether.
        (None, None) if old.is_some() && new.is_none() => Verdict::Missing,
        (None, None) if old.is_some() => Verdict::Same,
        (None, _) => Verdict::New,
    };
    let (id, allowed) = (id.to_owned(), limits.allowed(baseline));
    let (unit, measured) = (metric.unit, limits.measured.is_some());
    let reason = if measured { String::new() } else { rule.reason.clone() };
    Ok(Judged { id, verdict, baseline, current, allowed, unit, reason, measured })
}

/// Limits on the distance between the two values of a row.
struct RowLimits<'a> {
    /// A larger distance is a change.
    change: f64,
    /// A smaller one is none.
    same: f64,
    either_way: bool,
    /// The measured spread; none where the limits are default tolerances.
    measured: Option<&'a Spread>,
}

fn limits<'a>(
    id: &str,
    baseline: Option<f64>,
    tolerances: &'a Tolerances,
    rule: &Rule,
    runs: u64,
) -> RowLimits<'a> {
    let either_way = rule.either_way;
    let measured = tolerances.calibration().and_then(|all| Some((all, all.rows.get(id)?)));
    match measured {
        Some((calibration, row)) => {
            let Limits { change, same } = calibration.limits(row, runs);
            RowLimits { change, same, either_way, measured: Some(row) }
        }
        None => {
            let change = baseline.map_or(0.0, |baseline| rule.allowed(baseline));
            RowLimits { change, same: change, either_way, measured: None }
        }
    }
}

impl RowLimits<'_> {
    fn weigh(&self, metric: &Metric, old: f64, new: f64) -> Verdict {
        let gain = metric.direction.gain(old, new);
        // A default tolerance judges the gain, a measured one whether the number moved at all.
        let moved = match self.measured {
            Some(row) => row.distance(old, new),
            None if self.either_way => (new - old).abs(),
            None => gain.abs(),
        };
        if moved > self.change {
            let better = gain > 0.0 && !self.either_way;
            if better { Verdict::Better } else { Verdict::Worse }
        } else if moved <= self.same || new == old {
            Verdict::Same
        } else {
            Verdict::CannotTell
        }
    }

    /// The largest change of the metric that is tolerated, in its unit.
    fn allowed(&self, baseline: Option<f64>) -> f64 {
        match (self.measured, baseline) {
            (Some(row), Some(old)) => row.in_unit(self.change, old),
            _ => self.change,
        }
    }
}

fn in_words(tolerances: &Tolerances, rows: &[Judged]) -> String {
    let Some(calibration) = tolerances.calibration() else {
        return "default tolerances (false-alarm rate unknown; run `unshade calibrate`)".to_owned();
    };
    let rate = 100.0 * calibration.false_alarms;
    let runs = calibration.runs;
    let kept = if calibration.captures.is_empty() { "" } else { " on cached captures" };
    let mut words = format!(
        "{rate} % false alarms over all rows, from the spread of {runs} runs with different seeds{kept}"
    );
    let reasoned = rows.iter().filter(|row| !row.measured && row.baseline.is_some()).count();
    if reasoned > 0 {
        words += &format!("; {reasoned} rows are not calibrated and use default tolerances");
    }
    words
}

impl Judged {
    /// `28.104 -> 27.402 dB, allowed 0.1`.
    pub fn change(&self) -> String {
        let shown = |value: Option<f64>| value.map_or("none".to_owned(), |v| format!("{v:.5}"));
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let (old, new) = (shown(self.baseline), shown(self.current));
        format!("{old} -> {new}{unit}, allowed {:.5}", self.allowed)
    }

    /// `change` with why, where there is a reason.
    pub fn explained(&self) -> String {
        match self.reason.as_str() {
            "" => self.change(),
            reason => format!("{} ({reason})", self.change()),
        }
    }

    /// The change as a multiple of the tolerance.
    pub(super) fn severity(&self) -> f64 {
        match (self.baseline, self.current) {
            (Some(old), Some(new)) if self.allowed > 0.0 => (new - old).abs() / self.allowed,
            (Some(old), Some(new)) if old == new => 0.0,
            _ => f64::INFINITY,
        }
    }
}

impl Comparison {
    /// Returns whether nothing is worse or missing.
    pub fn passed(&self) -> bool {
        !self.rows.iter().any(|row| row.verdict.is_regression())
    }

    /// The number of scores with a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.rows.iter().filter(|row| row.verdict == verdict).count()
    }

    pub(super) fn sort(&mut self) {
        self.rows.sort_by(|a, b| (a.verdict, &a.id).cmp(&(b.verdict, &b.id)));
    }

    /// `0 worse, 0 missing, 1 better, ...`; what there is none of is left out, except of what is worse.
    pub fn counts(&self) -> String {
        let counted = VERDICTS.into_iter().map(|verdict| (self.count(verdict), verdict));
        let shown = counted.filter(|(count, verdict)| *count > 0 || *verdict == Verdict::Worse);
        shown.map(|(n, verdict)| format!("{n} {}", verdict.word())).collect::<Vec<_>>().join(", ")
    }

    /// The verdict on the whole.
    pub fn outcome(&self) -> &'static str {
        if self.passed() { "no regression" } else { "REGRESSION" }
    }
}
