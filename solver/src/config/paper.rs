//! The configuration of the published method. Every key is documented, with its unit, in `paper.toml`.
#![expect(missing_docs, reason = "the keys are documented in paper.toml")]

use serde::{Deserialize, Serialize};

use super::shared::*;

/// The published method (Neural Shading Fields).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaperConfig {
    pub seed: u64,
    pub networks: NetworkConfig,
    pub rendering: PaperRenderingConfig,
    pub skin: PaperSkinConfig,
    pub view_weights: ViewWeightConfig,
    pub initialisation: InitialisationConfig,
    pub warm_up: WarmUpConfig,
    pub fine_tuning: FineTuningConfig,
    pub adam: AdamConfig,
    pub normalisation: NormalisationConfig,
    pub records: RecordConfig,
}

/// Section 4.2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaperRenderingConfig {
    pub fresnel: bool,
    pub positive_albedo: bool,
    pub rounding_seed: u64,
}

/// Schlick's factor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaperSkinConfig {
    pub f0: f32,
}

/// Section 5.3, first paragraph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InitialisationConfig {
    pub semantic: bool,
    pub specular_maximum: f32,
    pub starts: usize,
    pub start_iterations: usize,
}

/// Section 4.3.1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WarmUpConfig {
    pub iterations: usize,
    pub texture_size: usize,
    pub half_resolution: bool,
    pub prior: f32,
    pub network_rate: f32,
    pub diffuse_rate: f32,
    pub specular_rate: f32,
}

/// Section 4.3.2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FineTuningConfig {
    pub rounds: usize,
    pub iterations: usize,
    pub texture_size: TextureSize,
    pub prior: f32,
    pub deviation_range: f32,
    pub deviation_smoothing: f32,
    pub deviation_extent: f32,
    pub deviation_blur: f32,
    pub diffuse_rate: f32,
    pub specular_rate: f32,
    pub deviation_rate: f32,
}

/// Section 5.4.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NormalisationConfig {
    pub diffuse_percentile: f64,
    pub specular_percentile: f64,
    pub specular_maximum: f32,
}

impl PaperConfig {
    /// The least albedo after a step.
    pub fn minimum_albedo(&self) -> f32 {
        if self.rendering.positive_albedo { 0.0 } else { f32::NEG_INFINITY }
    }

    /// The settings of the depth term of view weights; `None` for weights by the cosine only.
    pub fn depth_weights(&self) -> Option<&ViewWeightConfig> {
        Some(&self.view_weights).filter(|weights| weights.depth)
    }
}

impl Default for PaperConfig {
    fn default() -> Self {
        match super::Config::preset("paper") {
            Ok(super::Config::Paper(config)) => config,
            other => unreachable!("the preset is part of the program: {other:?}"),
        }
    }
}
