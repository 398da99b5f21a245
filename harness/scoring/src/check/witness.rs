//! Evidence of a capture on its maps, without its truth: the mean projected texture, the mesh in
//! texture space, and the cameras' places.

use capture::gbuffer::Atlas;
use capture::mean_texture::mean_texture;
use capture::{Capture, CaptureError};
use glam::{Mat3, Vec3};

use super::reduced::{Reduced, SIDE, quantile};
use crate::metrics::luminance;

/// Side at which the pictures are projected, texels: finer than what is compared, so that pores
/// are averaged and not picked.
const PROJECTED: usize = 2 * SIDE;
/// Share of the bright texels' luminance below which a texel lies in shadow: its colour is noise.
const SHADOW: f64 = 0.15;

/// All in texels of [`SIDE`] by [`SIDE`].
pub(super) struct Witness {
    /// The mean of the projected colours, as the baseline makes it.
    pub texture: Reduced,
    /// The mesh's own unit normals, object space.
    pub normals: Vec<Vec3>,
    /// Seen by a training view.
    pub seen: Vec<bool>,
    /// Seen, and not in shadow.
    pub lit: Vec<bool>,
    /// Inside the chart.
    pub chart: Vec<bool>,
    /// World to camera of every view, OpenGL axes, with the view's name.
    pub cameras: Vec<(String, Mat3)>,
    /// Pixels of the face in the view that shows most of it.
    pub pixels: usize,
}

impl Witness {
    /// Projects the training views of a capture.
    pub fn of(capture: &Capture) -> Result<Self, CaptureError> {
        let maps = mean_texture(capture, PROJECTED)?;
        let atlas = Atlas::new(&capture.mesh, SIDE);
        let nothing = || CaptureError::NothingVisible(capture.folder.clone());
        let texture = Reduced::of(&maps.diffuse_albedo.ok_or_else(nothing)?);
        let coverage = maps.coverage.ok_or_else(nothing)?;
        let whole = |texel: usize| {
            let (x, y) = (2 * (texel % SIDE), 2 * (texel / SIDE));
            let corner = y * PROJECTED + x;
            [corner, corner + 1, corner + PROJECTED, corner + PROJECTED + 1]
                .iter()
                .all(|texel| coverage.data[*texel] == 255)
        };
        let seen: Vec<bool> =
            (0..SIDE * SIDE).map(|t| atlas.inside[t] && texture.valid[t] && whole(t)).collect();
        let light = |texel: usize| brightness(texture.texel(texel));
        let of_seen = (0..SIDE * SIDE).filter(|texel| seen[*texel]);
        let bright = quantile(of_seen.map(|texel| light(texel) as f32), 0.9).unwrap_or(0.0);
        let lit = (0..SIDE * SIDE).map(|t| seen[t] && light(t) > SHADOW * bright).collect();
        let rotation = |camera: &capture::Camera| {
            (camera.name.clone(), Mat3::from_mat4(camera.world_to_camera()))
        };
        let train = capture.train.iter().map(|view| &view.camera);
        let shown =
            |view: &capture::View| view.mask.data.iter().filter(|value| **value == 255).count();
        Ok(Self {
            normals: atlas.normals,
            seen,
            lit,
            chart: atlas.inside,
            cameras: train.chain(&capture.withheld).map(rotation).collect(),
            pixels: capture.train.iter().map(shown).max().unwrap_or(0),
            texture,
        })
    }

    /// The fraction of the unit square that the chart takes.
    pub fn chart_fraction(&self) -> f64 {
        self.chart.iter().filter(|inside| **inside).count() as f64 / self.chart.len() as f64
    }
}

/// Luminance of a linear RGB colour; a grey's value.
pub(super) fn brightness(values: &[f32]) -> f64 {
    luminance(values.iter().map(|value| f64::from(*value)))
}
