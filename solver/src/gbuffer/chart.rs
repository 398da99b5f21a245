//! The mesh unrolled into texture space: what lies at each texel, and who sees it.

use rayon::prelude::*;

use super::fill::fill;
use super::raster::{Fragments, SurfacePoint};
use super::views::{Observation, SeenView};
use crate::capture::{Capture, Mesh};
use crate::picture::{GrayImage, Picture};

/// The surface point at each texel's centre; `None` outside the chart.
pub struct Chart {
    /// Side, texels.
    pub size: usize,
    /// Row-major, row 0 at v = 1.
    pub points: Vec<Option<SurfacePoint>>,
}

impl Chart {
    /// Rasterises the mesh's texture coordinates.
    pub fn new(mesh: &Mesh, size: usize) -> Self {
        let fragments = Fragments::of_chart(mesh, size);
        let points =
            (0..size * size).into_par_iter().map(|at| fragments.surface(mesh, at)).collect();
        Self { size, points }
    }

    /// For each texel, `summary` of what the views show of it, in the views' order.
    pub fn observe<T: Send>(
        &self,
        views: &[SeenView],
        summary: impl Fn(&mut dyn Iterator<Item = Observation>) -> T + Sync,
    ) -> Vec<T> {
        let observe = |point: &Option<SurfacePoint>| {
            let seen = |point| views.iter().filter_map(move |view: &SeenView| view.observe(point));
            summary(&mut point.iter().flat_map(seen))
        };
        self.points.par_iter().map(observe).collect()
    }

    /// 255 where at least one view sees the texel.
    pub fn coverage(&self, views: &[SeenView]) -> GrayImage {
        let data = self.observe(views, |seen| if seen.next().is_some() { 255 } else { 0 });
        GrayImage { width: self.size, height: self.size, data }
    }

    /// The mesh's normals, continued smoothly outside the chart; unit vectors.
    pub fn normals(&self) -> Picture {
        let mut normals = Picture::new(self.size, self.size, 3);
        for (pixel, point) in normals.data.chunks_exact_mut(3).zip(&self.points) {
            if let Some(point) = point {
                pixel.copy_from_slice(&point.normal.to_array());
            }
        }
        let inside: Vec<bool> = self.points.iter().map(Option::is_some).collect();
        fill(&mut normals, &inside);
        normalise(&mut normals);
        normals
    }
}

/// Makes every pixel of a three-channel picture a unit vector; a zero becomes +Z.
pub fn normalise(vectors: &mut Picture) {
    for pixel in vectors.data.chunks_exact_mut(3) {
        let unit = glam::Vec3::from_slice(pixel).normalize_or(glam::Vec3::Z);
        pixel.copy_from_slice(&unit.to_array());
    }
}

/// The plain mesh normal as a map of side `size`: what a recovered normal map has to beat.
pub fn mesh_normal_map(capture: &Capture, size: usize) -> Picture {
    Chart::new(&capture.mesh, size).normals()
}
