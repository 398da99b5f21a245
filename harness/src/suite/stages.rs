//! The stages that the path tracer does, one call each.

use std::ffi::{OsStr, OsString};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use formats::atomic;
use report::FigureRequest;
use scoring::score;

use super::error::RunError;
use super::file::RENDERERS;
use super::packaged::Kind;
use super::place;
use super::scene::{self, Scene};
use super::tools::Tools;
use crate::synth::{cli_args, run_stage};

/// Renders the scene file `scene`, or a scene that comes with unshade, into the capture folder `out`.
pub fn synth(
    scene: &Path,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let scene = &scene::typed(scene, Kind::Scene)?;
    let file = resolved(scene)?;
    let inputs = Scene::open(scene)?.files();
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).chain([scene.as_path()]).collect();
    atomic::refuse_overlap(out, &inputs)?;
    let arguments = cli_args(&[("--scene", file.path().as_os_str()), ("--out", out.as_os_str())]);
    run_stage(&tools.interpreter, "synth", &arguments, &tools.interrupt, step)
        .map_err(|error| place::blamed(error, file.path(), scene))?;
    Ok(())
}

/// The scene file `scene` in words: face, cameras, and each light in numbers.
pub fn describe(scene: &Path, tools: &Tools) -> Result<String, RunError> {
    let scene = &scene::typed(scene, Kind::Scene)?;
    let file = resolved(scene)?;
    let arguments = cli_args(&[("--scene", file.path().as_os_str())]);
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
    let arguments = cli_args(&[("--count", &count), ("--seed", &seed), ("--out", out.as_os_str())]);
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

/// Maps to be rendered in a capture's lights.
pub struct Relight<'a> {
    /// The capture.
    pub capture: &'a Path,
    /// The maps.
    pub maps: &'a Path,
    /// The pictures' folder.
    pub out: &'a Path,
    /// One of [`RENDERERS`](super::RENDERERS).
    pub renderer: &'a str,
    /// Some of [`SCALES`](super::SCALES).
    pub scales: &'a [&'a str],
    /// A lat-long picture in the place of the capture's lights.
    pub light: Option<&'a Path>,
}

/// Renders maps in the capture's lights, under each of the scales.
pub fn relight(
    relight: &Relight,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let Relight { capture, maps, out, renderer, scales, light } = *relight;
    let inputs: Vec<&Path> = [capture, maps].into_iter().chain(light).collect();
    atomic::refuse_overlap(out, &inputs)?;
    // Without a truth nothing says what the albedo is to be multiplied by.
    let photographed = score::is_photographed(capture);
    let scales: &[&str] = if photographed { &["none"] } else { scales };
    let global = if photographed { 1.0 } else { score::fit_scale(capture, maps)?.global };
    let mut arguments = cli_args(&[
        ("--capture", capture.as_os_str()),
        ("--maps", maps.as_os_str()),
        ("--out", out.as_os_str()),
    ]);
    for name in scales {
        let factor = if *name == "global" { global } else { 1.0 };
        arguments.extend([OsString::from("--scale"), OsString::from(format!("{name}={factor}"))]);
    }
    if renderer != RENDERERS[0] {
        arguments.extend(cli_args(&[("--renderer", OsStr::new(renderer))]));
    }
    arguments
        .extend(light.into_iter().flat_map(|light| cli_args(&[("--light", light.as_os_str())])));
    run_stage(&tools.interpreter, "relight", &arguments, &tools.interrupt, step)?;
    Ok(())
}

/// Which picture an error budget is of, and where it goes.
pub struct Budget<'a> {
    /// The capture with its truth.
    pub capture: &'a Path,
    /// The maps.
    pub maps: &'a Path,
    /// The budget's folder.
    pub out: &'a Path,
    /// The light; the capture's own if none.
    pub light: Option<&'a str>,
    /// The withheld view; the first if none.
    pub view: Option<&'a str>,
}

/// Attributes the error of a relit view to each map, the diffuse albedo after one factor;
/// the result is what it found.
pub fn budget(
    budget: &Budget,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<serde_json::Value, RunError> {
    let Budget { capture, maps, out, light, view } = *budget;
    atomic::refuse_overlap(out, &[capture, maps])?;
    let factor = OsString::from(score::fit_scale(capture, maps)?.global.to_string());
    let mut arguments = cli_args(&[
        ("--capture", capture.as_os_str()),
        ("--maps", maps.as_os_str()),
        ("--out", out.as_os_str()),
        ("--factor", &factor),
    ]);
    for (flag, name) in [("--light", light), ("--view", view)] {
        arguments.extend(name.into_iter().flat_map(|name| cli_args(&[(flag, OsStr::new(name))])));
    }
    Ok(run_stage(&tools.interpreter, "budget", &arguments, &tools.interrupt, step)?)
}

/// Where maps go as an asset, and what decides how.
pub struct Export<'a> {
    /// The maps' folder.
    pub maps: &'a Path,
    /// The asset's folder.
    pub out: &'a Path,
    /// Their capture: its mesh, its light and its withheld views.
    pub capture: Option<&'a Path>,
    /// A mesh that has no capture.
    pub mesh: Option<&'a Path>,
    /// Everything else, as the stage takes it.
    pub options: Vec<OsString>,
}

/// Writes maps as an asset; the result is what the asset says of itself.
pub fn export(
    export: &Export,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<serde_json::Value, RunError> {
    let inputs: Vec<&Path> =
        [Some(export.maps), export.capture, export.mesh].into_iter().flatten().collect();
    atomic::refuse_overlap(export.out, &inputs)?;
    let mut arguments =
        cli_args(&[("--maps", export.maps.as_os_str()), ("--out", export.out.as_os_str())]);
    for (flag, path) in [("--capture", export.capture), ("--mesh", export.mesh)] {
        arguments.extend(path.into_iter().flat_map(|path| cli_args(&[(flag, path.as_os_str())])));
    }
    arguments.extend(export.options.iter().cloned());
    Ok(run_stage(&tools.interpreter, "export", &arguments, &tools.interrupt, step)?)
}

/// Gathers a figure from runs and draws it into the folder `out`.
pub fn figure(
    request: &FigureRequest,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    report::write_figure(request, out, |folder| {
        let arguments = cli_args(&[("--folder", folder.as_os_str())]);
        run_stage(&tools.interpreter, "figure", &arguments, &tools.interrupt, step)?;
        Ok(())
    })
}
