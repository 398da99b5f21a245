//! The oracle: the true maps as if a solver had found them. What its relit pictures score is the
//! best that any solver can.

use std::fs;
use std::path::Path;

use formats::atomic::{self, Folder};

use super::ScoreError;
use super::truth::{self, present};

const FILES: [&str; 6] = [
    "diffuse_albedo.exr",
    "specular_albedo.exr",
    "diffuse_normal.exr",
    "specular_normal.exr",
    "roughness.exr",
    "coverage.png",
];

/// Writes a maps folder from a capture's truth.
pub fn oracle_maps(capture: &Path, out: &Path) -> Result<(), ScoreError> {
    let truth = truth::folder(capture)?;
    let io = |error| ScoreError::io(out, error);
    atomic::refuse_overlap(out, &[capture])?;
    let folder = Folder::begin(out)?;
    for name in FILES {
        let from = present(truth.join(name), truth::AGAIN)?;
        fs::copy(&from, folder.path().join(name)).map_err(|error| ScoreError::io(&from, error))?;
    }
    fs::write(folder.path().join("solve.json"), "{\n  \"solver\": \"oracle\"\n}\n").map_err(io)?;
    Ok(folder.commit()?)
}
