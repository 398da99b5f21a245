//! The three numbers that plots show of a method in a case.

use crate::score_key::{ALBEDO, RELIT_OTHERS, SPECULAR_NORMAL, ScoreKey};

/// A number of a method, with its name in captions and tables and its label on axes.
pub(super) struct Quantity {
    pub name: &'static str,
    pub label: &'static str,
    pub key: ScoreKey,
}

pub(super) const QUANTITIES: [Quantity; 3] = [
    Quantity { name: "diffuse albedo", label: "diffuse albedo, PSNR, dB ↑", key: ALBEDO },
    Quantity {
        name: "relit in other lights",
        label: "relit, other lights, PSNR, dB ↑",
        key: RELIT_OTHERS,
    },
    Quantity {
        name: "specular normal",
        label: "specular normal, mean angle, ° ↓",
        key: SPECULAR_NORMAL,
    },
];
