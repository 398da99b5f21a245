//! Every score of finished runs with the case and the method it is of: the tidy table.

use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::StudyError;
use crate::score::{Row, Scores};

/// One score of one method on one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observation {
    /// The suite's name.
    pub suite: String,
    /// The case's id.
    pub case: String,
    /// The face's name.
    pub face: String,
    /// Individual typology angle of its true skin, degrees; none where the scores do not say.
    pub skin_tone: Option<f64>,
    /// The light of the capture.
    pub light: String,
    /// Name of the scene's variant; none in a suite without variants.
    pub variant: Option<String>,
    /// The renderer's seed, of a suite that has several.
    pub seed: Option<u64>,
    /// The method; of several seeds of one, the method without its seed.
    pub method: String,
    /// The solver's seed, of a method that has several.
    pub method_seed: Option<u64>,
    /// Role of the method: `solver`, `baseline`, `privileged` or `oracle`.
    pub kind: String,
    /// Class of its inputs: `passive`, `controlled` or `privileged`.
    pub class: String,
    /// The score.
    pub row: Row,
}

/// The part of `run.json` that says where the scores are.
#[derive(Deserialize)]
struct Run {
    suite: String,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    id: String,
    face: String,
    light: String,
    variant: Option<String>,
    seed: Option<u64>,
    #[serde(rename = "solvers")]
    methods: Vec<Method>,
}

#[derive(Deserialize)]
struct Method {
    id: String,
    kind: String,
    #[serde(default = "passive")]
    class: String,
    /// Method that this is one seed of; none of a method without several seeds.
    of: Option<String>,
    seed: Option<u64>,
    /// None of a method that failed.
    scores: Option<PathBuf>,
}

fn passive() -> String {
    "passive".to_owned()
}

/// Reads the scores of finished runs, in the order of the runs, cases and rows. A method's result
/// on a case may be there once.
pub fn observations(runs: &[PathBuf]) -> Result<Vec<Observation>, StudyError> {
    let mut all = Vec::new();
    let mut seen = BTreeSet::new();
    for folder in runs {
        let path = folder.join("run.json");
        let bytes = fs::read(&path).map_err(|error| match error.kind() {
            ErrorKind::NotFound if folder.is_dir() => StudyError::Empty(folder.clone()),
            _ => StudyError::io(&path, error),
        })?;
        let run: Run =
            serde_json::from_slice(&bytes).map_err(|error| StudyError::text(&path, error))?;
        for case in &run.cases {
            for method in &case.methods {
                let Some(scores) = &method.scores else { continue };
                if !seen.insert((run.suite.clone(), case.id.clone(), method.id.clone())) {
                    return Err(StudyError::Twice {
                        run: folder.clone(),
                        case: case.id.clone(),
                        method: method.id.clone(),
                    });
                }
                let scores = Scores::of_run(folder, scores)?;
                all.extend(of_scores(&run, case, method, scores));
            }
        }
    }
    let first = || runs.first().cloned().unwrap_or_default();
    if all.is_empty() { Err(StudyError::Empty(first())) } else { Ok(all) }
}

fn of_scores(run: &Run, case: &Case, method: &Method, scores: Scores) -> Vec<Observation> {
    let skin_tone = scores.skin_tone;
    let of_row = |row| Observation {
        suite: run.suite.clone(),
        case: case.id.clone(),
        face: case.face.clone(),
        skin_tone,
        light: case.light.clone(),
        variant: case.variant.clone(),
        seed: case.seed,
        method: method.of.clone().unwrap_or_else(|| method.id.clone()),
        method_seed: method.seed,
        kind: method.kind.clone(),
        class: method.class.clone(),
        row,
    };
    scores.rows.into_iter().map(of_row).collect()
}

const COLUMNS: [&str; 22] = [
    "suite",
    "case",
    "face",
    "skin_tone",
    "light",
    "variant",
    "seed",
    "method",
    "method_seed",
    "kind",
    "class",
    "subject",
    "relit_light",
    "metric",
    "scale",
    "region",
    "label",
    "value",
    "ci95_low",
    "ci95_high",
    "n",
    "floor",
];

/// The tidy table: one line per case, method, subject, metric, scale; empty where there is nothing.
pub fn tidy_csv(observations: &[Observation]) -> String {
    let mut text = csv_line(COLUMNS.map(str::to_owned));
    for of in observations {
        let (row, ci95) = (&of.row, of.row.ci95);
        let maybe = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let seed = |value: Option<u64>| value.map_or(String::new(), |value| value.to_string());
        let word = |value: &Option<String>| value.clone().unwrap_or_default();
        text.push_str(&csv_line([
            of.suite.clone(),
            of.case.clone(),
            of.face.clone(),
            maybe(of.skin_tone),
            of.light.clone(),
            word(&of.variant),
            seed(of.seed),
            of.method.clone(),
            seed(of.method_seed),
            of.kind.clone(),
            of.class.clone(),
            row.subject.clone(),
            word(&row.light),
            row.metric.clone(),
            row.scale.clone(),
            row.region.clone(),
            word(&row.label),
            maybe(row.value),
            maybe(ci95.map(|ci95| ci95[0])),
            maybe(ci95.map(|ci95| ci95[1])),
            row.n.to_string(),
            maybe(row.floor),
        ]));
    }
    text
}

/// A line of CSV (RFC 4180, but for the line's end).
pub(super) fn csv_line(cells: impl IntoIterator<Item = String>) -> String {
    let quoted = |cell: String| {
        if cell.contains(['"', ',', '\n', '\r']) {
            format!("\"{}\"", cell.replace('"', "\"\""))
        } else {
            cell
        }
    };
    let cells: Vec<String> = cells.into_iter().map(quoted).collect();
    format!("{}\n", cells.join(","))
}
