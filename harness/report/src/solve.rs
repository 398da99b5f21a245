//! A method's record of its own solve: configuration, losses, and the pictures it leaves.

use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::comparison_figures::{MethodFolders, Studio};
use super::contact_sheets::ContactSheet;
use super::curve;
use super::error::ReportError;
use super::run;

/// The stage in which a solve was cut; null or absent in one that came to its end.
const INTERRUPTED: &str = "interrupted";

/// One method's solve, as the template shows it.
#[derive(Serialize)]
pub(super) struct Solve {
    title: String,
    /// The stage that was cut.
    interrupted: Option<String>,
    curve: Option<String>,
    sheets: Vec<ContactSheet>,
    facts: Vec<(String, String)>,
}

impl Studio<'_> {
    /// The record in the maps folder of a method; none of a method that leaves maps alone.
    pub fn solve(&self, method: &MethodFolders, maps: &Path) -> Result<Option<Solve>, ReportError> {
        let record = run::read_json_if_present::<Value>(&maps.join("solve.json"))?;
        let sheets = self.sheets(method, maps)?;
        if record.is_none() && sheets.is_empty() {
            return Ok(None);
        }
        let record = record.unwrap_or_default();
        let mut facts = Vec::new();
        if let Value::Object(entries) = &record {
            for (key, value) in entries {
                if key != curve::HISTORY && key != INTERRUPTED {
                    flatten(key, value, &mut facts);
                }
            }
        }
        Ok(Some(Solve {
            title: method.column.method.title().to_owned(),
            interrupted: interrupted(&record),
            curve: curve::svg(&curve::stages(&record)),
            sheets,
            facts,
        }))
    }
}

/// The stage in which the solve of a `solve.json` was cut.
pub(super) fn interrupted(record: &Value) -> Option<String> {
    record.get(INTERRUPTED)?.as_str().map(str::to_owned)
}

/// Nested tables as dotted keys, in the order of the file.
fn flatten(key: &str, value: &Value, facts: &mut Vec<(String, String)>) {
    match value {
        Value::Object(entries) => {
            for (name, value) in entries {
                flatten(&format!("{key}.{name}"), value, facts);
            }
        }
        value => facts.push((key.to_owned(), plain(value))),
    }
}

/// A JSON value as a reader expects it: a text without its quotes.
pub(super) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
