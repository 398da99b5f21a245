//! From a texel back to the pictures: where a point of the surface is seen, and how well.

use formats::cancel;
use glam::Vec3;
use rayon::prelude::*;

use crate::View;
use crate::gbuffer::{Atlas, GBuffer};

/// Cosine between view and normal below which a point is not used: its footprint is too long.
const MIN_COSINE: f32 = 0.1;

/// A point of the surface as a view sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Column and row in pixels; the pixel that contains it is covered.
    pub at: [f32; 2],
    /// Cosine between view and normal.
    pub cosine: f32,
}

/// A view with what its G-buffer says about occlusion.
pub struct Projection<'a> {
    /// The view.
    pub view: &'a View,
    /// Metres per pixel; infinite where there is no sample.
    depth: Vec<f32>,
}

impl<'a> Projection<'a> {
    /// A projection into `view`; the G-buffer is the one of its camera and mask.
    pub fn new(view: &'a View, gbuffer: &GBuffer) -> Self {
        Self { view, depth: gbuffer.spread(&gbuffer.depths, f32::INFINITY) }
    }

    /// Projections into all views.
    pub fn of_views(views: &'a [View], gbuffers: &[GBuffer]) -> Vec<Self> {
        views.iter().zip(gbuffers).map(|(view, gbuffer)| Self::new(view, gbuffer)).collect()
    }

    /// The observation of a point, if it is visible: in the picture and the mask, turned to the
    /// camera, and as deep as the surface at that pixel. The depths may differ by what a pixel
    /// spans on the slanted surface.
    pub fn observe(&self, position: Vec3, normal: Vec3) -> Option<Observation> {
        let camera = &self.view.camera;
        let cosine = normal.dot((camera.position() - position).normalize_or_zero());
        let pixel = camera.project(position);
        let (width, height) = (camera.width as f32, camera.height as f32);
        let in_picture = pixel.x >= 0.0 && pixel.x < width && pixel.y >= 0.0 && pixel.y < height;
        if cosine <= MIN_COSINE || pixel.z <= 0.0 || !in_picture {
            return None;
        }
        let surface = self.depth[pixel.y as usize * camera.width + pixel.x as usize];
        let tolerance = camera.footprint(pixel.z) / cosine;
        let visible = (surface - pixel.z).abs() <= tolerance;
        visible.then_some(Observation { at: [pixel.x, pixel.y], cosine })
    }

    /// The picture at an observation: bilinear over the covered ones of the four nearest pixels,
    /// so that no background leaks in.
    pub fn colour(&self, observation: &Observation) -> Vec3 {
        let image = &self.view.image;
        let [x, y] = observation.at.map(|value| value - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let mut sum = Vec3::ZERO;
        let mut total = 0.0;
        for (column, row) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let (column, row) = (left + column, top + row);
            let weight = (1.0 - (x - column).abs()) * (1.0 - (y - row).abs());
            if column < 0.0
                || row < 0.0
                || column as usize >= image.width
                || row as usize >= image.height
            {
                continue;
            }
            let (column, row) = (column as usize, row as usize);
            if self.depth[row * image.width + column].is_finite() {
                sum += weight * Vec3::from_slice(image.pixel(column, row));
                total += weight;
            }
        }
        // The pixel that contains the point is covered and has a quarter of the weight or more.
        sum / total
    }
}

/// For every texel of the chart what `texel` makes of its observations, given as pairs of view
/// index and observation; the default value where no view sees the texel.
pub fn per_texel<T: Clone + Default + Send + Sync>(
    atlas: &Atlas,
    projections: &[Projection],
    texel: impl Fn(&[(usize, Observation)]) -> T + Sync,
) -> Vec<T> {
    let one = |index: usize| {
        cancel::check();
        if !atlas.inside[index] {
            return T::default();
        }
        let (position, normal) = (atlas.positions[index], atlas.normals[index]);
        let seen: Vec<(usize, Observation)> = projections
            .iter()
            .enumerate()
            .filter_map(|(view, p)| p.observe(position, normal).map(|seen| (view, seen)))
            .collect();
        if seen.is_empty() { T::default() } else { texel(&seen) }
    };
    (0..atlas.inside.len()).into_par_iter().map(one).collect()
}
