//! The figures of the leaderboard.

use scoring::metrics::Direction;

use crate::score_key::{
    ALBEDO, ALBEDO_AS_IS, DIFFUSE_NORMAL, RELIT_OTHERS, RELIT_OWN, SPECULAR_ALBEDO,
    SPECULAR_NORMAL, ScoreKey, VIEW,
};

/// A column of the leaderboard.
#[derive(Debug)]
pub(super) struct Figure {
    pub name: &'static str,
    pub unit: &'static str,
    pub decimals: usize,
    pub key: ScoreKey,
}

const fn figure(name: &'static str, unit: &'static str, decimals: usize, key: ScoreKey) -> Figure {
    Figure { name, unit, decimals, key }
}

/// In the order of the page.
pub(super) const FIGURES: [Figure; 8] = [
    figure("relit, other lights", "dB", 2, RELIT_OTHERS),
    figure("relit, own light", "dB", 2, RELIT_OWN),
    figure("albedo", "dB", 2, ALBEDO),
    figure("albedo as is", "dB", 2, ALBEDO_AS_IS),
    figure("specular normal", "°", 3, SPECULAR_NORMAL),
    figure("diffuse normal", "°", 3, DIFFUSE_NORMAL),
    figure("specular albedo", "RMSE", 5, SPECULAR_ALBEDO),
    figure("own views", "dB", 2, VIEW),
];

impl Figure {
    /// Returns whether larger values are better.
    pub fn higher(&self) -> bool {
        self.key.direction() == Direction::Higher
    }
}
