//! Differences between a run and its baseline beside the scores.

use std::collections::BTreeSet;

use super::baseline::Baseline;
use super::tolerance::Tolerances;

/// The number of names that are spelt out.
const NAMED: usize = 3;

/// Each difference in words; values that a baseline of an earlier version lacks are not compared.
pub(super) fn differences(
    current: &Baseline,
    baseline: &Baseline,
    tolerances: &Tolerances,
) -> Vec<String> {
    let mut found = Vec::new();
    let captures = current.cases.iter().filter_map(|(id, new)| {
        let old = baseline.cases.get(id)?.capture.as_ref()?;
        (new.capture.as_ref()? != old).then_some(id.as_str())
    });
    let captures: Vec<&str> = captures.collect();
    if !captures.is_empty() {
        found.push(format!("other captures ({})", listed(&captures)));
    }
    if differ(current.suite_hash.as_ref(), baseline.suite_hash.as_ref()) {
        found.push("another state of the suite's file".to_owned());
    }
    let names: BTreeSet<&String> =
        current.versions.keys().chain(baseline.versions.keys()).collect();
    let other =
        |name: &&&String| differ(current.versions.get(**name), baseline.versions.get(**name));
    let versions: Vec<&str> = names.iter().filter(other).map(|name| name.as_str()).collect();
    if !versions.is_empty() {
        found.push(format!("other versions ({})", listed(&versions)));
    }
    let (new, old) = (&current.devices, &baseline.devices);
    if !new.is_empty() && !old.is_empty() && new != old {
        let words = |all: &BTreeSet<String>| all.iter().cloned().collect::<Vec<_>>().join(" and ");
        found.push(format!("another machine ({}, before {})", words(new), words(old)));
    }
    if let Some(calibration) = tolerances.calibration() {
        if calibration.suite != current.suite {
            found.push(format!("tolerances measured on the suite {:?}", calibration.suite));
        } else if differ(calibration.suite_hash.as_ref(), current.suite_hash.as_ref()) {
            found.push("tolerances measured on another state of the suite's file".to_owned());
        }
        let capture = |id: &str| current.cases.get(id)?.capture.as_ref();
        if calibration.captures.iter().any(|(id, kept)| differ(Some(kept), capture(id))) {
            found.push("tolerances measured on other captures that were kept".to_owned());
        }
    }
    found
}

/// A case whose tolerances were measured on a capture that was kept, while the run's is not the baseline's, or
/// an earlier version's baseline does not say which it had.
pub(super) fn other_capture<'a>(
    current: &Baseline,
    baseline: &Baseline,
    tolerances: &'a Tolerances,
) -> Option<&'a str> {
    let mut kept = tolerances.calibration()?.captures.keys();
    let other = kept.find(|id| match (current.cases.get(*id), baseline.cases.get(*id)) {
        (Some(new), Some(old)) => new.capture.is_none() || new.capture != old.capture,
        (new, None) => new.is_some() && baseline.cases.is_empty(),
        (None, Some(_)) => false,
    });
    other.map(String::as_str)
}

fn differ<T: PartialEq>(a: Option<T>, b: Option<T>) -> bool {
    matches!((a, b), (Some(a), Some(b)) if a != b)
}

fn listed(names: &[&str]) -> String {
    match names.len().checked_sub(NAMED) {
        None | Some(0) => names.join(", "),
        Some(more) => format!("{} and {more} more", names[..NAMED].join(", ")),
    }
}
