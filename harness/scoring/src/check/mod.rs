//! The check before the flight: what maps are most often wrong in, each fault named with its
//! numbers and its likely fix, before anything is scored.
//!
//! A folder is read tolerantly: what cannot be read is a finding. With a capture, maps are compared
//! with its photographs, cameras and mesh; its `truth/` is never opened.

mod albedo;
mod axes;
mod bands;
mod coverage;
mod finding;
mod folder;
mod normals;
mod orientation;
mod reduced;
mod roughness;
mod size;
mod specular;
mod stray;
mod symmetry;
mod witness;

use std::path::{Path, PathBuf};

use capture::{Capture, CaptureError};

pub use finding::{Finding, Level};

use folder::MapFolder;
use normals::Reference;
use reduced::Reduced;
use witness::Witness;

/// An error of a check; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// There is no folder of this name.
    #[error("{0}: is not a folder; name the maps folder that a solver wrote")]
    NoFolder(PathBuf),
    /// The capture is broken.
    #[error(transparent)]
    Capture(#[from] CaptureError),
}

/// Likely faults of a maps folder; none for sound maps. With a capture far more faults can be told.
pub fn check(maps: &Path, capture: Option<&Path>) -> Result<Vec<Finding>, CheckError> {
    if !maps.is_dir() {
        return Err(CheckError::NoFolder(maps.to_path_buf()));
    }
    let capture = capture.map(Capture::open).transpose()?;
    check_with(maps, capture.as_ref())
}

/// [`check`] with a capture that is open.
pub fn check_with(maps: &Path, capture: Option<&Capture>) -> Result<Vec<Finding>, CheckError> {
    let witness = capture.map(Witness::of).transpose()?;
    let witness = witness.as_ref();
    let mut findings = Vec::new();
    stray::stray_files(maps, &mut findings);
    let found = MapFolder::read(maps, &mut findings);
    let pictures = ["views", "relit"].iter().any(|folder| maps.join(folder).is_dir());
    if found.pictures().next().is_none() && findings.is_empty() && !pictures {
        let shown = maps.file_name().unwrap_or_default().to_string_lossy();
        let message = "holds no map".to_owned();
        let fix = "a solver leaves at least diffuse_albedo.exr";
        findings.push(Finding::error("no-maps", &shown, message, fix));
    }
    size::sizes(&found, witness, &mut findings);
    if let Some(coverage) = &found.coverage {
        coverage::check(coverage, witness, &mut findings);
    }
    let shape = found.coverage.as_ref().map(coverage::reduced);
    if let (None, Some(shape)) = (witness, &shape) {
        orientation::of_empty_texels(&found, shape, &mut findings);
    }
    let reference = witness.map_or(Reference::Coverage(shape.as_deref()), Reference::Capture);
    for (file, map) in found.pictures() {
        // Without a coverage no NaN is excused, wherever the chart lies.
        let covered = coverage::covered(map, found.coverage.as_ref(), None);
        size::finite(file, map, &covered, &mut findings);
    }
    if let Some(map) = &found.diffuse_albedo {
        let covered = coverage::covered(map, found.coverage.as_ref(), witness);
        let file = folder::DIFFUSE_ALBEDO;
        let reduced = Reduced::of(map);
        findings.extend(witness.and_then(|w| orientation::of_albedo(file, &reduced, w)));
        albedo::check(file, map, &covered, found.own, witness, &mut findings);
    }
    for (file, map) in found.normals() {
        let covered = coverage::covered(map, found.coverage.as_ref(), witness);
        normals::check(file, map, &covered, reference, &mut findings);
    }
    if let Some(map) = &found.specular_albedo {
        let covered = coverage::covered(map, found.coverage.as_ref(), witness);
        specular::check(folder::SPECULAR_ALBEDO, map, &covered, found.own, &mut findings);
    }
    if let Some(map) = &found.roughness {
        let covered = coverage::covered(map, found.coverage.as_ref(), witness);
        roughness::check(folder::ROUGHNESS, map, &covered, &mut findings);
    }
    Ok(findings)
}
