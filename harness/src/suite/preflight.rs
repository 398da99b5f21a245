//! Checks before the first picture is rendered: faults that would else show hours later.

use std::path::Path;

use formats::atomic;

use super::cases::Case;
use super::error::RunError;
use super::file::Suite;
use super::method::{Method, MethodKind};
use super::perceptual;
use super::place;
use super::program::ProgramFiles;
use super::scene::SceneError;
use super::tools::Tools;
use crate::synth::{StageError, cli_args, run_stage};

/// Cameras of a rig that does not say how many it has.
const CAMERAS: i64 = 16;

/// A method with what was found of its program.
pub(super) struct Ready<'a> {
    pub method: &'a Method,
    /// Files of a program; none for methods that are ours.
    pub files: Option<ProgramFiles>,
    /// Whether it can be run. Only one that is not to be run may be otherwise.
    pub found: bool,
}

/// Finds every program and opens every backend; a fault names the table of the suite.
pub(super) fn methods<'a>(suite: &'a Suite, tools: &Tools) -> Result<Vec<Ready<'a>>, RunError> {
    let ready = |method: &'a Method| -> Result<Ready<'a>, RunError> {
        let wrong = |key: &str, reason: String| {
            SceneError::in_table(&suite.path, &method.stated, key, reason)
        };
        let files = match &method.kind {
            MethodKind::Program(program) => {
                if let Some(missing) = program.inputs.iter().find(|input| !input.exists()) {
                    let reason =
                        format!("there is no {}; name a file or folder", missing.display());
                    return Err(wrong("inputs", reason).into());
                }
                let key = program.key();
                Some(program.find(&tools.interpreter).map_err(|reason| wrong(key, reason))?)
            }
            MethodKind::Fields { backend, .. } => {
                backend.open().map_err(|error| wrong("backend", error.to_string()))?;
                None
            }
            MethodKind::Oracle
            | MethodKind::LabelMeans
            | MethodKind::Baseline { .. }
            | MethodKind::Competitor { .. } => None,
        };
        Ok(Ready { method, files, found: true })
    };
    let unless_left_out = |method: &'a Method| match ready(method) {
        Err(_) if !suite.runs_method(method) => Ok(Ready { method, files: None, found: false }),
        result => result,
    };
    suite.methods.iter().map(unless_left_out).collect()
}

/// The judge that the suite asks for can be called.
pub(super) fn judge(suite: &Suite, tools: &Tools) -> Result<(), RunError> {
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

/// Every file is there that the scenes name of cases that are run.
pub(super) fn files(suite: &Suite) -> Result<(), RunError> {
    for case in suite.cases.iter().filter(|case| suite.runs_case(case)) {
        for file in case.scene.files() {
            if !file.is_file() {
                let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let place = place::only(&place::sources(&suite.path), |line| line.contains(&name));
                let place = place.map_or(String::new(), |place| format!(" (named in {place})"));
                let reason = format!("there is no such file{place}");
                return Err(SceneError::Read { path: file, reason }.into());
            }
        }
    }
    Ok(())
}

/// Lets the renderer read the scenes of `cases`, which lie in `captures`, before it renders one.
pub(super) fn scenes(
    suite: &Suite,
    cases: &[&Case],
    captures: &Path,
    tools: &Tools,
) -> Result<(), RunError> {
    for case in cases {
        let file = captures.join(format!("{}.toml", case.id));
        let arguments = cli_args(&[("--scene", file.as_os_str())]);
        let silent = &mut |_, _, _: &str| {};
        run_stage(&tools.interpreter, "check", &arguments, &tools.interrupt, silent)
            .map_err(|error| place::blamed(error, &file, &suite.path))?;
    }
    Ok(())
}

/// There is room for what the cases leave: about half of it uncompressed.
pub(super) fn space(suite: &Suite, cases: &[&Case], out: &Path) -> Result<(), RunError> {
    let bytes: u64 = cases.iter().map(|case| case_bytes(case, suite.methods.len() as u64)).sum();
    Ok(atomic::require_space(out, bytes / 2)?)
}

/// Bytes that are free where `out` will lie, if the system says.
pub(super) fn free(out: &Path) -> Option<u64> {
    let absolute = std::path::absolute(out).ok()?;
    let state = absolute.ancestors().find_map(|at| rustix::fs::statvfs(at).ok())?;
    Some(state.f_bavail.saturating_mul(state.f_frsize))
}

/// Uncompressed: 25 floats for a view with its layers, nine for every relit one, and 13 for a texel.
fn case_bytes(case: &Case, methods: u64) -> u64 {
    let number = |section: &str, key: &str, default: i64| -> u64 {
        let value = case.scene.table.get(section).and_then(|table| table.get(key)?.as_integer());
        value.unwrap_or(default).max(1).unsigned_abs()
    };
    let pixels = number("render", "width", 512) * number("render", "height", 512);
    let texels = number("face", "texture_size", 512).pow(2);
    let (train, test) = (number("rig", "train", CAMERAS), number("rig", "test", CAMERAS / 4));
    let lights = case.scene.relight().len() as u64 + 1;
    let capture = pixels * ((train + test) * 25 + test * lights * 9) + texels * 13;
    let method = texels * 13 + pixels * test * lights * 2 * 9;
    4 * (capture + methods * method)
}
