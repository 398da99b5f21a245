//! Single stages of a suite, for machines that have no run but what such a stage reads.

use std::fs;
use std::io;
use std::path::Path;

use formats::atomic;
use formats::content_hash::hash_parts;
use serde::{Deserialize, Serialize};

use super::error::RunError;
use super::file::Suite;
use super::output::Output;
use super::plan::{Kind, Task, plan};
use super::preflight;
use super::processors::keep_to;
use super::program;
use super::record::{Record, Records};
use super::sources::{SCORE_SOURCES, SOLVER_SOURCES};
use super::tools::Tools;
use super::workshop::{Contents, Done, Workshop};
use crate::synth::Fingerprints;

/// A stage that is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// Its id.
    pub id: &'a str,
    /// Hashes of the outputs that it reads, by ids.
    pub contents: &'a Contents,
    /// Versions and code of the renderer here, as `check_worker` found them.
    pub renderer: &'a Fingerprints,
    /// Processors that it keeps to; none is all.
    pub processors: &'a Option<Vec<usize>>,
}

/// Outcome of a stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartDone {
    /// Key of its inputs.
    pub key: String,
    /// Record of its output, unless its method failed.
    #[serde(default)]
    pub record: Option<Record>,
    /// Why its method failed.
    #[serde(default)]
    pub failed: Option<String>,
}

/// Versions and sources of all of unshade: where they are equal, two machines give the same bytes.
pub(super) fn versions(renderer: &Fingerprints) -> String {
    let [solver, scores] = [SOLVER_SOURCES, SCORE_SOURCES];
    format!("{} {renderer} solver={solver} scores={scores}", env!("CARGO_PKG_VERSION"))
}

/// Hash of a suite's file and of the scenes that it leads to.
pub(super) fn content(suite: &Suite) -> Result<String, RunError> {
    let mut parts = vec![suite.text.clone()];
    for case in &suite.cases {
        parts.push(case.scene.to_toml().map_err(io::Error::other)?);
        parts.push(case.scene.content()?);
    }
    Ok(hash_parts(&parts.iter().map(String::as_str).collect::<Vec<_>>()))
}

/// Does a stage of `suite` in the folder `out`, which holds what it reads. With `key_only`, only says what it
/// is made from.
pub fn run_part(
    suite: &Suite,
    out: &Path,
    wanted: Wanted,
    key_only: bool,
    tools: &Tools,
    step: &mut (dyn FnMut(u64, u64, &str) + Send),
) -> Result<PartDone, RunError> {
    let Wanted { id, contents, renderer, processors } = wanted;
    let tasks = plan(suite);
    let unknown = || RunError::Folder(io::Error::other(format!("the suite has no stage {id}")));
    let task = tasks.iter().find(|task| task.id == id).ok_or_else(unknown)?;
    let ready = preflight::methods(suite, tools)?;
    let workshop = Workshop::new(suite, out, tools, renderer, &ready, &[]);
    let key = workshop.key(task, contents)?.hash;
    // Before what it reads is put there.
    atomic::claim(out)?;
    if key_only {
        return Ok(PartDone { key, ..PartDone::default() });
    }
    let records = Records::open(out)?;
    program::clear_scratch(&program::scratch_prefix(out));
    if task.kind == Kind::Capture {
        write_scene(suite, task, out)?;
    }
    match keep_to(processors, formats::cancel::flag(), || {
        workshop.run(task, contents, &records, step)
    }) {
        Ok(Done { record, .. }) => Ok(PartDone { key, record: Some(record), failed: None }),
        Err(error) if task.method.is_some() && error.is_of_method() => {
            Ok(PartDone { key, record: None, failed: Some(error.to_string()) })
        }
        Err(error) => Err(error),
    }
}

fn write_scene(suite: &Suite, task: &Task, out: &Path) -> Result<(), RunError> {
    let case = &suite.cases[task.case];
    let folder = out.join(Kind::Capture.folder());
    fs::create_dir_all(&folder)?;
    let scene = case.scene.to_toml().map_err(io::Error::other)?;
    Ok(atomic::write_file(&folder.join(format!("{}.toml", case.id)), scene.as_bytes())?)
}

/// Takes the output of a stage that lies in the run's folder, and was made elsewhere, for finished.
pub fn adopt(run: &Path, key: &str, id: &str, output: &Output) -> Result<(), RunError> {
    Ok(Records::of(run).adopt(id, key, output)?)
}
