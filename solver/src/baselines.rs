//! Baselines that need no optimisation; every method must beat them.

use glam::Vec3;

use crate::capture::{Capture, CaptureError};
use crate::fill;
use crate::gbuffer::{Atlas, GBuffer};
use crate::maps::Maps;
use crate::picture::{GrayImage, Picture};
use crate::projection::{Observation, Projection, per_texel};
use crate::semantic;

/// The mean projected texture: the diffuse albedo is the mean of the colours the training views
/// see at a texel, weighted by the cosine; unseen texels take the nearest seen one's. Normals are
/// the mesh's; there is no specular albedo. Coverage: seen by at least one view.
pub fn mean_texture(capture: &Capture, size: usize) -> Result<Maps, CaptureError> {
    let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
    let projections = Projection::of_views(&capture.train, &gbuffers);
    let atlas = Atlas::new(&capture.mesh, size);
    let mean = |seen: &[(usize, Observation)]| {
        let total: f32 = seen.iter().map(|(_, seen)| seen.cosine).sum();
        let colour =
            |(view, seen): &(usize, Observation)| seen.cosine * projections[*view].colour(seen);
        Some(seen.iter().map(colour).sum::<Vec3>() / total)
    };
    let colours: Vec<Option<Vec3>> = per_texel(&atlas, &projections, mean);
    let seen: Vec<bool> = colours.iter().map(Option::is_some).collect();
    let data = colours.iter().flat_map(|colour| colour.unwrap_or_default().to_array()).collect();
    let mut albedo = Picture { width: size, height: size, channels: 3, data };
    fill::fill_from_nearest(&mut albedo, &seen);
    maps(capture, &atlas, albedo, &seen)
}

/// The semantic initialisation alone, see [`semantic::initial_diffuse_albedo`]; the rest as in
/// [`mean_texture`].
pub fn semantic_initialisation(capture: &Capture, size: usize) -> Result<Maps, CaptureError> {
    let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
    let albedo =
        semantic::initial_diffuse_albedo(&capture.mesh, &capture.train, &gbuffers, size, &[]);
    let atlas = Atlas::new(&capture.mesh, size);
    let projections = Projection::of_views(&capture.train, &gbuffers);
    let seen = per_texel(&atlas, &projections, |_: &[(usize, Observation)]| true);
    maps(capture, &atlas, albedo, &seen)
}

fn maps(
    capture: &Capture,
    atlas: &Atlas,
    diffuse_albedo: Picture,
    seen: &[bool],
) -> Result<Maps, CaptureError> {
    if !seen.contains(&true) {
        return Err(CaptureError::NothingVisible(capture.folder.clone()));
    }
    let size = atlas.size;
    let data = seen.iter().map(|seen| if *seen { 255 } else { 0 }).collect();
    Ok(Maps {
        diffuse_albedo: Some(diffuse_albedo),
        specular_albedo: None,
        diffuse_normal: Some(atlas.normal_map()),
        specular_normal: Some(atlas.normal_map()),
        confidence: None,
        roughness: None,
        coverage: Some(GrayImage { width: size, height: size, data }),
    })
}

#[cfg(test)]
mod tests;
