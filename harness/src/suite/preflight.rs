//! Checks before the first picture is rendered: faults that would else show hours later.

use std::path::{Path, PathBuf};

use formats::atomic;

use super::case_size::CaseSize;
use super::cases::Case;
use super::error::RunError;
use super::file::Suite;
use super::method::Method;
use super::near;
use super::packaged::Kind;
use super::perceptual;
use super::place;
use super::program::ProgramFiles;
use super::scene::SceneError;
use crate::synth::Tools;
use crate::synth::{Request, StageError};

/// A method with what was found of its program.
pub(super) struct ResolvedMethod<'a> {
    pub method: &'a Method,
    /// Files of a program; none for methods that are ours.
    pub files: Option<ProgramFiles>,
    /// False if its program or backend is missing, which only a method that `--method` excludes may be.
    pub found: bool,
}

/// Refuses whatever can be found wrong without a run's folder.
pub(super) fn all<'a>(
    suite: &'a Suite,
    redo: &[String],
    tools: &Tools,
) -> Result<Vec<ResolvedMethod<'a>>, RunError> {
    let ids: Vec<_> = suite.methods.iter().map(|method| method.id.as_str()).collect();
    if let Some(name) = redo.iter().find(|name| !ids.contains(&name.as_str())) {
        let reason = near::unknown("the suite has no method", name, &ids);
        return Err(RunError::UnknownName { flag: "--redo", reason });
    }
    files(suite)?;
    judge(suite, tools)?;
    methods(suite, tools)
}

/// Finds every program and opens every backend; a fault names the table of the suite.
pub(super) fn methods<'a>(
    suite: &'a Suite,
    tools: &Tools,
) -> Result<Vec<ResolvedMethod<'a>>, RunError> {
    let resolve = |method: &'a Method| match method.work().find(&tools.interpreter) {
        Ok(files) => Ok(ResolvedMethod { method, files, found: true }),
        Err(_) if !suite.runs_method(method) => {
            Ok(ResolvedMethod { method, files: None, found: false })
        }
        Err((key, reason)) => {
            Err(SceneError::in_table(&suite.path, &method.stated, key, reason).into())
        }
    };
    suite.methods.iter().map(resolve).collect()
}

/// Refuses a suite whose metrics or network cannot be called.
fn judge(suite: &Suite, tools: &Tools) -> Result<(), RunError> {
    match suite.metrics.key(tools) {
        Err(RunError::Stage(StageError::Input { message, .. }) | RunError::Submission(message)) => {
            return Err(SceneError::value(&suite.path, "metrics", message).into());
        }
        other => drop(other?),
    }
    let Some(net) = suite.lpips else { return Ok(()) };
    match perceptual::require(net, tools) {
        Err(RunError::Stage(StageError::Input { message, .. })) => {
            Err(SceneError::value(&suite.path, "lpips", message).into())
        }
        other => other,
    }
}

/// Refuses a suite whose cases name a file that is missing.
fn files(suite: &Suite) -> Result<(), RunError> {
    for case in suite.cases.iter().filter(|case| suite.runs_case(case)) {
        for file in case.scene.files() {
            if !file.is_file() {
                let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let place = place::only(&place::sources(&suite.path, Kind::Suite), |_, entry| {
                    entry.text.as_ref().is_some_and(|text| text.ends_with(&name))
                });
                let place = place.map_or(String::new(), |place| format!(" (named in {place})"));
                let reason = format!("there is no such file{place}");
                return Err(SceneError::Read { path: file, reason }.into());
            }
        }
    }
    Ok(())
}

/// Lets the renderer read the scenes of `cases` before it renders one.
pub(super) fn scenes(suite: &Suite, cases: &[&Case], tools: &Tools) -> Result<(), RunError> {
    if cases.is_empty() {
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    let scenes: Vec<PathBuf> =
        cases.iter().map(|case| case.write_scene(folder.path())).collect::<Result<_, _>>()?;
    tools
        .ask(&Request::Check { scenes: &scenes })
        .map_err(|error| place::located(error, &scenes, &suite.path, Kind::Suite))?;
    Ok(())
}

/// Refuses a disc without room for what the cases leave, about half of it uncompressed.
pub(super) fn space(suite: &Suite, cases: &[&Case], out: &Path) -> Result<(), RunError> {
    let methods = suite.methods.len() as f64;
    let sizes = cases.iter().map(|case| CaseSize::of(case));
    let bytes: f64 = sizes.map(|size| size.capture_bytes() + methods * size.method_bytes()).sum();
    Ok(atomic::require_space(out, (bytes / 2.0) as u64)?)
}

/// Bytes that are free where `out` will lie, if the system says.
pub(super) fn free(out: &Path) -> Option<u64> {
    let absolute = std::path::absolute(out).ok()?;
    let state = absolute.ancestors().find_map(|at| rustix::fs::statvfs(at).ok())?;
    Some(state.f_bavail.saturating_mul(state.f_frsize))
}
