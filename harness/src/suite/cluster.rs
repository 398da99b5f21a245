//! A suite's stages on other machines: what is to be done goes to a client of Dask, and what comes back is
//! taken for finished.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::time::Instant;

use serde::Deserialize;
use serde_json::{Value, json};

use super::error::RunError;
use super::executor::{Contents, StageExecutor};
use super::file::Suite;
use super::finished::Record;
use super::observer::Observer;
use super::plan::Stage;
use super::record::Records;
use super::remote_stage::{content, versions};
use crate::synth::Tools;
use crate::synth::{Fingerprints, Request};

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
    executor: &StageExecutor,
    plan: &[Stage],
    cluster: &Cluster,
    records: &Records,
    observer: &mut dyn Observer,
) -> Result<Elsewhere, RunError> {
    let tools = executor.tools;
    let order = order(executor, plan, records)?;
    let store = match &cluster.store {
        Some(store) => store.clone(),
        None => std::path::absolute(executor.out)?.join("store").to_string_lossy().into_owned(),
    };
    let request = Request::Cluster {
        order: &order,
        address: &cluster.address,
        store: &store,
        workers: cluster.workers,
    };
    let start = Instant::now();
    observer.stage_begins("cluster", 0, plan.len() + 1);
    let result = tools.run(
        &request,
        &mut |done, total, what| match serde_json::from_str::<Ended>(what) {
            Ok(Ended { stage, seconds }) => {
                observer.step("cluster", done, total, &stage);
                observer.stage_ends(&stage, Some(seconds));
            }
            Err(_) => observer.step("cluster", done, total, what),
        },
    )?;
    observer.stage_ends("cluster", Some(start.elapsed().as_secs_f64()));
    Ok(serde_json::from_value(result).map_err(io::Error::from)?)
}

/// The stages with what they read, and what is valid already.
fn order(executor: &StageExecutor, plan: &[Stage], records: &Records) -> Result<Value, RunError> {
    let StageExecutor { suite, out, renderer, .. } = executor;
    let mut contents = Contents::new();
    let mut tasks = Vec::new();
    for stage in plan {
        let output = executor.kept(stage, &contents, records)?.map(|kept| kept.record.output);
        match &output {
            Some(output) => drop(contents.insert(stage.id.clone(), output.clone())),
            None if !stage.wanted => continue,
            // What comes back takes its place.
            None => records.set_aside(&stage.id, "", &executor.path(stage))?,
        }
        tasks.push(json!({
            "id": stage.id, "after": stage.after.iter().map(|at| &plan[*at].id).collect::<Vec<_>>(),
            "path": stage.path, "case": suite.cases[stage.case].id, "output": output,
            "name": stage.cell(suite),
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
