//! The kinds of step of the paper's optimisation.

use serde::Serialize;

/// A kind of step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Networks and albedos together.
    WarmUp,
    /// Normals and specular albedo.
    Normals,
    /// Diffuse albedo.
    Diffuse,
}

impl Kind {
    /// All of them, in the order of a solve.
    pub const ALL: [Self; 3] = [Self::WarmUp, Self::Normals, Self::Diffuse];

    /// In a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::WarmUp => "warm-up",
            Self::Normals => "normals and specular",
            Self::Diffuse => "diffuse",
        }
    }
}
