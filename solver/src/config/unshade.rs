//! The configuration of the default method. Every key is documented, with its unit, in `unshade.toml`.
#![expect(missing_docs, reason = "the keys are documented in unshade.toml")]

use serde::{Deserialize, Serialize};

use super::shared::*;

/// The default method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnshadeConfig {
    pub seed: u64,
    pub rendering: RenderingConfig,
    pub skin: SkinConfig,
    pub regions: RegionConfig,
    pub transport: TransportConfig,
    pub light: LightConfig,
    pub joint: JointConfig,
    pub reflectance: ReflectanceConfig,
    pub roughness: RoughnessConfig,
    pub relief: ReliefConfig,
    pub albedo: AlbedoConfig,
    pub model_error: ModelErrorConfig,
    pub maps: MapConfig,
    pub records: RecordConfig,
}

/// The pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RenderingConfig {
    pub exposure: f32,
    pub rounding_seed: u64,
}

/// The specular reflection of skin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SkinConfig {
    pub f0: f32,
    pub roughness: [f32; 2],
    pub weights: [f32; 2],
    pub reflectance: f32,
}

impl SkinConfig {
    /// Roughness and weight of each lobe.
    pub(crate) fn lobes(&self) -> [(f32, f32); 2] {
        std::array::from_fn(|lobe| (self.roughness[lobe], self.weights[lobe]))
    }
}

/// Regions of the face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionConfig {
    pub skin_labels: Vec<String>,
    pub texture_size: usize,
    pub hair_in_skin: bool,
}

/// Shadowed light transport.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransportConfig {
    pub texture_size: usize,
    pub rows: usize,
    pub rays_per_cell_side: usize,
    pub bounces: usize,
    pub bounce_albedo: f32,
}

/// The light under the first colours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightConfig {
    pub rounds: usize,
    pub steps: usize,
    pub rate: f32,
    pub nearness_rate: f32,
    pub colour: f32,
    pub colour_softness: f32,
    pub samples: usize,
}

impl LightConfig {
    /// The steps of a round, from 1.
    pub(crate) fn steps_of(&self, round: usize) -> usize {
        self.steps * round / self.rounds - self.steps * (round - 1) / self.rounds
    }
}

/// Light and albedo together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointConfig {
    pub grey_steps: usize,
    pub steps: usize,
    pub light_rate: f32,
    pub albedo_rate: f32,
    pub prior: f32,
}

/// Specular reflectance of each region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReflectanceConfig {
    pub skin_deviation: f32,
    pub region_deviation: f32,
    pub skin_error: f32,
    pub region_error: f32,
    pub region_floor: f32,
    pub exposure_deviation: f32,
}

/// Roughness of each region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoughnessConfig {
    pub rounds: usize,
    pub samples: usize,
    pub deviation: f32,
    pub error: f32,
}

/// Normals from heights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReliefConfig {
    pub texture_scale: f32,
    pub linearisations: usize,
    pub reweightings: usize,
    pub steps: usize,
    pub flatness: f32,
    pub smoothness: f32,
    pub albedo_damping: f32,
    pub usual_deviation: f32,
    pub usual_albedo_detail: f32,
    pub diffuse_share: f32,
    pub minimum_agreement: f32,
}

/// The diffuse albedo on the full pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlbedoConfig {
    pub steps: usize,
    pub rate: f32,
    pub prior: f32,
}

/// Standard deviations of the model's errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelErrorConfig {
    pub shading: f32,
    pub normal: f32,
    pub highlights: f32,
    pub shadow: f32,
    pub disagreement: f32,
}

/// The maps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapConfig {
    pub texture_size: TextureSize,
}

impl Default for TransportConfig {
    fn default() -> Self {
        UnshadeConfig::default().transport
    }
}

impl Default for UnshadeConfig {
    fn default() -> Self {
        match super::Config::preset("unshade") {
            Ok(super::Config::Unshade(config)) => config,
            other => unreachable!("the preset is part of the program: {other:?}"),
        }
    }
}
