//! `run.json`: the cases and methods of a run, and where their files lie below its folder.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use formats::atomic;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// The version of `run.json` that is read and written.
pub const FORMAT: u32 = 1;

/// A run's manifest cannot be used; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum RunFileError {
    /// The file cannot be read.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
    /// The file is not a manifest.
    #[error("{path}: is not a valid file of a run: {reason}; run the suite again")]
    Json {
        /// The file.
        path: PathBuf,
        /// The parser's error.
        reason: serde_json::Error,
    },
    /// Another version wrote the run.
    #[error("{path}: has format {found}, this program reads {FORMAT}; run the suite again")]
    Format {
        /// The file.
        path: PathBuf,
        /// The format that it states.
        found: u32,
    },
}

/// The manifest of a run.
#[derive(Debug, Deserialize, Serialize)]
pub struct RunFile {
    /// Version of the file format.
    pub format: u32,
    /// Name of the suite.
    pub suite: String,
    /// Title of the suite.
    pub title: Option<String>,
    /// The cases.
    pub cases: Vec<Case>,
    /// Versions that made the run.
    #[serde(default)]
    pub versions: BTreeMap<String, Value>,
    /// Text of the suite's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub suite_toml: Option<String>,
    /// Bytes that the stages of each kind left, by their folders.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub bytes: BTreeMap<String, u64>,
}

/// One capture and everything that was made from it.
#[derive(Debug, Deserialize, Serialize)]
pub struct Case {
    /// Name of the case.
    pub id: String,
    /// Name of the face.
    pub face: String,
    /// Name of the light of the capture.
    pub light: String,
    /// Name of the scene's variant, of a suite with variants.
    pub variant: Option<String>,
    /// The renderer's seed, of a suite with several.
    pub seed: Option<u64>,
    /// The capture's folder.
    pub capture: PathBuf,
    /// The methods.
    #[serde(rename = "solvers")]
    pub methods: Vec<Method>,
}

/// A method on a case.
#[derive(Debug, Deserialize, Serialize)]
pub struct Method {
    /// Name of the method in the suite.
    pub id: String,
    /// The part that it plays.
    pub kind: Kind,
    /// Class of its inputs.
    #[serde(default)]
    pub class: Class,
    /// Title in tables.
    pub title: Option<String>,
    /// The method that this is one seed of, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// The solver's seed, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The author.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub author: Option<String>,
    /// A hash of its settings and files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub content: Option<String>,
    /// Settings that the suite gives it.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub set: Map<String, Value>,
    /// The reason why it has no results.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// Folder of its maps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maps: Option<PathBuf>,
    /// Folder of its relit pictures.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relit: Option<PathBuf>,
    /// File of its scores.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scores: Option<PathBuf>,
}

/// Class of a method's inputs; only passive methods are ranked.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// The capture.
    #[default]
    Passive,
    /// Photographs in light of its own choice.
    Controlled,
    /// The truth.
    Privileged,
}

/// The part that a method plays.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A method under test.
    Solver,
    /// A method to beat.
    Baseline,
    /// Made from the truth, as a yardstick for scores.
    Privileged,
    /// The true maps: the bound that noise and the pipeline set.
    Oracle,
}

impl RunFile {
    /// The name of the file in a run's folder.
    pub const NAME: &'static str = "run.json";

    /// Reads the manifest of a run's folder.
    pub fn open(run: &Path) -> Result<Self, RunFileError> {
        let path = run.join(Self::NAME);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(reason) => return Err(RunFileError::Read { path, reason }),
        };
        match serde_json::from_slice::<Self>(&bytes) {
            Err(reason) => Err(RunFileError::Json { path, reason }),
            Ok(file) if file.format != FORMAT => {
                Err(RunFileError::Format { path, found: file.format })
            }
            Ok(file) => Ok(file),
        }
    }

    /// Writes the manifest into a run's folder.
    pub fn write(&self, run: &Path) -> io::Result<()> {
        atomic::write_file(&run.join(Self::NAME), &serde_json::to_vec_pretty(self)?)
    }

    /// Every method of every case.
    pub fn methods(&self) -> impl Iterator<Item = (&Case, &Method)> {
        self.cases.iter().flat_map(|case| case.methods.iter().map(move |method| (case, method)))
    }
}

impl Method {
    /// The title in tables.
    pub fn title(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.id)
    }

    /// Returns whether it is marked where it is best: among those that are given what every solver gets.
    pub fn is_ranked(&self) -> bool {
        self.kind != Kind::Oracle && self.class == Class::Passive
    }

    /// The title, with the class of its inputs if it is not ranked for them.
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
            (_, class) => class.name(),
        }
    }
}

impl Class {
    /// As files name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passive => "passive",
            Self::Controlled => "controlled",
            Self::Privileged => "privileged",
        }
    }
}

impl Kind {
    /// As files name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solver => "solver",
            Self::Baseline => "baseline",
            Self::Privileged => "privileged",
            Self::Oracle => "oracle",
        }
    }
}
