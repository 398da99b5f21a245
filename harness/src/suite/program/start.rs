//! What a suite says of a program.

use std::collections::BTreeMap;
use std::path::PathBuf;

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
    /// What is started.
    pub start: Start,
    /// Where it is started, and what relative paths start from: the suite's folder.
    pub folder: PathBuf,
    /// What it may take.
    pub limits: Limits,
    /// Variables of its environment, replacing those of unshade's own.
    pub environment: BTreeMap<String, String>,
    /// What the user calls this state of it.
    pub version: Option<String>,
    /// Files and folders that it reads, beside its own.
    pub inputs: Vec<PathBuf>,
}
