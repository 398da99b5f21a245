//! Records of finished stages.

use serde::{Deserialize, Serialize};

use super::output::OutputHashes;
use super::program::Usage;

/// A finished stage: what went in, what came out.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Finished {
    pub key: String,
    #[serde(flatten)]
    pub output: OutputHashes,
}

/// The circumstances in which an output was made. They are not part of its content: two runs differ in them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// When, in UTC.
    #[serde(default)]
    pub at: String,
    /// The code that made it, in words.
    #[serde(default)]
    pub from: String,
    /// Time and memory that a program took.
    #[serde(flatten)]
    pub usage: Option<Usage>,
}

/// A finished stage with what it cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The stage.
    pub id: String,
    /// The hashes of its output.
    #[serde(flatten)]
    pub output: OutputHashes,
    /// Wall time of the run that did it.
    pub seconds: f64,
    /// Size of its output, without what is no content.
    #[serde(default)]
    pub bytes: u64,
    /// How much there was to do, see [`Effort`](super::stage_work).
    #[serde(default)]
    pub work: f64,
    /// Size of the output as bare numbers, bytes.
    #[serde(default)]
    pub raw: f64,
    /// Key of the records that it is compared with, see [`Effort`](super::stage_work).
    #[serde(default)]
    pub what: String,
    /// The circumstances.
    #[serde(default)]
    pub made: Provenance,
}
