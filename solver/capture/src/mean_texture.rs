//! The mean projected texture: a baseline that every method must beat, and a witness of what the pictures show.

use formats::fill;
use formats::maps::Maps;
use formats::picture::{GrayImage, Picture};
use glam::Vec3;

use crate::gbuffer::{Atlas, GBuffer};
use crate::projection::{Observation, Projection, per_texel};
use crate::{Capture, CaptureError, Mesh, View};

/// Pictures of views as a texture.
pub struct Projected {
    /// The surface behind the texels.
    pub atlas: Atlas,
    /// The mean of the colours that the views see at a texel, weighted by the cosine; unseen texels
    /// take the nearest seen one's.
    pub mean: Picture,
    /// Texels that at least one view sees.
    pub seen: Vec<bool>,
}

/// Projects the pictures of `views` of `mesh` into a texture of `size` texels.
pub fn project(mesh: &Mesh, views: &[View], size: usize) -> Projected {
    let gbuffers = GBuffer::of_views(mesh, views);
    let projections = Projection::of_views(views, &gbuffers);
    let atlas = Atlas::new(mesh, size);
    let mean = |seen: &[(usize, Observation)]| {
        let total: f32 = seen.iter().map(|(_, seen)| seen.cosine).sum();
        let colour =
            |(view, seen): &(usize, Observation)| seen.cosine * projections[*view].colour(seen);
        Some(seen.iter().map(colour).sum::<Vec3>() / total)
    };
    let colours: Vec<Option<Vec3>> = per_texel(&atlas, &projections, mean);
    let seen: Vec<bool> = colours.iter().map(Option::is_some).collect();
    let data = colours.iter().flat_map(|colour| colour.unwrap_or_default().to_array()).collect();
    let mut mean = Picture { width: size, height: size, channels: 3, data };
    fill::fill_from_nearest(&mut mean, &seen);
    Projected { atlas, mean, seen }
}

/// The mean projected texture as a diffuse albedo. Normals are the mesh's; there is no specular
/// albedo. Coverage: seen by at least one training view.
pub fn mean_texture(capture: &Capture, size: usize) -> Result<Maps, CaptureError> {
    let Projected { atlas, mean, seen } = project(&capture.mesh, &capture.train, size);
    with_mesh_normals(capture, &atlas, mean, &seen)
}

/// The coverage of a square texture: 255 in the texels `seen` by a view.
pub fn coverage(seen: &[bool]) -> GrayImage {
    let size = seen.len().isqrt();
    let data = seen.iter().map(|seen| if *seen { 255 } else { 0 }).collect();
    GrayImage { width: size, height: size, data }
}

/// Maps of a diffuse albedo and the normals of the mesh, without a specular albedo. Coverage: `seen`.
///
/// # Errors
/// If no texel is seen.
pub fn with_mesh_normals(
    capture: &Capture,
    atlas: &Atlas,
    diffuse_albedo: Picture,
    seen: &[bool],
) -> Result<Maps, CaptureError> {
    if !seen.contains(&true) {
        return Err(CaptureError::NothingVisible(capture.folder.clone()));
    }
    Ok(Maps {
        diffuse_albedo: Some(diffuse_albedo),
        specular_albedo: None,
        diffuse_normal: Some(atlas.normal_map()),
        specular_normal: Some(atlas.normal_map()),
        confidence: None,
        roughness: None,
        coverage: Some(coverage(seen)),
    })
}
