//! A maps folder, read as far as it can be read: what is wrong with a file is a finding, and the
//! other files are looked at all the same.

use std::path::Path;

use formats::picture::{self, Content, GrayImage, Picture, PictureError};

use super::finding::Finding;

pub(super) const DIFFUSE_ALBEDO: &str = "diffuse_albedo.exr";
pub(super) const SPECULAR_ALBEDO: &str = "specular_albedo.exr";
pub(super) const DIFFUSE_NORMAL: &str = "diffuse_normal.exr";
pub(super) const SPECULAR_NORMAL: &str = "specular_normal.exr";
pub(super) const ROUGHNESS: &str = "roughness.exr";
pub(super) const CONFIDENCE: &str = "confidence.exr";
pub(super) const COVERAGE: &str = "coverage.png";

const RGB: &[&str] = &["R", "G", "B"];

/// The maps that there are; their values may be NaN or infinite.
#[derive(Default)]
pub(super) struct MapFolder {
    pub diffuse_albedo: Option<Picture>,
    pub specular_albedo: Option<Picture>,
    pub diffuse_normal: Option<Picture>,
    pub specular_normal: Option<Picture>,
    pub roughness: Option<Picture>,
    pub confidence: Option<Picture>,
    pub coverage: Option<GrayImage>,
    /// True if our solver wrote the folder.
    pub own: bool,
}

impl MapFolder {
    /// Reads `folder`; files that cannot be read become findings.
    pub fn read(folder: &Path, findings: &mut Vec<Finding>) -> Self {
        let mut map = |file: &str, channels: &[&str]| {
            let path = folder.join(file);
            if !path.exists() {
                return None;
            }
            let read = read_map(&path, channels);
            read.map_err(|error| findings.push(unreadable(file, channels, &error))).ok()
        };
        let maps = Self {
            diffuse_albedo: map(DIFFUSE_ALBEDO, RGB),
            specular_albedo: map(SPECULAR_ALBEDO, &["Y"]),
            diffuse_normal: map(DIFFUSE_NORMAL, RGB),
            specular_normal: map(SPECULAR_NORMAL, RGB),
            roughness: map(ROUGHNESS, &["alpha1", "alpha2", "share1"]),
            confidence: map(CONFIDENCE, &["Y"]),
            coverage: None,
            own: is_own(folder),
        };
        let path = folder.join(COVERAGE);
        let coverage = path.exists().then(|| picture::read_png_gray(&path));
        let coverage = coverage.transpose().unwrap_or_else(|error| {
            findings.push(unreadable(COVERAGE, &[], &error));
            None
        });
        Self { coverage, ..maps }
    }

    /// The float maps with their files, in the order in which they are read.
    pub fn pictures(&self) -> impl Iterator<Item = (&'static str, &Picture)> {
        [
            (DIFFUSE_ALBEDO, &self.diffuse_albedo),
            (SPECULAR_ALBEDO, &self.specular_albedo),
            (DIFFUSE_NORMAL, &self.diffuse_normal),
            (SPECULAR_NORMAL, &self.specular_normal),
            (ROUGHNESS, &self.roughness),
            (CONFIDENCE, &self.confidence),
        ]
        .into_iter()
        .filter_map(|(file, map)| Some((file, map.as_ref()?)))
    }

    /// The normal maps with their files.
    pub fn normals(&self) -> impl Iterator<Item = (&'static str, &Picture)> {
        self.pictures().filter(|(file, _)| [DIFFUSE_NORMAL, SPECULAR_NORMAL].contains(file))
    }
}

/// A map with whatever values it has, in the colour space that it is scored in.
fn read_map(path: &Path, channels: &[&str]) -> Result<Picture, PictureError> {
    let colour = path.file_name().is_some_and(|name| name == DIFFUSE_ALBEDO);
    let content = if colour { Content::Colour } else { Content::Data };
    picture::read_exr_unchecked(path, channels, content)
}

/// Returns whether `solve.json` is the record of our solver, with its configuration.
fn is_own(folder: &Path) -> bool {
    let bytes = std::fs::read(folder.join("solve.json")).unwrap_or_default();
    let record: serde_json::Value = serde_json::from_slice(&bytes).unwrap_or_default();
    record["solver"] == "unshade" && record["config"].is_object()
}

fn unreadable(file: &str, channels: &[&str], error: &PictureError) -> Finding {
    let expected = channels.join(", ");
    match error {
        PictureError::MissingChannel { present, .. } => {
            let message = format!("has the channels {present}, expected {expected}");
            let fix = format!("write an EXR with the channels {expected}");
            Finding::error("channels", file, message, &fix)
        }
        PictureError::Read { reason, .. } => {
            let fix = "write it again, as 32-bit float EXR (coverage as 8-bit grey PNG)";
            Finding::error("unreadable", file, format!("cannot be read: {reason}"), fix)
        }
        other => Finding::error("unreadable", file, other.to_string(), "write it again"),
    }
}
