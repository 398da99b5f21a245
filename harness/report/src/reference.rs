//! The reference of a method's pictures: the truth of a rendered capture, or withheld photographs.

use std::path::Path;

use scoring::score;
use serde::Serialize;

/// Origin of the pictures that a capture is scored against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Reference {
    /// Maps and pictures of the renderer that made the capture.
    Truth,
    /// Withheld photographs; the true maps and the true light are unknown.
    Photograph,
}

impl Reference {
    /// The reference of a capture's folder.
    pub fn of(capture: &Path) -> Self {
        if score::is_photographed(capture) { Self::Photograph } else { Self::Truth }
    }

    /// The name of a picture of it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Truth => "truth",
            Self::Photograph => "photograph",
        }
    }

    /// The name of a picture of any of several captures.
    pub fn common_word(mut all: impl Iterator<Item = Self>) -> &'static str {
        match all.next() {
            Some(first) if all.all(|other| other == first) => first.word(),
            _ => "truth or photograph",
        }
    }
}

/// The light that the pictures of a capture are relit in for comparison, in words: its own if that is known,
/// else the one that each method recovered.
pub(super) fn own_light(light: &str) -> String {
    match light {
        score::FOUND_LIGHT => "the light that the method recovered".to_owned(),
        light => format!("{light}, the capture's light"),
    }
}
