//! A run folder, read leniently where a part is optional: a method may
//! leave out maps, views or relit pictures, and its cells of the table then stay empty.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::error::{FORMAT, ReportError};

/// `run.json`: what was compared.
#[derive(Debug, Deserialize)]
pub(super) struct RunFile {
    pub format: u32,
    pub suite: String,
    pub title: Option<String>,
    pub cases: Vec<Case>,
    #[serde(default)]
    pub versions: BTreeMap<String, Value>,
    pub suite_toml: Option<String>,
}

impl RunFile {
    /// Reads the manifest of a run folder.
    pub fn open(run: &Path) -> Result<Self, ReportError> {
        let path = run.join("run.json");
        let manifest: Self = read_json(&path)?;
        if manifest.format != FORMAT {
            return Err(ReportError::Format { path, found: manifest.format });
        }
        Ok(manifest)
    }
}

/// One capture and everything that was made from it.
#[derive(Debug, Deserialize)]
pub(super) struct Case {
    pub id: String,
    pub face: String,
    pub light: String,
    /// Name of the scene's variant; none in a suite without variants.
    pub variant: Option<String>,
    pub capture: PathBuf,
    #[serde(rename = "solvers")]
    pub methods: Vec<Method>,
}

/// A column of the table.
#[derive(Debug, Deserialize)]
pub(super) struct Method {
    pub id: String,
    pub kind: Kind,
    #[serde(default)]
    pub class: Class,
    pub title: Option<String>,
    pub author: Option<String>,
    /// A hash of its settings and files.
    pub content: Option<String>,
    pub maps: Option<PathBuf>,
    pub relit: Option<PathBuf>,
    pub scores: Option<PathBuf>,
    /// Why there is nothing of it.
    pub failed: Option<String>,
}

impl Method {
    pub fn title(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.id)
    }
}

impl Method {
    /// Whether it is marked where it is best: among those that are given what every solver gets.
    pub fn is_ranked(&self) -> bool {
        self.kind != Kind::Oracle && self.class == Class::Passive
    }

    /// Its title, with the class of its inputs if it is not ranked for them.
    pub fn title_and_role(&self) -> String {
        if self.is_ranked() || self.kind == Kind::Oracle {
            return self.title().to_owned();
        }
        format!("{} ({})", self.title(), self.role())
    }

    /// Text below its title: the part it plays, or the class of its inputs.
    pub fn role(&self) -> &'static str {
        match (self.kind, self.class) {
            (Kind::Oracle, _) | (_, Class::Passive) => self.kind.name(),
            (_, Class::Controlled) => "controlled",
            (_, Class::Privileged) => "privileged",
        }
    }
}

/// Class of a method's inputs; only passive methods are ranked.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "lowercase")]
pub(super) enum Class {
    /// The capture.
    #[default]
    Passive,
    /// Photographs in light of its own choice.
    Controlled,
    /// The truth.
    Privileged,
}

/// The part that a column plays.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    /// A method under test.
    Solver,
    /// A method to beat.
    Baseline,
    /// Made from the truth, to say what a score is worth.
    Privileged,
    /// The true maps: the bound that noise and the pipeline set.
    Oracle,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Kind::Solver => "solver",
            Kind::Baseline => "baseline",
            Kind::Privileged => "privileged",
            Kind::Oracle => "oracle",
        }
    }
}

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

/// How a stage's output came about.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Made {
    #[serde(default)]
    pub at: String,
    #[serde(default)]
    pub from: String,
    /// Peak memory, bytes; none for methods that are ours.
    pub peak_bytes: Option<u64>,
    /// Whether the kernel kept it to its own files.
    pub confined: Option<bool>,
    /// What it could reach beyond its machine: `open`, `tcp` closed, or `closed`.
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
    pub train: Vec<Frame>,
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
            let listed = transforms.frames.iter().filter(|frame| names.contains(&frame.file_path));
            listed
                .map(|frame| Frame {
                    name: frame.name.clone().unwrap_or_else(|| stem(&frame.file_path)),
                    image: capture.join(&frame.file_path),
                    mask: frame.mask_path.as_ref().map(|mask| capture.join(mask)),
                    direction: camera_direction(&frame.transform_matrix),
                })
                .collect()
        };
        Ok(Self {
            root: capture.to_path_buf(),
            train: chosen(&transforms.train_filenames),
            test: chosen(&transforms.test_filenames),
        })
    }

    /// The index of the training view whose camera is nearest in direction.
    pub fn nearest_train(&self, direction: [f64; 3]) -> Option<usize> {
        let cosine = |index: &usize| -> f64 {
            self.train[*index].direction.iter().zip(direction).map(|(a, b)| a * b).sum()
        };
        (0..self.train.len()).max_by(|a, b| cosine(a).total_cmp(&cosine(b)))
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
