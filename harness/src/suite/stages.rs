//! The stages that the path tracer does, one call each.

use std::ffi::{OsStr, OsString};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use formats::atomic;
use scoring::score;

use super::error::RunError;
use super::place;
use super::scene::Scene;
use super::tools::Tools;
use crate::synth::run_stage;

/// Renders the scene file `scene` into the capture folder `out`.
pub fn synth(
    scene: &Path,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let file = resolved(scene)?;
    let inputs = Scene::open(scene)?.files();
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).chain([scene]).collect();
    atomic::apart(out, &inputs)?;
    let arguments = words(&[("--scene", file.path().as_os_str()), ("--out", out.as_os_str())]);
    run_stage(&tools.interpreter, "synth", &arguments, &tools.interrupt, step)
        .map_err(|error| place::blamed(error, file.path(), scene))?;
    Ok(())
}

/// What the scene file `scene` stands for, in words: face, cameras, and each light in numbers.
pub fn describe(scene: &Path, tools: &Tools) -> Result<String, RunError> {
    let file = resolved(scene)?;
    let arguments = words(&[("--scene", file.path().as_os_str())]);
    let silent = &mut |_, _, _: &str| {};
    let said = run_stage(&tools.interpreter, "describe", &arguments, &tools.interrupt, silent)
        .map_err(|error| place::blamed(error, file.path(), scene))?;
    Ok(said["text"].as_str().unwrap_or_default().to_owned())
}

/// Renders `count` sampled identities into one PNG.
pub fn contact_sheet(
    count: u32,
    seed: u64,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let (count, seed) = (OsString::from(count.to_string()), OsString::from(seed.to_string()));
    let arguments = words(&[("--count", &count), ("--seed", &seed), ("--out", out.as_os_str())]);
    run_stage(&tools.interpreter, "contact-sheet", &arguments, &tools.interrupt, step)?;
    Ok(())
}

/// The scene file with all that it refers to, in a file that lives as long as the result.
fn resolved(scene: &Path) -> Result<tempfile::NamedTempFile, RunError> {
    let text = Scene::open(scene)?.to_toml().map_err(io::Error::other)?;
    let mut file = tempfile::Builder::new().prefix("unshade-").suffix(".toml").tempfile()?;
    file.write_all(text.as_bytes())?;
    Ok(file)
}

/// Renders `maps` in the capture's lights, under each of `scales` (of [`SCALES`](super::SCALES)).
pub fn relight(
    capture: &Path,
    maps: &Path,
    out: &Path,
    scales: &[&str],
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    atomic::apart(out, &[capture, maps])?;
    let scale = score::fit_scale(capture, maps)?;
    let mut arguments = words(&[
        ("--capture", capture.as_os_str()),
        ("--maps", maps.as_os_str()),
        ("--out", out.as_os_str()),
    ]);
    for name in scales {
        let factor = if *name == "global" { scale.global } else { 1.0 };
        arguments.extend([OsString::from("--scale"), OsString::from(format!("{name}={factor}"))]);
    }
    run_stage(&tools.interpreter, "relight", &arguments, &tools.interrupt, step)?;
    Ok(())
}

pub(super) fn words(pairs: &[(&str, &OsStr)]) -> Vec<OsString> {
    pairs.iter().flat_map(|(flag, value)| [OsString::from(flag), value.to_os_string()]).collect()
}
