//! The `[[solver]]` tables of a suite: who is run, and how each is started.

use std::path::Path;

use serde::Deserialize;
use solver::{BackendError, Choice};
use toml::{Table, Value};

use super::baseline::BaselineMethod;
use super::scene::{self, SceneError};

/// How a solver is started.
#[derive(Clone, Debug, PartialEq)]
pub enum Method {
    /// Our own solver with these settings (TOML text that names its `base`).
    Fields {
        /// A preset's name or the text of a configuration.
        config: String,
        /// What it runs on.
        backend: Choice,
    },
    /// Any program: arguments with `{capture}` and `{maps}` replaced.
    Command(Vec<String>),
    /// A Python function `module:function(capture, maps)`.
    Python(String),
    /// The true maps: the floor that rendering noise and the pipeline set.
    Oracle,
    /// An answer that needs no optimisation.
    Baseline {
        /// Which one.
        method: BaselineMethod,
        /// Side of its textures, texels.
        texture_size: usize,
    },
}

/// A column of the table.
#[derive(Clone, Debug)]
pub struct Entrant {
    /// Names its folders; letters, digits, `-` and `_`.
    pub id: String,
    /// Shown in the report.
    pub title: String,
    /// How it is started.
    pub method: Method,
}

impl Entrant {
    /// `solver`, `baseline` or `oracle`.
    pub fn kind(&self) -> &'static str {
        match self.method {
            Method::Oracle => "oracle",
            Method::Baseline { .. } => "baseline",
            _ => "solver",
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SolverTable {
    name: String,
    title: Option<String>,
    /// Preset or configuration file; without it the name is the preset.
    config: Option<String>,
    /// Single values that replace those of the configuration.
    #[serde(default)]
    set: Table,
    backend: Option<String>,
    command: Option<CommandLine>,
    python: Option<String>,
    /// Of a baseline.
    texture_size: Option<usize>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum CommandLine {
    Words(Vec<String>),
    Line(String),
}

/// The entrants in the order of the file.
pub(super) fn entrants_of(path: &Path, table: &Table) -> Result<Vec<Entrant>, SceneError> {
    let list = match table.get("solver") {
        Some(Value::Array(list)) if !list.is_empty() => list,
        _ => return Err(SceneError::value(path, "solver", "is missing; write [[solver]] tables")),
    };
    let mut entrants: Vec<Entrant> = Vec::new();
    for value in list {
        let solver: SolverTable = value
            .clone()
            .try_into()
            .map_err(|error: toml::de::Error| SceneError::value(path, "solver", error.message()))?;
        let entrant = entrant_of(path, solver)?;
        if entrants.iter().any(|other| other.id == entrant.id) {
            let reason = format!("{:?} occurs twice; rename one", entrant.id);
            return Err(SceneError::value(path, "solver", reason));
        }
        entrants.push(entrant);
    }
    Ok(entrants)
}

fn entrant_of(path: &Path, solver: SolverTable) -> Result<Entrant, SceneError> {
    scene::check_id(path, &solver.name)?;
    solver.check_keys(path)?;
    let baseline = BaselineMethod::ALL.into_iter().find(|method| method.name() == solver.name);
    let method = match (solver.command, solver.python, solver.name.as_str()) {
        (Some(CommandLine::Words(words)), ..) => Method::Command(words),
        (Some(CommandLine::Line(line)), ..) => {
            Method::Command(line.split_whitespace().map(str::to_owned).collect())
        }
        (None, Some(function), _) => Method::Python(function),
        (None, None, "oracle") => Method::Oracle,
        (None, None, name) => match baseline {
            Some(method) => {
                let texture_size = solver.texture_size.unwrap_or(BaselineMethod::TEXTURE_SIZE);
                if !(16..=8192).contains(&texture_size) {
                    let reason = format!("{texture_size} of {name:?} is not from 16 to 8192");
                    return Err(SceneError::value(path, "texture_size", reason));
                }
                Method::Baseline { method, texture_size }
            }
            None => Method::Fields {
                config: config_text(path, solver.config.as_deref().unwrap_or(name), &solver.set)?,
                backend: solver.backend.as_deref().map_or(Ok(Choice::Auto), str::parse).map_err(
                    |error: BackendError| SceneError::value(path, "backend", error.to_string()),
                )?,
            },
        },
    };
    let title = solver.title.unwrap_or_else(|| match method {
        Method::Oracle => "oracle (true maps)".to_owned(),
        Method::Baseline { method, .. } => method.title().to_owned(),
        _ => solver.name.clone(),
    });
    Ok(Entrant { id: solver.name, title, method })
}

impl SolverTable {
    /// Refuses keys that would do nothing.
    fn check_keys(&self, path: &Path) -> Result<(), SceneError> {
        let refused = |reason: String| {
            Err(SceneError::value(path, "solver", format!("{:?} {reason}", self.name)))
        };
        let foreign = self.command.is_some() || self.python.is_some();
        if self.command.is_some() && self.python.is_some() {
            return refused("has both a command and a python function".to_owned());
        }
        let baseline = BaselineMethod::ALL.iter().any(|method| method.name() == self.name);
        let fields = !foreign && !baseline && self.name != "oracle";
        for (key, given, means) in [
            ("config", self.config.is_some(), fields),
            ("set", !self.set.is_empty(), fields),
            ("backend", self.backend.is_some(), fields),
            ("texture_size", self.texture_size.is_some(), baseline && !foreign),
        ] {
            if given && !means {
                let mend = match key {
                    "texture_size" if fields => "; write [solver.set.fine_tuning] texture_size",
                    _ => "; leave it out",
                };
                return refused(format!("has no use for {key}{mend}"));
            }
        }
        Ok(())
    }
}

/// The configuration as TOML text: a file's, or one that names a preset, with `set` on top.
fn config_text(path: &Path, config: &str, set: &Table) -> Result<String, SceneError> {
    let mut table = if config.ends_with(".toml") {
        scene::read_toml(&scene::beside(path, config))?
    } else {
        Table::from_iter([("base".to_owned(), Value::String(config.to_owned()))])
    };
    scene::overlay(&mut table, set);
    toml::to_string(&table).map_err(|error| SceneError::value(path, "solver", error.to_string()))
}
