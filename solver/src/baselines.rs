//! Baselines without optimisation, which every method must beat. Another one is
//! [`capture::mean_texture`].

use capture::gbuffer::{Atlas, GBuffer};
use capture::mean_texture::with_mesh_normals;
use capture::projection::{Observation, Projection, per_texel};
use capture::{Camera, Capture, CaptureError};
use formats::Maps;
use formats::picture::Picture;

use crate::config::ViewWeightConfig;
use crate::model::taps::Taps;
use crate::semantic;

/// The semantic initialisation alone, see [`semantic::initial_diffuse_albedo`]; the rest as in
/// [`mean_texture`](capture::mean_texture::mean_texture).
pub fn semantic_initialisation(capture: &Capture, size: usize) -> Result<Maps, CaptureError> {
    let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
    let (mesh, views, weights) = (&capture.mesh, &capture.train, ViewWeightConfig::default());
    let albedo = semantic::initial_diffuse_albedo(mesh, views, &gbuffers, &weights, size, &[]);
    let atlas = Atlas::new(&capture.mesh, size);
    let projections = Projection::of_views(&capture.train, &gbuffers);
    let seen = per_texel(&atlas, &projections, |_: &[(usize, Observation)]| true);
    with_mesh_normals(capture, &atlas, albedo, &seen)
}

/// Renders a camera of `capture` with the diffuse albedo `texture` as radiance: a baseline has no light, and its albedo
/// contains the shading. Black outside of the mesh.
pub fn unlit_view(capture: &Capture, texture: &Picture, camera: &Camera) -> Picture {
    let gbuffer = GBuffer::new(&capture.mesh, camera, None);
    let (taps, order) = Taps::sorted(texture.width, &gbuffer.uvs);
    let colours = taps.sample::<3>(&texture.data);
    let mut picture = Picture::new(camera.width, camera.height, 3);
    for (sample, at) in order.into_iter().enumerate() {
        let pixel = gbuffer.pixels[at] as usize;
        let (x, y) = (pixel % camera.width, pixel / camera.width);
        picture.pixel_mut(x, y).copy_from_slice(&colours.sample::<3>(sample, 0));
    }
    picture
}

#[cfg(test)]
mod tests;
