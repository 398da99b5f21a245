//! The stages that the path tracer does, one call each.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use formats::atomic;
use report::FigureRequest;
use scoring::score;
use serde_json::Value;

use super::error::RunError;
use super::packaged::Kind;
use super::place;
use super::scene::{self, Scene};
use super::stage_work::Step;
use crate::synth::{Export, Request, Tools};

/// Renders the scene file `scene`, or a scene that comes with unshade, into the capture folder `out`.
pub fn synth(scene: &Path, out: &Path, tools: &Tools, step: Step) -> Result<(), RunError> {
    let scene = &scene::typed(scene, Kind::Scene)?;
    let file = resolved(scene)?;
    let inputs = Scene::open(scene)?.files();
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).chain([scene.as_path()]).collect();
    atomic::refuse_overlap(out, &inputs)?;
    tools
        .run(&Request::Synth { scene: file.path(), out }, step)
        .map_err(|error| place::located(error, &[file.path().to_path_buf()], scene, Kind::Scene))?;
    Ok(())
}

/// The scene file `scene` in words: face, cameras, and each light in numbers.
pub fn describe(scene: &Path, tools: &Tools) -> Result<String, RunError> {
    let scene = &scene::typed(scene, Kind::Scene)?;
    let file = resolved(scene)?;
    let answer = tools
        .ask(&Request::Describe { scene: file.path() })
        .map_err(|error| place::located(error, &[file.path().to_path_buf()], scene, Kind::Scene))?;
    Ok(answer["text"].as_str().unwrap_or_default().to_owned())
}

/// Renders `count` sampled identities into one PNG.
pub fn contact_sheet(
    count: u32,
    seed: u64,
    out: &Path,
    tools: &Tools,
    step: Step,
) -> Result<(), RunError> {
    tools.run(&Request::ContactSheet { count, seed, out }, step)?;
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
pub fn relight(relight: &Relight, tools: &Tools, step: Step) -> Result<(), RunError> {
    let Relight { capture, maps, out, renderer, scales, light } = *relight;
    let inputs: Vec<&Path> = [capture, maps].into_iter().chain(light).collect();
    atomic::refuse_overlap(out, &inputs)?;
    // Without a truth there is nothing that the albedo could be aligned with.
    let photographed = score::is_photographed(capture);
    let scales: &[&str] = if photographed { &["none"] } else { scales };
    let global = if photographed { 1.0 } else { score::fit_scale(capture, maps)?.global };
    let scales: Vec<(&str, f64)> =
        scales.iter().map(|name| (*name, if *name == "global" { global } else { 1.0 })).collect();
    tools.run(&Request::Relight { capture, maps, out, renderer, scales: &scales, light }, step)?;
    Ok(())
}

/// The picture that an error budget is of, and the budget's folder.
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

/// Attributes the error of a relit view to each map, the diffuse albedo after one factor; returns the shares.
pub fn budget(budget: &Budget, tools: &Tools, step: Step) -> Result<Value, RunError> {
    let Budget { capture, maps, out, light, view } = *budget;
    atomic::refuse_overlap(out, &[capture, maps])?;
    let factor = score::fit_scale(capture, maps)?.global;
    Ok(tools.run(&Request::Budget { capture, maps, out, light, view, factor }, step)?)
}

/// Writes maps as an asset; returns what it loses.
pub fn export(export: &Export, tools: &Tools, step: Step) -> Result<Value, RunError> {
    let Export { maps, capture, mesh, out, .. } = export;
    let inputs: Vec<&Path> =
        [Some(maps), capture.as_ref(), mesh.as_ref()].into_iter().flatten().map(|p| &**p).collect();
    atomic::refuse_overlap(out, &inputs)?;
    Ok(tools.run(&Request::Export(export), step)?)
}

/// Gathers a figure from runs and draws it into the folder `out`.
pub fn figure(
    request: &FigureRequest,
    out: &Path,
    tools: &Tools,
    step: Step,
) -> Result<(), RunError> {
    report::write_figure(request, out, |folder| {
        tools.run(&Request::Figure { folder }, step)?;
        Ok(())
    })
}
