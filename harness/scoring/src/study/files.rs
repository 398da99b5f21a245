//! The folder of a study: pages and tables of the same numbers.

use std::fs;
use std::path::{Path, PathBuf};

use formats::atomic::{self, Folder};
use serde::Serialize;
use serde_json::Value;

use super::statistics::Study;
use super::{Observation, StudyError, tidy_csv};
use crate::tables::csv_line;

/// Writes `out`, completely or not at all: `study.md`, `study.json`, `scores.csv` (every score, one a
/// line) and a CSV of each table. Equal runs give equal bytes.
pub fn write_study(
    study: &Study,
    observations: &[Observation],
    runs: &[PathBuf],
    out: &Path,
    command: &str,
) -> Result<(), StudyError> {
    let inputs: Vec<&Path> = runs.iter().map(PathBuf::as_path).collect();
    atomic::refuse_overlap(out, &inputs)?;
    let folder = Folder::begin(out)?;
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).map_err(|error| StudyError::io(&path, error))
    };
    write("study.md", &study.markdown(command))?;
    write("study.json", &json(study, out)?)?;
    write("scores.csv", &tidy_csv(observations))?;
    write("means.csv", &csv(&study.summaries, out)?)?;
    write("comparisons.csv", &csv(&study.comparisons, out)?)?;
    write("components.csv", &csv(&study.components, out)?)?;
    write("fairness.csv", &csv(&study.fairness, out)?)?;
    Ok(folder.commit()?)
}

fn json(study: &Study, out: &Path) -> Result<String, StudyError> {
    let text = serde_json::to_string_pretty(study).map_err(|error| StudyError::text(out, error))?;
    Ok(format!("{text}\n"))
}

/// One line for each record, a column for each number: pairs become two, lists one for each element.
fn csv<T: Serialize>(records: &[T], out: &Path) -> Result<String, StudyError> {
    let mut rows: Vec<Vec<(String, String)>> = Vec::new();
    for record in records {
        let value = serde_json::to_value(record).map_err(|error| StudyError::text(out, error))?;
        let mut row = Vec::new();
        flatten("", &value, &mut row);
        rows.push(row);
    }
    let mut columns: Vec<&str> = Vec::new();
    for (name, _) in rows.iter().flatten() {
        if !columns.contains(&name.as_str()) {
            columns.push(name);
        }
    }
    // What is null in one record is a pair in another.
    columns.retain(|name| !rows.iter().flatten().any(|(other, _)| other == &format!("{name}_1")));
    let mut text = csv_line(&columns) + "\n";
    for row in &rows {
        let cell = |name: &&str| {
            row.iter().find(|(other, _)| other == name).map_or("", |(_, cell)| cell.as_str())
        };
        text += &csv_line(columns.iter().map(cell));
        text.push('\n');
    }
    Ok(text)
}

fn flatten(name: &str, value: &Value, row: &mut Vec<(String, String)>) {
    let below = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}_{key}") };
    match value {
        Value::Object(fields) => {
            fields.iter().for_each(|(key, value)| flatten(&below(key), value, row));
        }
        Value::Array(list) => {
            list.iter()
                .enumerate()
                .for_each(|(i, v)| flatten(&below(&(i + 1).to_string()), v, row));
        }
        Value::Null => row.push((name.to_owned(), String::new())),
        Value::String(text) => row.push((name.to_owned(), text.clone())),
        other => row.push((name.to_owned(), other.to_string())),
    }
}
