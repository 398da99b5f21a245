//! Baselines that need no optimisation; every method must beat them. The other one is
//! [`capture::mean_texture`].

use capture::gbuffer::{Atlas, GBuffer};
use capture::mean_texture::with_mesh_normals;
use capture::projection::{Observation, Projection, per_texel};
use capture::{Capture, CaptureError};
use formats::Maps;

use crate::{Config, semantic};

/// The semantic initialisation alone, see [`semantic::initial_diffuse_albedo`]; the rest as in
/// [`mean_texture`](capture::mean_texture::mean_texture).
pub fn semantic_initialisation(capture: &Capture, size: usize) -> Result<Maps, CaptureError> {
    let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
    let (mesh, views, weights) = (&capture.mesh, &capture.train, Config::default().view_weights);
    let albedo = semantic::initial_diffuse_albedo(mesh, views, &gbuffers, &weights, size, &[]);
    let atlas = Atlas::new(&capture.mesh, size);
    let projections = Projection::of_views(&capture.train, &gbuffers);
    let seen = per_texel(&atlas, &projections, |_: &[(usize, Observation)]| true);
    with_mesh_normals(capture, &atlas, albedo, &seen)
}

#[cfg(test)]
mod tests;
