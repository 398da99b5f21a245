//! Training views with their visible surface, and where a point of the mesh is seen in them.

use glam::Vec2;
use rayon::prelude::*;

use super::raster::{Fragments, SurfacePoint};
use super::weights::{direction_to, view_weights};
use crate::capture::{Camera, Capture, View};
use crate::config::ViewWeightConfig;
use crate::picture::Picture;

/// A training view, possibly reduced, and what it sees.
pub struct SeenView<'a> {
    /// The view at full size.
    pub view: &'a View,
    /// The camera of the reduced picture.
    pub camera: Camera,
    /// Averages over squares of the view's picture.
    pub image: Picture,
    /// The visible surface at the reduced pixels' centres.
    pub fragments: Fragments,
    /// What each reduced pixel counts; zero where it shows no usable surface.
    pub weights: Vec<f32>,
}

/// What one view shows of a surface point.
#[derive(Clone, Copy, Debug)]
pub struct Observation {
    /// Interpolated between the valid pixels around, linear radiance.
    pub colour: [f32; 3],
    /// The nearest pixel's weight.
    pub weight: f32,
    /// The nearest pixel's region, 0 = none.
    pub label: u8,
}

impl<'a> SeenView<'a> {
    /// All training views, reduced by averaging squares of `reduction` pixels. A reduced pixel is
    /// in the mask if all its pixels are, so that no colour from outside the face enters.
    pub fn of_capture(
        capture: &'a Capture,
        reduction: usize,
        config: &ViewWeightConfig,
    ) -> Vec<Self> {
        let seen = |view: &'a View| {
            let camera = view.frame.camera.reduced(reduction);
            let (image, mask) = reduce(view, &camera, reduction);
            let fragments = Fragments::of_view(&capture.mesh, &camera);
            let weights = view_weights(&capture.mesh, &camera, &fragments, &mask, config);
            Self { view, camera, image, fragments, weights }
        };
        capture.train.par_iter().map(seen).collect()
    }

    /// What the view shows of a surface point; nothing if the point is hidden, seen from behind,
    /// or outside the mask.
    pub fn observe(&self, point: &SurfacePoint) -> Option<Observation> {
        let eye = self.camera.position();
        let cosine = point.normal.dot(direction_to(eye.as_vec3(), point.position));
        if cosine <= 0.0 {
            return None;
        }
        let projected = self.camera.project(point.position.as_dvec3());
        let inside = |value: f64, size: usize| value >= 0.0 && value < size as f64;
        let (width, height) = (self.camera.width, self.camera.height);
        if projected.z <= 0.0 || !inside(projected.x, width) || !inside(projected.y, height) {
            return None;
        }
        let at = projected.y as usize * width + projected.x as usize;
        // Inside a pixel, depth may change by its footprint times the surface's slope.
        let tangent = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine.max(0.1);
        let tolerance = self.camera.footprint(projected.z) as f32 * (1.0 + tangent);
        if self.weights[at] <= 0.0 || projected.z as f32 > self.fragments.depth[at] + tolerance {
            return None;
        }
        let pixel = Vec2::new(projected.x as f32, projected.y as f32);
        Some(Observation {
            colour: self.colour(pixel, at),
            weight: self.weights[at],
            label: self.label(pixel),
        })
    }

    /// Bilinear over the usable pixels around; `nearest` is one of them.
    fn colour(&self, pixel: Vec2, nearest: usize) -> [f32; 3] {
        let corner = (pixel - 0.5).floor();
        let fraction = pixel - 0.5 - corner;
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (x, y) = (corner.x as isize + dx, corner.y as isize + dy);
            let (width, height) = (self.image.width as isize, self.image.height as isize);
            if !(0..width).contains(&x) || !(0..height).contains(&y) {
                continue;
            }
            let at = (y * width + x) as usize;
            let along = |offset: isize, f: f32| if offset == 1 { f } else { 1.0 - f };
            let weight = along(dx, fraction.x) * along(dy, fraction.y);
            if self.weights[at] > 0.0 && weight > 0.0 {
                total += weight;
                for (sum, value) in sum.iter_mut().zip(&self.image.data[3 * at..]) {
                    *sum += weight * value;
                }
            }
        }
        if total > 0.0 {
            sum.map(|value| value / total)
        } else {
            std::array::from_fn(|channel| self.image.data[3 * nearest + channel])
        }
    }

    fn label(&self, pixel: Vec2) -> u8 {
        self.view.labels.as_ref().map_or(0, |labels| {
            let reduction = (labels.width / self.camera.width).max(1) as f32;
            let x = ((pixel.x * reduction) as usize).min(labels.width - 1);
            let y = ((pixel.y * reduction) as usize).min(labels.height - 1);
            labels.data[y * labels.width + x]
        })
    }
}

fn reduce(view: &View, camera: &Camera, reduction: usize) -> (Picture, Vec<bool>) {
    let mut image = Picture::new(camera.width, camera.height, 3);
    let mut mask = vec![true; camera.width * camera.height];
    let share = 1.0 / (reduction * reduction) as f32;
    for y in 0..camera.height * reduction {
        for x in 0..camera.width * reduction {
            let source = y * view.image.width + x;
            let target = y / reduction * camera.width + x / reduction;
            mask[target] &= view.mask.data[source] >= 128;
            for channel in 0..3 {
                image.data[3 * target + channel] += share * view.image.data[3 * source + channel];
            }
        }
    }
    (image, mask)
}
