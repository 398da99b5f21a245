//! Rasterisation at pixel centres: which triangle is first along the ray, and where it is hit.
//!
//! Two-dimensional homogeneous rasterisation (Olano and Greer 1997): the barycentric coordinates
//! over depth of a triangle are linear in the picture, so neither a division before the test nor
//! clipping at a near plane is needed. A common edge of two triangles has exactly opposite edge
//! functions, so no pixel falls between them.

use formats::cancel;
use glam::{DMat4, DVec3, Vec3};
use rayon::prelude::*;

use crate::{Camera, Mesh};

/// Rows that one task paints.
const BAND: usize = 16;
/// Pixels added around a triangle's box, against rounding of the projected corners.
const BOX_MARGIN: f64 = 1e-6;

/// The first surface at a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index of the triangle.
    pub triangle: u32,
    /// True if the triangle's counter-clockwise side is seen.
    pub front: bool,
    /// Weights of the triangle's corners in space (perspective-correct); their sum is 1.
    pub barycentric: Vec3,
    /// Metres along the optical axis.
    pub depth: f32,
}

/// The nearest surface at every pixel, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `height * width` pixels; none where no triangle is in front of the camera.
    pub hits: Vec<Option<Hit>>,
}

/// The first surface of `mesh` at every pixel's centre of `camera`; of equally near triangles the
/// one with the lower index.
pub fn rasterise(mesh: &Mesh, camera: &Camera) -> Raster {
    let to_camera = camera.world_to_camera().as_dmat4();
    let corners: Vec<DVec3> =
        mesh.positions.iter().map(|p| homogeneous(camera, &to_camera, *p)).collect();
    paint(camera.width, camera.height, &corners, &mesh.triangles)
}

/// Pixel coordinates times depth, and depth.
fn homogeneous(camera: &Camera, to_camera: &DMat4, point: Vec3) -> DVec3 {
    let local = to_camera.transform_point3(point.as_dvec3());
    let [fx, fy] = camera.focal.map(f64::from);
    let [cx, cy] = camera.centre.map(f64::from);
    let depth = -local.z;
    DVec3::new(fx * local.x + cx * depth, cy * depth - fy * local.y, depth)
}

/// Rasterises triangles whose corners are given as (column, row, 1) times depth.
pub(super) fn paint(
    width: usize,
    height: usize,
    corners: &[DVec3],
    triangles: &[[u32; 3]],
) -> Raster {
    let facets: Vec<Facet> = triangles
        .par_iter()
        .enumerate()
        .filter_map(|(index, triangle)| {
            Facet::new(index as u32, triangle.map(|c| corners[c as usize]), width, height)
        })
        .collect();
    let mut bands = vec![Vec::new(); height.div_ceil(BAND)];
    for (index, facet) in facets.iter().enumerate() {
        for band in &mut bands[facet.rows.0 / BAND..=facet.rows.1 / BAND] {
            band.push(index as u32);
        }
    }
    let mut hits = vec![None; width * height];
    hits.par_chunks_mut((width * BAND).max(1)).zip(&bands).enumerate().for_each(
        |(band, (pixels, members))| {
            cancel::check();
            for member in members {
                facets[*member as usize].paint(pixels, width, band * BAND);
            }
        },
    );
    Raster { width, height, hits }
}

/// A triangle ready to be painted.
struct Facet {
    index: u32,
    front: bool,
    /// Edge functions: linear in (column, row, 1), not negative inside.
    edges: [DVec3; 3],
    /// Factor from edge functions to barycentric coordinates over depth.
    scale: f64,
    /// First and last column and row with a pixel's centre in the box.
    columns: (usize, usize),
    rows: (usize, usize),
}

impl Facet {
    fn new(index: u32, corners: [DVec3; 3], width: usize, height: usize) -> Option<Self> {
        let [a, b, c] = corners;
        let cross = [b.cross(c), c.cross(a), a.cross(b)];
        let determinant = a.dot(cross[0]);
        if determinant == 0.0 || !determinant.is_finite() || corners.iter().all(|v| v.z <= 0.0) {
            return None;
        }
        let span = |axis: usize, size: usize| {
            if corners.iter().any(|v| v.z <= 0.0) {
                return size.checked_sub(1).map(|last| (0, last));
            }
            let at = corners.map(|v| v[axis] / v.z);
            let low = at.into_iter().fold(f64::INFINITY, f64::min) - 0.5 - BOX_MARGIN;
            let high = at.into_iter().fold(f64::NEG_INFINITY, f64::max) - 0.5 + BOX_MARGIN;
            let (first, last) = (low.ceil().max(0.0), high.floor().min(size as f64 - 1.0));
            (first <= last).then_some((first as usize, last as usize))
        };
        Some(Self {
            index,
            // The picture's rows run downwards, which turns the sense of rotation.
            front: determinant < 0.0,
            edges: cross.map(|edge| edge * determinant.signum()),
            scale: determinant.abs().recip(),
            columns: span(0, width)?,
            rows: span(1, height)?,
        })
    }

    /// Paints the rows from `top` on that `pixels` holds.
    fn paint(&self, pixels: &mut [Option<Hit>], width: usize, top: usize) {
        let bottom = top + pixels.len() / width - 1;
        for row in self.rows.0.max(top)..=self.rows.1.min(bottom) {
            for column in self.columns.0..=self.columns.1 {
                let centre = DVec3::new(column as f64 + 0.5, row as f64 + 0.5, 1.0);
                let inside = self.edges.map(|edge| edge.dot(centre));
                let sum: f64 = inside.iter().sum();
                if inside.iter().any(|edge| *edge < 0.0) || sum <= 0.0 {
                    continue;
                }
                let depth = (1.0 / (sum * self.scale)) as f32;
                let pixel = &mut pixels[(row - top) * width + column];
                if pixel.is_none_or(|nearest| depth < nearest.depth) {
                    let barycentric = (DVec3::from_array(inside) / sum).as_vec3();
                    let Self { index: triangle, front, .. } = *self;
                    *pixel = Some(Hit { triangle, front, barycentric, depth });
                }
            }
        }
    }
}
