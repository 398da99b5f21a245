//! One stage of a suite on a machine that has only its inputs.

use std::io;
use std::path::Path;

use formats::atomic;
use formats::content_hash::hash_parts;
use serde::{Deserialize, Serialize};

use super::error::RunError;
use super::executor::{Contents, StageExecutor, StageResult};
use super::file::Suite;
use super::finished::Record;
use super::output::OutputHashes;
use super::plan::{StageKind, plan};
use super::preflight;
use super::processors::keep_to;
use super::program;
use super::record::Records;
use super::sources::{SCORE_SOURCES, SOLVER_SOURCES};
use crate::synth::Fingerprints;
use crate::synth::Tools;

/// A requested stage.
#[derive(Clone, Copy, Debug)]
pub struct RemoteStage<'a> {
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
pub struct RemoteResult {
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

/// Executes a stage of `suite` in the folder `out`, which holds its inputs. With `key_only`, only computes its key.
pub fn run_remote_stage(
    suite: &Suite,
    out: &Path,
    stage: RemoteStage,
    key_only: bool,
    tools: &Tools,
    step: &mut (dyn FnMut(u64, u64, &str) + Send),
) -> Result<RemoteResult, RunError> {
    let RemoteStage { id, contents, renderer, processors } = stage;
    let stages = plan(suite);
    let unknown = || RunError::Folder(io::Error::other(format!("the suite has no stage {id}")));
    let stage = stages.iter().find(|stage| stage.id == id).ok_or_else(unknown)?;
    let methods = preflight::methods(suite, tools)?;
    let executor = StageExecutor::new(suite, out, tools, renderer, &methods, &[]);
    let key = executor.key(stage, contents)?.hash;
    // Before what it reads is put there.
    atomic::claim(out)?;
    if key_only {
        return Ok(RemoteResult { key, ..RemoteResult::default() });
    }
    let records = Records::open(out)?;
    program::clear_scratch(&program::scratch_prefix(out));
    if stage.kind == StageKind::Capture {
        suite.cases[stage.case].write_scene(&out.join(StageKind::Capture.folder()))?;
    }
    let execute = || executor.run(stage, contents, &records, step);
    match keep_to(processors, formats::cancel::flag(), execute) {
        Ok(StageResult { record, .. }) => {
            Ok(RemoteResult { key, record: Some(record), failed: None })
        }
        Err(error) if stage.method.is_some() && error.is_of_method() => {
            Ok(RemoteResult { key, record: None, failed: Some(error.to_string()) })
        }
        Err(error) => Err(error),
    }
}

/// Takes the output of a stage that lies in the run's folder, and was made elsewhere, for finished.
pub fn adopt(run: &Path, key: &str, id: &str, output: &OutputHashes) -> Result<(), RunError> {
    Ok(Records::of(run).write(id, key, output)?)
}
