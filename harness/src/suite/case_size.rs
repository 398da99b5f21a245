//! Size of a case: of a rendered one as its scene states it, of photographs as the capture's files have it.

use std::fs;
use std::path::Path;

use capture::{Camera, Capture};
use formats::picture;
use rayon::prelude::*;
use serde_json::Value;

use super::baseline::BaselineMethod;
use super::cases::Case;

/// Cameras of a rig that does not say how many it has.
const CAMERAS: u64 = 16;

/// Share of a rendered picture that the head covers, as the demo's rig frames it.
const COVERED: f64 = 0.38;

/// Samples a pixel, and lights without a `relight.toml`, with which maps of photographs are relit.
const PHOTOGRAPHED_SAMPLES: f64 = 64.0;
const PHOTOGRAPHED_LIGHTS: usize = 2;

/// Masks that are read to know what share of a photograph the head covers.
const MASKS: usize = 8;

/// A case's size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CaseSize {
    /// Pixels of the training views, and of the withheld ones.
    pub train: f64,
    pub test: f64,
    /// Training views.
    pub views: usize,
    /// Pixels of the training views that show the head.
    pub covered: f64,
    /// Samples a pixel of what is rendered.
    pub samples: f64,
    /// Lights that maps are relit in, without the capture's own or the one that a method recovers.
    pub other_lights: f64,
    /// Texels of the true maps; none of photographs.
    pub texels: f64,
    pub photographed: bool,
}

impl CaseSize {
    /// The size of a case; zeros where the files of photographs cannot be read, which the run reports.
    pub fn of(case: &Case) -> Self {
        match &case.photographed {
            Some(folder) => photographed(folder).unwrap_or_default(),
            None => rendered(case),
        }
    }

    /// Bytes of a capture as bare numbers: 25 floats for a view with its layers, nine for every relit one, and 13 for
    /// a texel.
    pub fn capture_bytes(&self) -> f64 {
        let relit = self.test * (1.0 + self.other_lights);
        4.0 * ((self.train + self.test) * 25.0 + relit * 9.0 + self.texels * 13.0)
    }

    /// Bytes that a method leaves of the case as bare numbers.
    pub fn method_bytes(&self) -> f64 {
        let relit = self.test * (1.0 + self.other_lights) * 2.0;
        4.0 * (relit * 9.0 + self.texels * 13.0)
    }

    /// Texels of the maps of a method that chooses their size.
    pub fn solved_texels(&self) -> f64 {
        if self.photographed { BaselineMethod::TEXTURE_SIZE.pow(2) as f64 } else { self.texels }
    }

    /// Pixels of a picture.
    pub fn frame(&self) -> f64 {
        self.train / self.views.max(1) as f64
    }
}

fn rendered(case: &Case) -> CaseSize {
    let number = |section: &str, key: &str, default: u64| -> f64 {
        let value = case.scene.table.get(section).and_then(|table| table.get(key)?.as_integer());
        value.map_or(default, i64::unsigned_abs).max(1) as f64
    };
    let pixels = number("render", "width", 512) * number("render", "height", 512);
    let views = number("rig", "train", CAMERAS);
    CaseSize {
        train: pixels * views,
        test: pixels * number("rig", "test", CAMERAS / 4),
        views: views as usize,
        covered: COVERED * pixels * views,
        samples: number("render", "samples", 64),
        other_lights: case.scene.relight().len() as f64,
        texels: number("face", "texture_size", 512).powi(2),
        photographed: false,
    }
}

fn photographed(folder: &Path) -> Option<CaseSize> {
    let bytes = fs::read(folder.join("transforms.json")).ok()?;
    let cameras = Capture::cameras(folder, &bytes).ok()?;
    let document: Value = serde_json::from_slice(&bytes).ok()?;
    let files = |key: &str| document[key].as_array().map_or(&[][..], Vec::as_slice);
    let views = files("train_filenames").len().min(cameras.len());
    let pixels = |cameras: &[Camera]| -> f64 {
        cameras.iter().map(|camera| (camera.width * camera.height) as f64).sum()
    };
    let trained = |frame: &&Value| files("train_filenames").contains(&frame["file_path"]);
    let frames = document["frames"].as_array()?.iter().filter(trained);
    let masks: Vec<&str> = frames.filter_map(|frame| frame["mask_path"].as_str()).collect();
    let lights = fs::read_to_string(folder.join("relight.toml")).ok();
    let lights = lights.and_then(|text| text.parse::<toml::Table>().ok());
    let lights = lights.and_then(|table| Some(table.get("relight")?.as_array()?.len()));
    let train = pixels(&cameras[..views]);
    Some(CaseSize {
        train,
        test: pixels(&cameras[views..]),
        views,
        covered: train * covered_share(folder, &masks),
        samples: PHOTOGRAPHED_SAMPLES,
        other_lights: lights.unwrap_or(PHOTOGRAPHED_LIGHTS) as f64,
        texels: 0.0,
        photographed: true,
    })
}

/// Share of the pictures that their masks cover, by some of them.
fn covered_share(folder: &Path, masks: &[&str]) -> f64 {
    let every = masks.len().div_ceil(MASKS).max(1);
    let some: Vec<&&str> = masks.iter().step_by(every).collect();
    let shares = some.par_iter().filter_map(|mask| {
        let mask = picture::read_png_gray(&folder.join(mask)).ok()?;
        let inside = mask.data.iter().filter(|value| **value > 127).count();
        Some((inside as f64 / mask.data.len().max(1) as f64, 1.0))
    });
    let (sum, count) = shares.reduce(|| (0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    if count > 0.0 { sum / count } else { COVERED }
}
