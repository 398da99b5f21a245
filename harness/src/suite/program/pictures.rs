//! Methods that give pictures and no maps: what they show of the training views becomes maps by
//! projection; what they relit is scored as it is.

use std::fs;
use std::path::Path;

use capture::Capture;
use capture::mean_texture::{Projected, project};
use formats::Maps;
use formats::picture::{Given, GrayImage, Picture, write_exr_rgb};
use glam::Vec3;
use serde::Deserialize;
use serde_json::{Value, json};

use super::blind;

/// Albedo of training views: linear EXR, or sRGB PNG.
const ALBEDO: &str = "pictures/albedo";
/// Normals of training views, object space: vectors in EXR, n/2 + 1/2 in PNG.
const NORMALS: &str = "pictures/normals";
/// Withheld views in other lights, below each light's name.
const RELIT: &str = "relit";
/// Withheld views in the capture's light.
const VIEWS: &str = "views";

/// Outputs of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Gives {
    /// Maps.
    #[default]
    Maps,
    /// Albedo or normals of the training views, withheld views relit, or both.
    Pictures,
}

/// Makes maps of `size` texels of the pictures of training views in the folder `left`; nothing if it
/// has none. The error is only the reason.
pub(super) fn into_maps(
    capture: &Path,
    left: &Path,
    scratch: &Path,
    size: usize,
) -> Result<(), String> {
    if left.join("diffuse_albedo.exr").exists() {
        return Err("left maps, but gives = \"pictures\"; leave gives out".to_owned());
    }
    let albedo = projected(capture, left, ALBEDO, Given::Colour, scratch, size)?;
    let normals = projected(capture, left, NORMALS, Given::Normals, scratch, size)?;
    let given = [RELIT, VIEWS].iter().any(|folder| left.join(folder).is_dir());
    if albedo.is_none() && normals.is_none() && !given {
        return Err(format!(
            "left no pictures in {ALBEDO}, {NORMALS}, {RELIT}/<light> or {VIEWS} of its maps folder"
        ));
    }
    let Some(seen) = [&albedo, &normals].into_iter().flatten().next() else { return Ok(()) };
    let data = seen.seen.iter().map(|seen| if *seen { 255 } else { 0 }).collect();
    let coverage = GrayImage { width: size, height: size, data };
    let normal = normals.map(|Projected { atlas, mean, .. }| {
        let vectors = mean.data.chunks_exact(3).zip(&atlas.normals);
        let unit = |(v, mesh): (&[f32], &Vec3)| Vec3::from_slice(v).normalize_or(*mesh).to_array();
        Picture { data: vectors.flat_map(unit).collect(), ..mean }
    });
    let maps = Maps {
        diffuse_albedo: albedo.map(|albedo| albedo.mean),
        diffuse_normal: normal.clone(),
        specular_normal: normal,
        coverage: Some(coverage),
        ..Maps::default()
    };
    maps.write_into(left).map_err(|error| error.to_string())
}

/// The pictures of one folder as a texture; none without the folder.
fn projected(
    capture: &Path,
    left: &Path,
    folder: &str,
    given: Given,
    scratch: &Path,
    size: usize,
) -> Result<Option<Projected>, String> {
    if !left.join(folder).is_dir() {
        return Ok(None);
    }
    // The capture with these pictures in the place of the photographs: lenses are taken out of them,
    // masks are kept, and sizes are checked as of any other.
    let stand_in = scratch.join(folder.replace('/', "-"));
    blind::copy_blind(capture, &stand_in).map_err(|error| error.to_string())?;
    let file = stand_in.join("transforms.json");
    let text = fs::read(&file).map_err(|error| error.to_string())?;
    let mut transforms: Value = serde_json::from_slice(&text).map_err(|error| error.to_string())?;
    let all = transforms["train_filenames"].as_array().cloned().unwrap_or_default();
    let train: Vec<&str> = all.iter().filter_map(Value::as_str).collect();
    let mut kept = Vec::new();
    for frame in transforms["frames"].as_array().into_iter().flatten() {
        let Some(path) = frame["file_path"].as_str().filter(|path| train.contains(path)) else {
            continue;
        };
        let stem = Path::new(path).file_stem().unwrap_or_default().to_string_lossy();
        let name = frame["name"].as_str().unwrap_or(&stem);
        let found = given.read(&left.join(folder), name);
        let within = |error: String| error.replace(&*left.to_string_lossy(), "its maps folder");
        if let Some(picture) = found.map_err(|error| within(error.to_string()))? {
            let target = stand_in.join(path);
            write_exr_rgb(&target, &picture).map_err(|error| error.to_string())?;
            kept.push(json!(path));
        }
    }
    if kept.is_empty() {
        return Err(format!("left no training view in {folder}; name pictures as the views are"));
    }
    transforms["train_filenames"] = Value::Array(kept);
    fs::write(&file, transforms.to_string()).map_err(|error| error.to_string())?;
    let opened = Capture::reopen(&stand_in).map_err(|error| {
        let photographs = stand_in.join("images").to_string_lossy().into_owned();
        error.to_string().replace(&photographs, folder)
    })?;
    let texture = project(&opened.mesh, &opened.train, size);
    if !texture.seen.contains(&true) {
        return Err(format!("shows nothing of the face in {folder}"));
    }
    Ok(Some(texture))
}
