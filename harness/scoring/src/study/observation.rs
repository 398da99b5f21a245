//! Every score of finished runs with the case and the method it is of: the tidy table.

use std::collections::BTreeSet;
use std::path::PathBuf;

use serde::Serialize;

use super::StudyError;
use crate::run::{Case, Method, RunFile};
use crate::score::{Row, Scores};
use crate::tables::{csv_line, csv_number};

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

/// Reads the scores of finished runs, in the order of the runs, cases and rows. A method's result
/// on a case may be there once.
pub fn observations(runs: &[PathBuf]) -> Result<Vec<Observation>, StudyError> {
    let mut all = Vec::new();
    let mut seen = BTreeSet::new();
    for folder in runs {
        if folder.is_dir() && !folder.join("run.json").exists() {
            return Err(StudyError::Empty(folder.clone()));
        }
        let run = RunFile::open(folder)?;
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

fn of_scores(run: &RunFile, case: &Case, method: &Method, scores: Scores) -> Vec<Observation> {
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
        kind: method.kind.name().to_owned(),
        class: method.class.name().to_owned(),
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
    let mut text = csv_line(COLUMNS) + "\n";
    for of in observations {
        let (row, ci95) = (&of.row, of.row.ci95);
        let word = |value: &Option<String>| value.clone().unwrap_or_default();
        text += &csv_line([
            of.suite.clone(),
            of.case.clone(),
            of.face.clone(),
            csv_number(of.skin_tone),
            of.light.clone(),
            word(&of.variant),
            csv_number(of.seed),
            of.method.clone(),
            csv_number(of.method_seed),
            of.kind.clone(),
            of.class.clone(),
            row.subject.clone(),
            word(&row.light),
            row.metric.clone(),
            row.scale.clone(),
            row.region.clone(),
            word(&row.label),
            csv_number(row.value),
            csv_number(ci95.map(|ci95| ci95[0])),
            csv_number(ci95.map(|ci95| ci95[1])),
            row.n.to_string(),
            csv_number(row.floor),
        ]);
        text.push('\n');
    }
    text
}
