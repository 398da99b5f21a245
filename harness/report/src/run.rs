//! The files of a run's folder beside its manifest, read leniently where a part is optional: a method may
//! leave out maps, views or relit pictures, and its cells of the table then stay empty.

use std::fs;
use std::path::{Path, PathBuf};

use formats::picture;
use rayon::prelude::*;
use scoring::score::FOUND_LIGHT;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::error::ReportError;
use super::framing::shows_whole_head;
use super::reference::Reference;
pub(super) use scoring::run::{Case, Class, Kind, Method, RunFile};

/// `timing.json`: wall times, the only part of a report that changes between equal runs.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Timing {
    #[serde(default)]
    pub stages: Vec<StageTime>,
}

#[derive(Debug, Deserialize)]
pub(super) struct StageTime {
    pub id: String,
    pub seconds: f64,
    #[serde(default)]
    pub cached: bool,
    #[serde(default)]
    pub made: Made,
}

/// The origin of a stage's output.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Made {
    #[serde(default)]
    pub at: String,
    #[serde(default)]
    pub from: String,
    /// Peak memory, bytes; none for methods that are ours.
    pub peak_bytes: Option<u64>,
    /// True if the kernel kept it to its own files.
    pub confined: Option<bool>,
    /// The network that it could reach: `open`, `tcp` closed, or `closed`.
    pub network: Option<String>,
}

/// `maps/timing.json`: what the stages of a solver took, by their names, in their order.
#[derive(Debug, Deserialize)]
pub(super) struct SolverTiming {
    pub seconds: serde_json::Map<String, Value>,
}

/// The part of `capture/transforms.json` that the pictures need.
#[derive(Debug)]
pub(super) struct Frames {
    /// The capture's folder.
    pub root: PathBuf,
    pub reference: Reference,
    pub train: Vec<Frame>,
    /// The withheld views; the first one shows the whole head, if any does, and of those most of its front.
    pub test: Vec<Frame>,
}

/// A view, not opened.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub name: String,
    pub image: PathBuf,
    pub mask: Option<PathBuf>,
    /// Unit vector from the origin, which lies in the head, to the camera.
    pub direction: [f64; 3],
    whole: bool,
}

impl Frames {
    /// Reads the frames of a capture; paths come back below `capture`.
    pub fn read(capture: &Path) -> Result<Self, ReportError> {
        #[derive(Deserialize)]
        struct Transforms {
            frames: Vec<Listed>,
            #[serde(default)]
            train_filenames: Vec<String>,
            #[serde(default)]
            test_filenames: Vec<String>,
        }
        #[derive(Deserialize)]
        struct Listed {
            name: Option<String>,
            file_path: String,
            mask_path: Option<String>,
            transform_matrix: Vec<Vec<f64>>,
        }
        let transforms: Transforms = read_json(&capture.join("transforms.json"))?;
        let chosen = |names: &[String]| -> Vec<Frame> {
            let listed = transforms.frames.par_iter();
            let listed = listed.filter(|frame| names.contains(&frame.file_path));
            listed
                .map(|frame| {
                    let mask = frame.mask_path.as_ref().map(|mask| capture.join(mask));
                    // A mask that cannot be read is reported where it is shown.
                    let read = mask.as_ref().and_then(|mask| picture::read_png_gray(mask).ok());
                    Frame {
                        name: frame.name.clone().unwrap_or_else(|| stem(&frame.file_path)),
                        image: capture.join(&frame.file_path),
                        direction: camera_direction(&frame.transform_matrix),
                        whole: read.is_none_or(|mask| shows_whole_head(&mask)),
                        mask,
                    }
                })
                .collect()
        };
        let mut test = chosen(&transforms.test_filenames);
        // The face looks along +Z.
        let order = |a: &usize, b: &usize| {
            let frames: [&Frame; 2] = [&test[*a], &test[*b]];
            let [a, b] = frames.map(|frame| (frame.whole, frame.direction[2]));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        };
        // The earlier one of equals.
        if let Some(first) = (0..test.len()).rev().max_by(order) {
            test[..=first].rotate_right(1);
        }
        Ok(Self {
            root: capture.to_path_buf(),
            reference: Reference::of(capture),
            train: chosen(&transforms.train_filenames),
            test,
        })
    }

    /// The index of the training view whose camera is nearest in direction, of those that show the whole head
    /// if there are any.
    pub fn nearest_train(&self, direction: [f64; 3]) -> Option<usize> {
        let cosine = |index: &usize| -> f64 {
            self.train[*index].direction.iter().zip(direction).map(|(a, b)| a * b).sum()
        };
        let any_whole = self.train.iter().any(|frame| frame.whole);
        let chosen = (0..self.train.len()).filter(|index| self.train[*index].whole || !any_whole);
        chosen.max_by(|a, b| cosine(a).total_cmp(&cosine(b)))
    }

    /// The picture that a withheld view relit in `light` is compared with; of photographs there is one in the light
    /// that they were taken in alone.
    pub fn relit_reference(&self, frame: &Frame, light: &str) -> Option<PathBuf> {
        let file = format!("{}.exr", frame.name);
        match self.reference {
            Reference::Truth => Some(self.root.join("truth/relit").join(light).join(file)),
            Reference::Photograph => (light == FOUND_LIGHT).then(|| frame.image.clone()),
        }
    }
}

fn camera_direction(camera_to_world: &[Vec<f64>]) -> [f64; 3] {
    let position: [f64; 3] = std::array::from_fn(|row| {
        camera_to_world.get(row).and_then(|row| row.get(3)).copied().unwrap_or(0.0)
    });
    let length = position.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    position.map(|x| x / length)
}

fn stem(path: &str) -> String {
    Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads a JSON file whose absence is an error.
pub(super) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, ReportError> {
    let bytes = fs::read(path).map_err(|error| ReportError::read(path, error))?;
    serde_json::from_slice(&bytes)
        .map_err(|error| ReportError::Json { path: path.to_path_buf(), reason: error.to_string() })
}

/// Reads a JSON file that may be absent, but not broken.
pub(super) fn read_json_if_present<T: DeserializeOwned>(
    path: &Path,
) -> Result<Option<T>, ReportError> {
    if path.exists() { read_json(path).map(Some) } else { Ok(None) }
}
