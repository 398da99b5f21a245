//! The first estimate of the light, and the albedo of the maps: handed on by the steps under explicit transport.

use serde::{Deserialize, Serialize};

use super::context::TransportSetup;
use super::reflectance::Reflectances;
use crate::model::networks::Networks;
use crate::transport::CHANNELS;

/// The diffuse albedo of the maps, and the factor that makes it a reflectance.
#[derive(Serialize, Deserialize)]
pub(super) struct DiffuseReflectance {
    pub diffuse: Vec<f32>,
    pub scale: f32,
    /// Confidence in every texel, 0 to 1.
    pub confidence: Vec<f32>,
}

/// The light as the semantic colours show it.
#[derive(Serialize, Deserialize)]
pub(super) struct LightEstimate {
    pub log_light: Vec<f32>,
    pub setup: TransportSetup,
    pub networks: Networks,
    /// By which the light makes highlights; none if the networks make them.
    pub reflectances: Option<Reflectances>,
    /// R, G, B by which the light has been multiplied since, so that the diffuse albedo that it was found
    /// with is to be divided by it.
    pub tint: [f32; CHANNELS],
}
