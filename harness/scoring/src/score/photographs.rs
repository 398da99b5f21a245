//! Scores without a truth: of a capture that was photographed, its withheld photographs are what
//! the networks' views and the relit maps are held against. The maps alone are not scored.

use std::fs;
use std::path::{Path, PathBuf};

use formats::content_hash::hash_path;
use serde_json::Value;

use super::error::ScoreError;
use super::names::{name_of, solver_name};
use super::pictures::{self, Frame};
use super::protocol::Protocol;
use super::scores::{Inputs, Scores};
use crate::check::check;

/// The light that a method found, in which its maps are relit to be held against photographs.
pub const FOUND_LIGHT: &str = "found";

/// Returns whether a capture is one without a truth.
pub fn is_photographed(capture: &Path) -> bool {
    !capture.join("truth").is_dir() && capture.join("transforms.json").is_file()
}

/// Scores a maps folder, and the pictures relit with it, against the withheld photographs, which
/// show what a pinhole sees: an import takes their lenses out.
pub(super) fn score(
    capture: &Path,
    maps: &Path,
    relit: Option<&Path>,
) -> Result<Scores, ScoreError> {
    let frames = Frame::of(capture, withheld(capture)?)?;
    let own_gains = transforms(capture)?["exposure"] == "unknown";
    let photographs = capture.join("images");
    let findings = check(maps, Some(capture))?;
    let rows_of = |folder: &Path, light| {
        pictures::photograph_rows(&frames, &photographs, folder, light, own_gains)
    };
    let mut rows = rows_of(&maps.join("views"), None)?;
    if let Some(relit) = relit {
        rows.extend(rows_of(&relit.join("none").join(FOUND_LIGHT), Some(FOUND_LIGHT))?);
    }
    if rows.is_empty() && !maps.join("diffuse_albedo.exr").is_file() {
        return Err(ScoreError::Nothing(maps.to_path_buf()));
    }
    let hash = |path: &Path| hash_path(path).map_err(|error| ScoreError::io(path, error));
    Ok(Scores {
        format: Scores::FORMAT,
        capture: name_of(capture),
        face: name_of(capture),
        skin_tone: None,
        light: FOUND_LIGHT.to_owned(),
        solver: solver_name(maps)?,
        protocol: Protocol::of_photographs(own_gains),
        inputs: Inputs {
            capture: hash(capture)?,
            maps: hash(maps)?,
            relit: relit.map(hash).transpose()?,
        },
        scale: None,
        regions: frames.iter().map(Frame::region_size).collect(),
        findings,
        metrics: Vec::new(),
        rows,
    })
}

/// The content of `transforms.json`.
fn transforms(capture: &Path) -> Result<Value, ScoreError> {
    let path = capture.join("transforms.json");
    let bytes = fs::read(&path).map_err(|error| ScoreError::io(&path, error))?;
    serde_json::from_slice(&bytes).map_err(|error| ScoreError::text(&path, error))
}

/// The names of the withheld frames, whose pictures are `images/<name>.exr`.
pub(super) fn withheld(capture: &Path) -> Result<Vec<String>, ScoreError> {
    let document = transforms(capture)?;
    let listed = document["test_filenames"].as_array().into_iter().flatten();
    let stem = |name: &Value| {
        let stem = PathBuf::from(name.as_str()?);
        Some(stem.file_stem()?.to_string_lossy().into_owned())
    };
    let mut names: Vec<String> = listed.filter_map(stem).collect();
    names.sort();
    if names.is_empty() {
        return Err(ScoreError::NoTruth(capture.to_path_buf()));
    }
    Ok(names)
}
