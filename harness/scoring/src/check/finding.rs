//! A finding: one fault of one map, with its evidence.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

/// The severity of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// The maps cannot be scored.
    Error,
    /// The maps can be scored, but are likely not what they should be.
    Warning,
}

impl Level {
    /// As in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }
}

/// One fault of one file of a maps folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The fault, as a program reads it: `flipped-v`.
    pub id: String,
    /// The severity.
    pub level: Level,
    /// The file, or what was found in its place.
    pub map: String,
    /// The fault, with its numbers.
    pub message: String,
    /// The likely fix; scores that an earlier version wrote name it `mend`.
    #[serde(alias = "mend")]
    pub fix: String,
    /// The numbers by name, finite, four decimals.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub evidence: BTreeMap<String, f64>,
}

impl Finding {
    /// A fault with which nothing can be scored.
    pub(super) fn error(id: &str, map: &str, message: String, fix: &str) -> Self {
        let (id, map, fix) = (id.to_owned(), map.to_owned(), fix.to_owned());
        Self { id, level: Level::Error, map, message, fix, evidence: BTreeMap::new() }
    }

    /// A likely fault.
    pub(super) fn warning(id: &str, map: &str, message: String, fix: &str) -> Self {
        Self { level: Level::Warning, ..Self::error(id, map, message, fix) }
    }

    /// With numbers; those that are not finite say nothing and are left out.
    pub(super) fn with<const N: usize>(mut self, evidence: [(&str, f64); N]) -> Self {
        // Rounded, so that a change in the last bit of a sum does not change the scores' file.
        let rounded = |value: f64| (value * 1e4).round() / 1e4;
        let finite = evidence.into_iter().filter(|(_, value)| value.is_finite());
        self.evidence.extend(finite.map(|(name, value)| (name.to_owned(), rounded(value))));
        self
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { id, level, map, message, fix, .. } = self;
        write!(f, "{}: {map}: {message}; {fix} [{id}]", level.name())
    }
}
