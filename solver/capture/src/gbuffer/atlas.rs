//! The mesh in texture space: the point of the surface behind every texel.

use formats::fill;
use formats::picture::Picture;
use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::raster::{self, Hit};
use crate::Mesh;

/// The surface behind every texel of a square texture, row 0 at v = 1: texel (i, j) of N has its
/// centre at u = (i + 0.5) / N, v = 1 - (j + 0.5) / N.
///
/// Outside the chart a texel takes the values of the nearest one inside, so that bilinear look-ups
/// at the rim are sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// Side in texels.
    pub size: usize,
    /// True if the texel's centre is in the chart.
    pub inside: Vec<bool>,
    /// Metres, world space.
    pub positions: Vec<Vec3>,
    /// Unit, world space.
    pub normals: Vec<Vec3>,
}

impl Atlas {
    /// Rasterises the chart; where it overlaps itself, one of the triangles is taken.
    pub fn new(mesh: &Mesh, size: usize) -> Self {
        let hits = raster::paint(size, size, &texel_corners(mesh, size), &mesh.triangles).hits;
        let inside: Vec<bool> = hits.iter().map(Option::is_some).collect();
        let nearest = fill::nearest_known(&inside, size, size);
        let at = |texel: &u32| hits[*texel as usize];
        let position = |hit: Hit| mesh.blend(&hit, &mesh.positions);
        let normal = |hit: Hit| mesh.normal_at(&hit);
        Self {
            size,
            positions: nearest.par_iter().map(|t| at(t).map_or(Vec3::ZERO, position)).collect(),
            normals: nearest.par_iter().map(|t| at(t).map_or(Vec3::Z, normal)).collect(),
            inside,
        }
    }

    /// The normals as a picture of three channels.
    pub fn normal_map(&self) -> Picture {
        let data = self.normals.iter().flat_map(|normal| normal.to_array()).collect();
        Picture { width: self.size, height: self.size, channels: 3, data }
    }
}

/// The surface area in every texel of a square map, square millimetres, one channel; 0 outside the chart.
pub fn texel_area_map(mesh: &Mesh, size: usize) -> Picture {
    let area_of = |hit: &Hit| {
        let corners = mesh.triangles[hit.triangle as usize].map(|corner| corner as usize);
        let [a, b, c] = corners.map(|corner| mesh.positions[corner].as_dvec3());
        let [p, q, r] = corners.map(|corner| mesh.uvs[corner].as_dvec2());
        let surface = (b - a).cross(c - a).length() * 1e6;
        (surface / ((q - p).perp_dot(r - p).abs() * (size * size) as f64)) as f32
    };
    let hits = raster::paint(size, size, &texel_corners(mesh, size), &mesh.triangles).hits;
    let data = hits.par_iter().map(|hit| hit.as_ref().map_or(0.0, area_of)).collect();
    Picture { width: size, height: size, channels: 1, data }
}

/// The mesh's texture coordinates in texels, from the upper left corner.
fn texel_corners(mesh: &Mesh, size: usize) -> Vec<DVec3> {
    let side = size as f64;
    let corner =
        |uv: &Vec2| DVec3::new(f64::from(uv.x) * side, (1.0 - f64::from(uv.y)) * side, 1.0);
    mesh.uvs.iter().map(corner).collect()
}

/// The mesh's own normals as a square map of `size` texels: unit vectors in object space.
pub fn mesh_normal_map(mesh: &Mesh, size: usize) -> Picture {
    Atlas::new(mesh, size).normal_map()
}
