//! The mesh in texture space: its plain normal, and the true layers reprojected from
//! the training views. The solver's mean texture does both.

use std::path::Path;

use capture::mean_texture::mean_texture;
use capture::{Capture, Mesh};
use formats::picture::Picture;

use super::ScoreError;
use super::render::Render;
use super::truth::{self, Truth};

/// Albedo below which the shading of a texel is not divided out of its radiance.
const DARKEST_ALBEDO: f32 = 1e-3;

/// Truth in texture space that no file holds.
pub(super) struct Geometry {
    /// Plain normal of the mesh: unit vectors, object space.
    pub mesh_normal: Picture,
    /// True diffuse shading: diffuse layer / true diffuse albedo.
    pub shading: Picture,
    /// True specular layer.
    pub specular: Picture,
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
            Ok::<_, ScoreError>((
                maps.diffuse_albedo.ok_or_else(absent)?,
                maps.specular_normal.ok_or_else(absent)?,
            ))
        };
        let (diffuse, specular) = layers.into_iter().unzip();
        let (mut shading, mesh_normal) = reproject(diffuse)?;
        for (value, albedo) in shading.data.iter_mut().zip(&truth.diffuse_albedo.data) {
            *value /= albedo.max(DARKEST_ALBEDO);
        }
        let (specular, _) = reproject(specular)?;
        let texel_mm = texel_side(&capture.mesh) * 1000.0 / side as f64;
        Ok(Self { mesh_normal, shading, specular, texel_mm })
    }
}

/// Side of the square on the surface that has as much area as the whole texture, if all of it were
/// as the chart is, metres.
fn texel_side(mesh: &Mesh) -> f64 {
    let areas = mesh.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize].as_dvec3());
        let [p, q, r] = corners.map(|corner| mesh.uvs[corner as usize].as_dvec2());
        ((b - a).cross(c - a).length(), (q - p).perp_dot(r - p).abs())
    });
    let (surface, chart) = areas.fold((0.0, 0.0), |(s, c), (area, uv)| (s + area, c + uv));
    if chart > 0.0 { (surface / chart).sqrt() } else { 0.0 }
}
