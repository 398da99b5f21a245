//! The two sides of a comparison: runs, baselines, or the scores of one method on one capture.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::CompareError;
use super::baseline::{Baseline, Captured};
use crate::score::Scores;

const RUN: &str = "run.json";
const BASELINE: &str = "baseline.json";

/// One side as its path names it.
enum Side {
    /// Every score of a run.
    Whole(Baseline),
    /// The scores of one method on one capture.
    One(Box<Scores>),
}

/// Reads what is compared, and what it is compared with. Each is a run's folder or its `run.json`, a baseline or a
/// report's folder, which has one, or a file of scores. Beside a file of scores, the other side is reduced to the
/// scores of that method on that capture.
///
/// # Errors
/// If a path is none of these, or if the two share no method on one capture.
pub fn sides(current: &Path, baseline: &Path) -> Result<[Baseline; 2], CompareError> {
    let paths = [current, baseline];
    Ok(match (Side::read(current)?, Side::read(baseline)?) {
        (Side::Whole(current), Side::Whole(baseline)) => [current, baseline],
        (Side::One(scores), Side::Whole(whole)) => {
            let whole = part(whole, &scores, paths)?;
            [beside(&whole, &scores), whole]
        }
        (Side::Whole(whole), Side::One(scores)) => {
            let whole = part(whole, &scores, [baseline, current])?;
            let scores = beside(&whole, &scores);
            [whole, scores]
        }
        (Side::One(current), Side::One(baseline)) => {
            if current.inputs.capture != baseline.inputs.capture {
                let [scores, other] = paths.map(Path::to_path_buf);
                let has = format!("are of the capture {} with other content", baseline.capture);
                let capture = current.capture.clone();
                let clash = format!("scores the capture {capture}, but {} {has}", other.display());
                return Err(CompareError::NothingInCommon { scores, clash });
            }
            let mut whole = Baseline::new("");
            whole.cases.insert(current.capture.clone(), captured(&current));
            whole.add(&format!("{}/{}", current.capture, current.solver), &current);
            [whole.clone(), beside(&whole, &baseline)]
        }
    })
}

/// The folder of a run, if the path names one or its `run.json`.
pub fn run_folder(path: &Path) -> Option<PathBuf> {
    match path.is_dir() {
        true => path.join(RUN).is_file().then(|| path.to_path_buf()),
        false => (path.file_name()? == RUN).then(|| path.with_file_name("")),
    }
}

impl Side {
    fn read(path: &Path) -> Result<Self, CompareError> {
        if path.is_dir() {
            let (run, report) = (path.join(RUN), path.join(BASELINE));
            return match (run.is_file(), report.is_file()) {
                (true, _) => Ok(Self::Whole(Baseline::of_run(path)?)),
                (_, true) => Ok(Self::Whole(Baseline::read(&report)?)),
                _ => Err(CompareError::NotComparable(path.to_path_buf())),
            };
        }
        let bytes = fs::read(path).map_err(|error| CompareError::io(path, error))?;
        let document: Value =
            serde_json::from_slice(&bytes).map_err(|error| CompareError::text(path, error))?;
        match (&document["rows"], &document["cases"]) {
            (Value::Object(_), _) => Ok(Self::Whole(Baseline::from_bytes(path, &bytes)?)),
            (Value::Array(_), _) => Ok(Self::One(Box::new(Scores::from_bytes(path, &bytes)?))),
            (_, Value::Array(_)) => {
                Ok(Self::Whole(Baseline::of_run(path.parent().unwrap_or(Path::new(".")))?))
            }
            _ => Err(CompareError::NotComparable(path.to_path_buf())),
        }
    }
}

fn captured(scores: &Scores) -> Captured {
    let Scores { face, light, .. } = scores.clone();
    Captured { face, light, capture: Some(scores.inputs.capture.clone()) }
}

/// Reduces a run to the method and capture of `scores`; the paths are those of the scores and of the run.
fn part(
    whole: Baseline,
    scores: &Scores,
    [file, other]: [&Path; 2],
) -> Result<Baseline, CompareError> {
    let same = |(id, case): &(&String, &Captured)| match &case.capture {
        Some(hash) => *hash == scores.inputs.capture,
        None => **id == scores.capture,
    };
    let prefix = whole.cases.iter().find(same).map(|(id, _)| format!("{id}/{}/", scores.solver));
    let mut kept = whole.clone();
    kept.rows.retain(|id, _| prefix.as_ref().is_some_and(|prefix| id.starts_with(prefix)));
    kept.cases.retain(|id, case| same(&(id, case)));
    if kept.rows.is_empty() {
        let mut has: Vec<String> = whole
            .rows
            .keys()
            .map(|id| id.splitn(3, '/').take(2).collect::<Vec<_>>().join("/"))
            .collect();
        has.dedup();
        let changed = whole.cases.contains_key(&scores.capture) && prefix.is_none();
        let has = match changed {
            true => format!("has that capture with other content, and {}", has.join(", ")),
            false => format!("has {}", has.join(", ")),
        };
        let clash = format!(
            "scores of the method {} on the capture {}, but {} {has}",
            scores.solver,
            scores.capture,
            other.display()
        );
        return Err(CompareError::NothingInCommon { scores: file.to_path_buf(), clash });
    }
    Ok(kept)
}

/// `scores` under the names of the one case and method that `whole` has, and with what a file of scores does not
/// state: suite and versions.
fn beside(whole: &Baseline, scores: &Scores) -> Baseline {
    let mut side = Baseline { rows: Default::default(), runs: 1, ..whole.clone() };
    let name = whole
        .rows
        .keys()
        .next()
        .map_or(String::new(), |id| id.splitn(3, '/').take(2).collect::<Vec<_>>().join("/"));
    side.add(&name, scores);
    side
}
