//! The mesh in texture space: its plain normal, and the true layers reprojected from
//! the training views. The solver's mean texture does both.

use std::path::Path;

use capture::Capture;
use capture::gbuffer::{Atlas, texel_area_map};
use capture::mean_texture::mean_texture;
use formats::picture::Picture;
use glam::Vec3;

use super::ScoreError;
use super::render::Render;
use super::truth::{self, Truth};

/// Albedo below which the shading of a texel is not divided out of its radiance.
const DARKEST_ALBEDO: f32 = 1e-3;

/// Truth in texture space that no file holds.
pub(super) struct Geometry {
    /// Plain normal of the mesh: unit vectors, object space.
    pub mesh_normal: Picture,
    /// Place of every texel on the mesh: metres, object space.
    pub positions: Vec<Vec3>,
    /// True diffuse shading: diffuse layer / true diffuse albedo.
    pub shading: Picture,
    /// True specular layer.
    pub specular: Picture,
    /// Surface in every texel, square millimetres.
    pub texel_area: Picture,
    /// Side of a texel on the face, millimetres: the root of the mean area.
    pub texel_mm: f64,
}

impl Geometry {
    /// Reprojects the layers of the training views onto the truth's texels.
    pub fn of(folder: &Path, truth: &Truth) -> Result<Self, ScoreError> {
        let mut capture = Capture::reopen(folder)?;
        let side = truth.diffuse_albedo.width;
        let mut layers = Vec::new();
        for view in &capture.train {
            let path = truth::folder(folder)?.join(format!("layers/{}.exr", view.camera.name));
            let render = Render::read(&truth::present(path.clone(), truth::AGAIN)?)?;
            let complete = render.diffuse.zip(render.specular);
            let pair = complete
                .ok_or_else(|| ScoreError::text(&path, "has no diffuse and specular layer"))?;
            truth::check_size(&path, truth::size(&pair.0), truth::size(&view.image))?;
            layers.push(pair);
        }
        let mut reproject = |layers: Vec<Picture>| {
            capture.train.iter_mut().zip(layers).for_each(|(view, layer)| view.image = layer);
            let maps = mean_texture(&capture, side)?;
            let absent = || ScoreError::text(folder, "its layers cannot be reprojected");
            maps.diffuse_albedo.ok_or_else(absent)
        };
        let (diffuse, specular) = layers.into_iter().unzip();
        let mut shading = reproject(diffuse)?;
        for (value, albedo) in shading.data.iter_mut().zip(&truth.diffuse_albedo.data) {
            *value /= albedo.max(DARKEST_ALBEDO);
        }
        let specular = reproject(specular)?;
        let atlas = Atlas::new(&capture.mesh, side);
        let texel_area = texel_area_map(&capture.mesh, side);
        let areas = texel_area.data.iter().filter(|area| **area > 0.0);
        let (sum, count) = areas.fold((0.0, 0.0), |(s, n), area| (s + f64::from(*area), n + 1.0));
        let texel_mm = (sum / f64::max(count, 1.0)).sqrt();
        let (mesh_normal, positions) = (atlas.normal_map(), atlas.positions);
        Ok(Self { mesh_normal, positions, shading, specular, texel_area, texel_mm })
    }
}
