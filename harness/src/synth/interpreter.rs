//! Which Python runs the rendering stages.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use formats::content_hash::hash_parts;
use serde::{Deserialize, Serialize};

/// Why no Python was found, or why it cannot render.
#[derive(Debug, thiserror::Error)]
pub enum InterpreterError {
    /// The interpreter cannot be started.
    #[error(
        "{path}: cannot be started: {reason}; run `make` in the project, or name a Python that \
         has the package `unshade` in UNSHADE_PYTHON"
    )]
    Start {
        /// The interpreter.
        path: PathBuf,
        /// The operating system's error.
        reason: String,
    },
    /// The package is not installed there.
    #[error(
        "{path}: has no package `unshade`: {reason}; run `make` in the project, or name a Python \
         that has it in UNSHADE_PYTHON"
    )]
    Package {
        /// The interpreter.
        path: PathBuf,
        /// The last line of what Python said.
        reason: String,
    },
}

/// Versions and code of each stage of the renderer, as `python -m unshade.fingerprint` names them: what a stage left is
/// valid while they are the same.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Fingerprints(pub BTreeMap<String, String>);

impl Fingerprints {
    /// The fingerprint of one stage, unless the renderer has none of this name.
    pub fn of(&self, stage: &str) -> Option<&str> {
        self.0.get(stage).map(String::as_str)
    }
}

impl fmt::Display for Fingerprints {
    /// Versions and code of a capture, and a hash of all.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let parts: Vec<&str> = self.0.iter().flat_map(|(name, of)| [&**name, &**of]).collect();
        write!(f, "{} all={}", self.of("capture").unwrap_or_default(), &hash_parts(&parts)[..16])
    }
}

/// A Python with the package `unshade`.
#[derive(Clone, Debug)]
pub struct Interpreter {
    path: PathBuf,
}

impl Interpreter {
    /// `UNSHADE_PYTHON`, else the active virtual environment, else `.venv` here or above, else
    /// `python3`.
    pub fn find() -> Self {
        let below = |folder: &Path| folder.join("bin/python");
        let path = std::env::var_os("UNSHADE_PYTHON")
            .map(PathBuf::from)
            .or_else(|| std::env::var_os("VIRTUAL_ENV").map(|folder| below(Path::new(&folder))))
            .or_else(|| {
                let here = std::env::current_dir().ok()?;
                here.ancestors().map(|folder| below(&folder.join(".venv"))).find(|p| p.is_file())
            })
            .unwrap_or_else(|| PathBuf::from("python3"));
        Self { path }
    }

    /// The Python at `path`.
    pub fn at(path: &Path) -> Self {
        Self { path: path.to_path_buf() }
    }

    /// A command that starts this Python.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command.env("PYTHONUNBUFFERED", "1");
        command
    }

    /// The interpreter's path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Versions and code of the renderer.
    pub fn fingerprints(&self) -> Result<Fingerprints, InterpreterError> {
        let output =
            self.command().args(["-m", "unshade.fingerprint"]).output().map_err(|error| {
                InterpreterError::Start { path: self.path.clone(), reason: error.to_string() }
            })?;
        let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        let reason = match serde_json::from_slice(&output.stdout) {
            Ok(found) if output.status.success() => return Ok(found),
            Err(_) if output.status.success() => "it is of another version than this program",
            _ => said.lines().last().unwrap_or("no message"),
        };
        Err(InterpreterError::Package { path: self.path.clone(), reason: reason.to_owned() })
    }
}
