//! Pictures that are compared with the truth's relit ones: maps relit, or a method's own pictures.

use std::fs;
use std::path::Path;

use formats::atomic::Folder;
use scoring::score;

use super::error::RunError;
use super::method::{Method, MethodKind};
use super::program::Gives;
use super::stages::{Relight, relight};
use super::tools::Tools;
use crate::synth::{cli_args, run_stage};

impl Method {
    /// Whether it is handed the lights and gives pictures.
    pub(super) fn gives_pictures(&self) -> bool {
        matches!(&self.kind, MethodKind::Program(program) if program.gives == Gives::Pictures)
    }
}

/// Writes the relit pictures of a method: its own where it gave some, else its maps relit by `renderer`,
/// else none.
pub(super) fn relit(
    renderer: &str,
    method: &Method,
    [capture, maps, out]: [&Path; 3],
    scales: &[&str],
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    if !method.gives_pictures() || maps.join("diffuse_albedo.exr").is_file() && !own(maps) {
        let relit = Relight { capture, maps, out, renderer, scales, light: None };
        return relight(&relit, tools, step);
    }
    if own(maps) {
        return Ok(score::keep_own_relit(capture, maps, out, scales)?);
    }
    let folder = Folder::begin(out)?;
    fs::write(folder.path().join("relit.json"), "{\"scales\": {}}\n")?;
    Ok(folder.commit()?)
}

fn own(maps: &Path) -> bool {
    maps.join("relit").is_dir()
}

/// Writes the lights of a capture, without its own, as lat-long pictures.
pub(super) fn lights(
    capture: &Path,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let arguments = cli_args(&[("--capture", capture.as_os_str()), ("--out", out.as_os_str())]);
    run_stage(&tools.interpreter, "lights", &arguments, &tools.interrupt, step)?;
    Ok(())
}
