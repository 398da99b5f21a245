//! The truth of a synthetic capture, as far as maps are compared with it.

use std::fs;
use std::path::{Path, PathBuf};

use formats::picture::{self, GrayImage, Picture};

use super::ScoreError;
use super::protocol::Protocol;
use crate::metrics::{Region, lab, typology_angle};

/// The fix for a truth that lacks something.
pub(super) const AGAIN: &str = "render the capture again with `unshade synth`";

/// Names of the label ids, as a face parser gives them.
pub(super) const LABELS: [(u8, &str); 7] =
    [(1, "skin"), (2, "lips"), (3, "brow"), (4, "eyelid"), (5, "ear"), (6, "nose"), (7, "scalp")];

/// Relative standard deviation of a specular albedo that is the same everywhere but for rounding.
const LEAST_VARIATION: f64 = 0.01;

/// The id of skin.
pub(super) const SKIN: u8 = LABELS[0].0;

/// The variation of the true specular albedo over texels. Where it is constant, the energy of the specular layer
/// says no more than the one number that a method took for it over the true one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Highlights {
    Varied,
    Alike,
}

/// True layers in texture space.
pub(super) struct Truth {
    pub diffuse_albedo: Picture,
    pub specular_albedo: Picture,
    pub diffuse_normal: Picture,
    pub specular_normal: Picture,
    /// Mean GGX alpha of the two lobes.
    pub roughness: Picture,
    pub labels: GrayImage,
    pub coverage: GrayImage,
    /// Training views that see each texel.
    pub views: GrayImage,
    /// The texels that are compared.
    pub region: Region,
}

impl Truth {
    pub fn open(capture: &Path) -> Result<Self, ScoreError> {
        let folder = folder(capture)?;
        let map = |name: &str, channels: &[&str]| {
            Ok::<_, ScoreError>(picture::read_exr(&present(folder.join(name), AGAIN)?, channels)?)
        };
        let gray = |name: &str| {
            Ok::<_, ScoreError>(picture::read_png_gray(&present(folder.join(name), AGAIN)?)?)
        };
        let rgb = ["R", "G", "B"];
        let coverage = gray("coverage.png")?;
        let region = Region::eroded("coverage-e5", &coverage)
            .map_err(ScoreError::of("truth/coverage.png"))?;
        let truth = Self {
            diffuse_albedo: map("diffuse_albedo.exr", &rgb)?,
            specular_albedo: map("specular_albedo.exr", &["Y"])?,
            diffuse_normal: map("diffuse_normal.exr", &rgb)?,
            specular_normal: map("specular_normal.exr", &rgb)?,
            roughness: mean_alpha(&map("roughness.exr", &["alpha1", "alpha2", "share1"])?),
            labels: gray("labels.png")?,
            views: gray("views.png")?,
            coverage,
            region,
        };
        for (name, found) in [
            ("diffuse_albedo.exr", size(&truth.diffuse_albedo)),
            ("specular_albedo.exr", size(&truth.specular_albedo)),
            ("diffuse_normal.exr", size(&truth.diffuse_normal)),
            ("specular_normal.exr", size(&truth.specular_normal)),
            ("roughness.exr", size(&truth.roughness)),
            ("labels.png", (truth.labels.width, truth.labels.height)),
            ("views.png", (truth.views.width, truth.views.height)),
        ] {
            check_size(&folder.join(name), found, truth.region.size())?;
        }
        Ok(truth)
    }

    /// Returns whether its specular albedo has a relative standard deviation of more than a hundredth.
    pub fn highlights(&self) -> Highlights {
        let values =
            || self.region.pixels().iter().map(|at| f64::from(self.specular_albedo.data[*at]));
        let count = self.region.pixels().len() as f64;
        let mean = values().sum::<f64>() / count;
        let variance = values().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        if variance.sqrt() > LEAST_VARIATION * mean {
            Highlights::Varied
        } else {
            Highlights::Alike
        }
    }

    /// Individual typology angle of the mean colour of its skin, degrees; as with a colorimeter,
    /// light is averaged first.
    pub fn skin_tone(&self) -> Option<f64> {
        let skin = self.region.part("skin", |i| self.labels.data[i] == SKIN).ok()?;
        let mut sum = [0.0; 3];
        for i in skin.pixels() {
            let texel = &self.diffuse_albedo.data[3 * i..3 * i + 3];
            sum.iter_mut().zip(texel).for_each(|(sum, value)| *sum += f64::from(*value));
        }
        Some(typology_angle(lab(sum.map(|sum| sum / skin.pixels().len() as f64))))
    }
}

/// Mean GGX alpha of the two lobes of a roughness map, weighted by their shares.
pub(super) fn mean_alpha(map: &Picture) -> Picture {
    let texels = map.data.chunks_exact(map.channels);
    let data = texels.map(|t| t[2] * t[0] + (1.0 - t[2]) * t[1]).collect();
    Picture { channels: 1, data, ..*map }
}

/// Names and protocol that a truth states.
pub(super) struct Identity {
    /// The face's name.
    pub face: String,
    /// The light's name.
    pub light: String,
    /// The protocol of its scores.
    pub protocol: Protocol,
}

impl Identity {
    pub fn read(capture: &Path) -> Result<Self, ScoreError> {
        let path = present(folder(capture)?.join("scene.toml"), AGAIN)?;
        let text = fs::read_to_string(&path).map_err(|error| ScoreError::io(&path, error))?;
        let scene: toml::Table = text.parse().map_err(|error| ScoreError::text(&path, error))?;
        let name = |section: &str| {
            let name = scene.get(section).and_then(|table| table.get("name")?.as_str());
            name.map(str::to_owned)
                .ok_or_else(|| ScoreError::text(&path, format!("{section}.name is missing")))
        };
        let protocol = Protocol::of(scene.get("render").and_then(|table| table.as_table()));
        Ok(Self { face: name("face")?, light: name("light")?, protocol })
    }
}

/// `truth/relit/<light>`: the lights, sorted.
pub(super) fn lights(capture: &Path) -> Result<Vec<String>, ScoreError> {
    names(&present(folder(capture)?.join("relit"), AGAIN)?)
}

/// The withheld frames, sorted: those whose true pictures the light has.
pub(super) fn withheld(capture: &Path, light: &str) -> Result<Vec<String>, ScoreError> {
    names(&present(folder(capture)?.join("relit").join(light), AGAIN)?)
}

pub(super) fn folder(capture: &Path) -> Result<PathBuf, ScoreError> {
    let folder = capture.join("truth");
    if folder.is_dir() { Ok(folder) } else { Err(ScoreError::NoTruth(capture.to_path_buf())) }
}

/// The path, if there is something.
pub(super) fn present(path: PathBuf, fix: &'static str) -> Result<PathBuf, ScoreError> {
    if path.exists() { Ok(path) } else { Err(ScoreError::Missing { path, fix }) }
}

pub(super) fn check_size(
    path: &Path,
    (found_width, found_height): (usize, usize),
    (width, height): (usize, usize),
) -> Result<(), ScoreError> {
    if (found_width, found_height) == (width, height) {
        return Ok(());
    }
    Err(ScoreError::Size { path: path.to_path_buf(), found_width, found_height, width, height })
}

pub(super) fn size(picture: &Picture) -> (usize, usize) {
    (picture.width, picture.height)
}

/// Names in a folder without their extensions, sorted.
pub(super) fn names(folder: &Path) -> Result<Vec<String>, ScoreError> {
    let entries = fs::read_dir(folder).map_err(|error| ScoreError::io(folder, error))?;
    let mut names = Vec::new();
    for entry in entries {
        let path = entry.map_err(|error| ScoreError::io(folder, error))?.path();
        names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
    }
    names.sort();
    Ok(names)
}
