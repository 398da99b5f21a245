//! Which Python runs the rendering stages.

use std::path::{Path, PathBuf};
use std::process::Command;

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

    /// Versions and sources of the renderer: a rendering is valid while they are the same.
    pub fn fingerprint(&self) -> Result<String, InterpreterError> {
        let output =
            self.command().args(["-m", "unshade.fingerprint"]).output().map_err(|error| {
                InterpreterError::Start { path: self.path.clone(), reason: error.to_string() }
            })?;
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
        if output.status.success() {
            return Ok(text(&output.stdout));
        }
        let said = text(&output.stderr);
        Err(InterpreterError::Package {
            path: self.path.clone(),
            reason: said.lines().last().unwrap_or("no message").to_owned(),
        })
    }
}
