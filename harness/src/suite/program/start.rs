//! A suite's settings for a program.

use std::collections::BTreeMap;
use std::path::PathBuf;

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
}
