//! A suite's settings for a program.

use std::collections::BTreeMap;
use std::path::PathBuf;

use toml::{Table, Value};

use super::pictures::Gives;
use super::watch::Limits;

/// How a program is started.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// Arguments with `{capture}` and `{maps}` replaced.
    Command(Vec<String>),
    /// A Python function `module:function`.
    Python(String),
}

/// A `[[method]]` that names a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Its outputs.
    pub gives: Gives,
    /// Side of the maps that its pictures become, texels.
    pub texture_size: usize,
    /// The command or function that is started.
    pub start: Start,
    /// Where it is started, and what relative paths start from: the suite's folder.
    pub folder: PathBuf,
    /// Limits of time, memory and processors.
    pub limits: Limits,
    /// Variables of its environment, replacing those of unshade's own.
    pub environment: BTreeMap<String, String>,
    /// The user's name for this state of it.
    pub version: Option<String>,
    /// Files and folders that it reads, beside its own.
    pub inputs: Vec<PathBuf>,
    /// Values of the suite that it is handed: keyword arguments of a function, JSON in `{set}` and in the variable
    /// `UNSHADE_SET`, and each by its name, as `{lr}`.
    pub settings: Table,
    /// Whether it may use the network.
    pub network: bool,
}

/// Paths that a command is given, as it names them in braces, and `set`: no value of `set` has such a name.
pub const PLACEHOLDERS: [&str; 5] = ["capture", "maps", "lights", "debug", "set"];

impl Program {
    /// The values that it is handed, as JSON: equal values give equal text.
    pub(in crate::suite) fn settings_json(&self) -> String {
        let sorted: BTreeMap<_, _> = self.settings.iter().collect();
        serde_json::to_string(&sorted).unwrap_or_default()
    }

    /// A word of the command with the values of `set` in the place of their names in braces.
    pub(in crate::suite) fn with_settings(&self, word: &str) -> String {
        let word = word.replace("{set}", &self.settings_json());
        self.settings.iter().fold(word, |word, (key, value)| {
            let text = match value {
                Value::String(text) => text.clone(),
                value => serde_json::to_string(value).unwrap_or_default(),
            };
            word.replace(&format!("{{{key}}}"), &text)
        })
    }
}
