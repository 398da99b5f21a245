//! The origin of each method's maps: the time, the program, its cost, and the reason of a failure.

use std::fs;
use std::path::Path;

use serde::Serialize;

use super::comparison_figures;
use super::error::ReportError;
use super::run::{Case, Timing};
use super::save::write_file;
use super::table::{Column, EMPTY};

/// Bytes of a log that are kept, from its end.
const LOG: usize = 256 << 10;
const GIB: f64 = (1u64 << 30) as f64;

/// One method in one case.
#[derive(Serialize)]
pub(super) struct MethodRow {
    title: String,
    failed: Option<String>,
    made: String,
    seconds: String,
    memory: String,
    /// True if the kernel kept the program to its files; none for built-in methods.
    confined: Option<bool>,
    /// The network that it could reach; none for built-in methods.
    network: Option<&'static str>,
    log: Option<String>,
}

/// A row for every column; logs are written below `root`.
pub(super) fn rows(
    run: &Path,
    case: &Case,
    columns: &[Column],
    timing: &Timing,
    root: &Path,
) -> Result<Vec<MethodRow>, ReportError> {
    let row = |column: &Column| -> Result<MethodRow, ReportError> {
        let name = format!("{}/{}", case.id, column.method.id);
        let failed = column.method.failed.clone();
        let id = format!("maps/{name}");
        let stage = timing.stages.iter().find(|stage| stage.id == id && failed.is_none());
        let made = stage.map(|stage| &stage.made);
        let mut words: Vec<String> = Vec::new();
        if let Some(made) = made {
            words.extend([&made.at, &made.from].into_iter().filter(|w| !w.is_empty()).cloned());
        }
        if stage.is_some_and(|stage| stage.cached) {
            words.push("kept from an earlier run".to_owned());
        }
        let log = run.join("logs").join(format!("{name}.txt"));
        Ok(MethodRow {
            title: column.method.title().to_owned(),
            failed,
            made: if words.is_empty() { EMPTY.to_owned() } else { words.join("; ") },
            seconds: stage.map_or(EMPTY.to_owned(), |stage| format!("{:.1} s", stage.seconds)),
            memory: made
                .and_then(|made| made.peak_bytes)
                .map_or(EMPTY.to_owned(), |bytes| format!("{:.2} GiB", bytes as f64 / GIB)),
            confined: made.and_then(|made| made.confined),
            network: made.and_then(|made| made.network.as_deref()).map(|network| match network {
                "closed" => "no network",
                "tcp" => "no TCP, but UDP",
                _ => "the network",
            }),
            log: keep_log(&log, &case.id, &column.method.id, root)?,
        })
    };
    columns.iter().map(row).collect()
}

fn keep_log(
    log: &Path,
    case: &str,
    method: &str,
    root: &Path,
) -> Result<Option<String>, ReportError> {
    let Ok(text) = fs::read(log) else { return Ok(None) };
    let name = format!(
        "data/{}/{}.log.txt",
        comparison_figures::file_name(case),
        comparison_figures::file_name(method)
    );
    write_file(&root.join(&name), &text[text.len().saturating_sub(LOG)..])?;
    Ok(Some(name))
}
