//! A suite's stages on other machines: what is to be done goes to a client of Dask, and what comes back is
//! taken for finished.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

use serde::Deserialize;
use serde_json::{Value, json};

use super::error::RunError;
use super::file::Suite;
use super::part::{content, versions};
use super::plan::{Kind, Task};
use super::record::{Record, Records};
use super::tools::{Observer, Tools};
use super::workshop::{Contents, Workshop};
use crate::synth::{Fingerprints, cli_args, run_stage};

/// Where stages are done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cluster {
    /// Address of Dask's scheduler, or `local` for workers that are started here.
    pub address: String,
    /// Store of all machines: a folder, or a URL that fsspec knows.
    pub store: Option<String>,
    /// How many workers `local` starts.
    pub workers: usize,
}

/// The client's last line.
#[derive(Default, Deserialize)]
pub(super) struct Elsewhere {
    #[serde(default)]
    pub failed: BTreeMap<String, String>,
    #[serde(default)]
    pub records: Vec<Record>,
}

/// The client's line on a stage that ended.
#[derive(Deserialize)]
struct Ended {
    stage: String,
    seconds: f64,
}

/// Does the stages of `plan` that no valid output is there of.
pub(super) fn run(
    workshop: &Workshop,
    plan: &[Task],
    cluster: &Cluster,
    records: &Records,
    observer: &mut dyn Observer,
) -> Result<Elsewhere, RunError> {
    let tools = workshop.tools;
    let order = order(workshop, plan, records)?;
    let mut file = tempfile::Builder::new().prefix("unshade-").suffix(".json").tempfile()?;
    file.write_all(&serde_json::to_vec(&order).map_err(io::Error::from)?)?;
    let workers = cluster.workers.to_string();
    let store = match &cluster.store {
        Some(store) => store.clone(),
        None => std::path::absolute(workshop.out)?.join("store").to_string_lossy().into_owned(),
    };
    let arguments = cli_args(&[
        ("--order", file.path().as_os_str()),
        ("--address", OsStr::new(&cluster.address)),
        ("--store", OsStr::new(&store)),
        ("--workers", OsStr::new(&workers)),
    ]);
    let start = Instant::now();
    observer.stage_begins("cluster", 0, plan.len() + 1);
    let said = run_stage(
        &tools.interpreter,
        "cluster",
        &arguments,
        &tools.interrupt,
        &mut |done, total, what| match serde_json::from_str::<Ended>(what) {
            Ok(Ended { stage, seconds }) => {
                observer.step("cluster", done, total, &stage);
                observer.stage_ends(&stage, Some(seconds));
            }
            Err(_) => observer.step("cluster", done, total, what),
        },
    );
    let said = said?;
    observer.stage_ends("cluster", Some(start.elapsed().as_secs_f64()));
    Ok(serde_json::from_value(said).map_err(io::Error::from)?)
}

/// The stages with what they read, and what is valid already.
fn order(workshop: &Workshop, plan: &[Task], records: &Records) -> Result<Value, RunError> {
    let Workshop { suite, out, renderer, .. } = workshop;
    let mut contents = Contents::new();
    let mut tasks = Vec::new();
    for task in plan {
        let (key, path) = (workshop.key(task, &contents).ok(), workshop.path(task));
        let valid = key.map(|key| records.valid(&task.id, &key.hash, &path)).transpose()?.flatten();
        match &valid {
            Some(record) => drop(contents.insert(task.id.clone(), record.output.clone())),
            None if !task.wanted => continue,
            // What comes back takes its place.
            None => records.set_aside(&task.id, "", &path)?,
        }
        tasks.push(json!({
            "id": task.id, "after": task.after.iter().map(|at| &plan[*at].id).collect::<Vec<_>>(),
            "path": task.path, "case": suite.cases[task.case].id, "output": valid.map(|record| record.output),
            "name": task.name(suite).filter(|_| task.kind >= Kind::Maps),
        }));
    }
    Ok(json!({
        "suite": absolute(&suite.path)?, "run": absolute(out)?, "tasks": tasks,
        "suite_content": content(suite)?, "versions": versions(renderer),
    }))
}

fn absolute(path: &Path) -> io::Result<String> {
    Ok(std::path::absolute(path)?.to_string_lossy().into_owned())
}

/// Refuses to work for a suite that this machine has otherwise, or with another version; returns the renderer's versions
/// and code, which takes a start of Python.
pub fn check_worker(
    suite: &Suite,
    suite_content: &str,
    wanted: &str,
    tools: &Tools,
) -> Result<Fingerprints, RunError> {
    let renderer = tools.interpreter.fingerprints()?;
    let here = versions(&renderer);
    if here != wanted {
        return Err(RunError::Worker(format!(
            "has another version ({here}) than what sends the work ({wanted}); install the same on all"
        )));
    }
    if content(suite)? != suite_content {
        let path = suite.path.display();
        return Err(RunError::Worker(format!(
            "{path}, or a file that it names, differs between this worker and the client; use a shared folder"
        )));
    }
    Ok(renderer)
}
