//! Tables that several configurations share. Their keys are documented in the presets' TOML files.
#![expect(missing_docs, reason = "the keys are documented in the presets")]

use capture::Capture;
use capture::sampling::finest_sampling;
use serde::{Deserialize, Serialize};

/// Shading networks, section 5.3 of the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetworkConfig {
    pub width: usize,
    pub hidden_layers: usize,
    pub outputs: usize,
    pub position_scale: f32,
    pub normal_scale: f32,
    pub reflection_scale: f32,
}

/// Weights of pixels, section 5.3 of the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewWeightConfig {
    pub depth: bool,
    pub depth_blur: f32,
    pub edge_slope: f32,
    pub slope_falloff: f32,
}

impl Default for ViewWeightConfig {
    fn default() -> Self {
        Self { depth: true, depth_blur: 2.0, edge_slope: 10.0, slope_falloff: 1.0 }
    }
}

/// Kingma and Ba's optimiser.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdamConfig {
    pub beta1: f32,
    pub beta2: f32,
    pub epsilon: f32,
    pub final_decay: f32,
}

impl Default for AdamConfig {
    fn default() -> Self {
        Self { beta1: 0.9, beta2: 0.999, epsilon: 1e-8, final_decay: 1.0 }
    }
}

/// Records in a maps folder besides the maps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordConfig {
    pub stages: bool,
    pub layers: bool,
}

/// Side of the textures that are solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number of texels or \"auto\"")]
pub enum TextureSize {
    /// Texels.
    Side(usize),
    /// Chosen by the pictures' sampling of the surface.
    Rule(TextureRule),
}

/// The rule for the side of the textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TextureRule {
    /// The power of two nearest to two texels per pixel of the training view that sees a place finest, on average
    /// over the surface, from 128 to 2048.
    Auto,
}

impl TextureSize {
    /// The side of the textures for the training views of a capture, texels.
    pub(crate) fn solved(self, capture: &Capture) -> usize {
        self.side(|| finest_sampling(&capture.mesh, &capture.train))
    }

    /// The side that a solve gives about, texels, where only the number of training views and of their covered pixels
    /// is known: the finest view has some five times as many pixels per unit of the chart as a view covers on average.
    pub fn expected(self, views: usize, pixels: usize) -> usize {
        self.side(|| 5.0 * pixels as f64 / views.max(1) as f64)
    }

    /// The side for pictures of which the finest has `sampling` pixels per unit of the chart. Automatic textures have
    /// two texels per pixel: the pixel grids of views that see a place about as finely lie between one another.
    fn side(self, sampling: impl FnOnce() -> f64) -> usize {
        match self {
            Self::Side(texels) => texels,
            Self::Rule(TextureRule::Auto) => {
                let exponent = (2.0 * sampling()).max(1.0).sqrt().log2().round() as u32;
                2usize.pow(exponent.clamp(7, 11))
            }
        }
    }

    /// The side of the maps, texels. With few pixels they are larger than the solved textures, which would lose
    /// detail of the mesh normal.
    pub(crate) fn maps(self, solved: usize) -> usize {
        match self {
            Self::Side(texels) => texels,
            Self::Rule(TextureRule::Auto) => solved.max(512),
        }
    }
}
