//! The first estimate of the light, and the albedo of the maps: handed on by the steps under explicit transport.

use serde::{Deserialize, Serialize};

use super::context::TransportSetup;
use super::region_terms::RegionTerms;
use crate::model::networks::Networks;
use crate::transport::{CHANNELS, Transport};

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
    /// Likewise, of either half of the face; see [`super::halves`].
    pub halves: Option<[Vec<f32>; 2]>,
    /// How far the shading by either half is from that by both, in the mean, over its mean.
    pub doubt: Option<f32>,
    pub setup: TransportSetup,
    pub networks: Networks,
    /// By which the light makes highlights; none if the networks make them.
    pub region_terms: Option<RegionTerms>,
    /// R, G, B by which the light has been multiplied since, so that the diffuse albedo that it was found
    /// with is to be divided by it.
    pub tint: [f32; CHANNELS],
}

/// The median over texels of the mean reflectance of R, G and B, under a light: what light bounces off.
pub(super) fn bounce_albedo(transport: &Transport, light: &[f32], diffuse: &[f32]) -> f32 {
    let mut means: Vec<f32> =
        diffuse.chunks_exact(CHANNELS).map(|rgb| rgb.iter().sum::<f32>() / 3.0).collect();
    let middle = means.len() / 2;
    let (_, median, _) = means.select_nth_unstable_by(middle, f32::total_cmp);
    (*median * transport.peak(light)).min(1.0)
}
