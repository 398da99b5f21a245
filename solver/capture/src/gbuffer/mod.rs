//! The G-buffer: the mesh as a camera sees it, one sample per covered pixel, and in texture space.

mod atlas;
mod raster;

use formats::picture::GrayImage;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::{Camera, Mesh, View};

pub use atlas::{Atlas, mesh_normal_map, texel_area_map};
pub use raster::{Hit, Raster, rasterise};

/// The surface behind every covered pixel of a camera, in the order of the pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct GBuffer {
    /// Columns of the picture.
    pub width: usize,
    /// Rows of the picture.
    pub height: usize,
    /// Focal length in pixels, the smaller of the two.
    pub focal: f32,
    /// row * width + column, ascending.
    pub pixels: Vec<u32>,
    /// Metres, world space.
    pub positions: Vec<Vec3>,
    /// Unit, interpolated between the vertices.
    pub normals: Vec<Vec3>,
    /// Unit, from the surface to the camera.
    pub view_dirs: Vec<Vec3>,
    /// u right, v up.
    pub uvs: Vec<Vec2>,
    /// Metres along the optical axis.
    pub depths: Vec<f32>,
}

impl GBuffer {
    /// Samples where the first surface shows its front and, if there is a mask of the camera's
    /// size, where the mask is 255.
    pub fn new(mesh: &Mesh, camera: &Camera, mask: Option<&GrayImage>) -> Self {
        let raster = rasterise(mesh, camera);
        let masked = |pixel: usize| mask.is_none_or(|mask| mask.data[pixel] == 255);
        let front: Vec<(u32, Hit)> = (raster.hits.iter().enumerate())
            .filter_map(|(pixel, hit)| hit.map(|hit| (pixel as u32, hit)))
            .filter(|(pixel, hit)| hit.front && masked(*pixel as usize))
            .collect();
        let eye = camera.position();
        let position = |hit: &Hit| mesh.blend(hit, &mesh.positions);
        Self {
            width: camera.width,
            height: camera.height,
            focal: camera.focal[0].min(camera.focal[1]),
            pixels: front.iter().map(|(pixel, _)| *pixel).collect(),
            positions: front.iter().map(|(_, hit)| position(hit)).collect(),
            normals: front.iter().map(|(_, hit)| mesh.normal_at(hit)).collect(),
            view_dirs: front
                .iter()
                .map(|(_, hit)| (eye - position(hit)).normalize_or(Vec3::Z))
                .collect(),
            uvs: front.iter().map(|(_, hit)| mesh.blend(hit, &mesh.uvs)).collect(),
            depths: front.iter().map(|(_, hit)| hit.depth).collect(),
        }
    }

    /// One G-buffer per view, restricted to the view's mask.
    pub fn of_views(mesh: &Mesh, views: &[View]) -> Vec<Self> {
        views.par_iter().map(|view| Self::new(mesh, &view.camera, Some(&view.mask))).collect()
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// True if the camera sees nothing of the mesh.
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// Spreads a value per sample over the picture; `empty` elsewhere.
    pub fn spread<T: Copy>(&self, values: &[T], empty: T) -> Vec<T> {
        let mut grid = vec![empty; self.width * self.height];
        for (pixel, value) in self.pixels.iter().zip(values) {
            grid[*pixel as usize] = *value;
        }
        grid
    }
}

impl Mesh {
    /// A vertex attribute where a triangle is hit.
    fn blend<T>(&self, hit: &Hit, attribute: &[T]) -> T
    where
        T: Copy + std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
    {
        let [a, b, c] =
            self.triangles[hit.triangle as usize].map(|corner| attribute[corner as usize]);
        a * hit.barycentric.x + b * hit.barycentric.y + c * hit.barycentric.z
    }

    /// The unit normal where a triangle is hit.
    fn normal_at(&self, hit: &Hit) -> Vec3 {
        self.blend(hit, &self.normals).normalize_or(Vec3::Z)
    }
}

#[cfg(test)]
mod tests;
