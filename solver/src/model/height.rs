//! Heights over the mesh: integrable by construction.
//!
//! A surface p + h n has, to first order in h, the normal n - grad h, with the gradient taken in
//! the tangent plane. On the chart grad h = E0 dh/dx + E1 dh/dy, with E the dual basis of the
//! texel-to-texel steps of the surface.

use glam::Vec3;
use rayon::prelude::*;

use capture::gbuffer::Atlas;

/// Least squared area of a texel, over that of a typical texel.
const LEAST_AREA: f32 = 1e-4;

/// The linear map from a height per texel, in lengths of a typical texel, to deviations of the normal.
pub struct HeightField {
    size: usize,
    /// Derivatives of the deviation with respect to the height's difference to the right and downwards.
    right: Vec<Vec3>,
    down: Vec<Vec3>,
}

impl HeightField {
    /// The heights of a chart. Texels where a unit step of the height would deviate the normal by more than `steepest`
    /// have no height.
    pub fn new(atlas: &Atlas, steepest: f32) -> Self {
        let size = atlas.size;
        let step = |at: usize, stride: usize, place: usize| {
            let ahead = if place + 1 < size { at + stride } else { at };
            let behind = if place > 0 { at - stride } else { at };
            let length = ((ahead - behind) / stride).max(1) as f32;
            let step = (atlas.positions[ahead] - atlas.positions[behind]) / length;
            step - atlas.normals[at] * atlas.normals[at].dot(step)
        };
        let steps: Vec<(Vec3, Vec3)> = (0..size * size)
            .into_par_iter()
            .map(|at| (step(at, 1, at % size), step(at, size, at / size)))
            .collect();
        let inside = || steps.iter().zip(&atlas.inside).filter(|(_, inside)| **inside);
        let mut lengths: Vec<f32> = inside().map(|((u, _), _)| u.length_squared()).collect();
        lengths.sort_by(f32::total_cmp);
        let squared = lengths.get(lengths.len() / 2).copied().unwrap_or(1.0).max(f32::MIN_POSITIVE);
        let unit = squared.sqrt();
        let dual = |((u, v), inside): (&(Vec3, Vec3), &bool)| {
            let (a, b, c) = (u.dot(*u), u.dot(*v), v.dot(*v));
            let area = (a * c - b * b).max(LEAST_AREA * squared * squared);
            let right = (c * u - b * v) / area * unit;
            let down = (a * v - b * u) / area * unit;
            let usable = *inside && right.length() <= steepest && down.length() <= steepest;
            if usable { (-right, -down) } else { (Vec3::ZERO, Vec3::ZERO) }
        };
        let (right, down) = steps.par_iter().zip(&atlas.inside).map(dual).unzip();
        Self { size, right, down }
    }

    /// Derivatives of the deviation with respect to the height's difference to the right and downwards, per texel.
    pub fn basis(&self) -> [&[Vec3]; 2] {
        [&self.right, &self.down]
    }

    /// The number of texels.
    pub fn len(&self) -> usize {
        self.right.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.right.is_empty()
    }

    /// The deviation of the normal, 3 channels.
    pub fn deviation(&self, height: &[f32]) -> Vec<f32> {
        let size = self.size;
        let texel = |at: usize| {
            let (x, y) = (at % size, at / size);
            let across = |stride: usize, place: usize| match place > 0 && place + 1 < size {
                true => 0.5 * (height[at + stride] - height[at - stride]),
                false => 0.0,
            };
            self.right[at] * across(1, x) + self.down[at] * across(size, y)
        };
        let mut deviation = vec![0.0; 3 * self.len()];
        deviation.par_chunks_mut(3 * size).enumerate().for_each(|(y, line)| {
            for (x, out) in line.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                *out = texel(y * size + x).to_array();
            }
        });
        deviation
    }

    /// The transpose of [`Self::deviation`].
    pub fn adjoint(&self, by_deviation: &[f32]) -> Vec<f32> {
        let size = self.size;
        let (by_deviation, _) = by_deviation.as_chunks::<3>();
        let along = |basis: &[Vec3], at: usize| basis[at].dot(Vec3::from_array(by_deviation[at]));
        let texel = |at: usize| {
            let (x, y) = (at % size, at / size);
            // A texel's height also contributes at neighbours that have both of their neighbours.
            let sum = |basis: &[Vec3], stride: usize, place: usize| {
                let after = if place >= 2 { along(basis, at - stride) } else { 0.0 };
                let before = if place + 2 < size { along(basis, at + stride) } else { 0.0 };
                0.5 * (after - before)
            };
            sum(&self.right, 1, x) + sum(&self.down, size, y)
        };
        (0..self.len()).into_par_iter().with_min_len(size).map(texel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_ramp_on_a_plane_tilts_the_normal_by_its_slope() {
        // 2 metres over 32 texels: a texel is 62.5 mm, and the height counts texels.
        let field = HeightField::new(&Atlas::new(&testing::square(), 32), 6.0);
        let ramp: Vec<f32> = (0..32 * 32).map(|at| 0.3 * (at % 32) as f32).collect();
        let deviation = field.deviation(&ramp);
        let middle = Vec3::from_slice(&deviation[3 * (16 * 32 + 16)..]);
        assert!(middle.abs_diff_eq(Vec3::new(-0.3, 0.0, 0.0), 1e-5), "{middle}");
        let upwards: Vec<f32> = (0..32 * 32).map(|at| 0.2 * (at / 32) as f32).collect();
        let middle = Vec3::from_slice(&field.deviation(&upwards)[3 * (16 * 32 + 16)..]);
        // Rows run downwards, so this height grows towards -y.
        assert!(middle.abs_diff_eq(Vec3::new(0.0, 0.2, 0.0), 1e-5), "{middle}");
    }

    #[test]
    fn a_bump_on_a_sphere_has_the_normals_of_the_displaced_surface() {
        let atlas = Atlas::new(&testing::dome(64), 128);
        let field = HeightField::new(&atlas, 6.0);
        let bump =
            |p: Vec3| 0.02 * (-(p - Vec3::new(0.3, 0.2, 0.93)).length_squared() / 0.02).exp();
        // Heights in metres, in the unit of the field: found from a known ramp.
        let z: Vec<f32> = atlas.positions.iter().map(|p| p.x).collect();
        let slope = Vec3::from_slice(&field.deviation(&z)[3 * (64 * 128 + 64)..]).x;
        let height: Vec<f32> = atlas.positions.iter().map(|p| bump(*p) / -slope).collect();
        let deviation = field.deviation(&height);
        let mut compared = 0;
        for at in (0..128 * 128).filter(|at| atlas.inside[*at]) {
            let (p, n) = (atlas.positions[at], atlas.normals[at]);
            if p.z < 0.5 {
                continue;
            }
            // The gradient of the bump along the sphere, by central differences.
            let tangent = n.any_orthonormal_vector();
            let other = n.cross(tangent);
            let by = |t: Vec3| (bump(p + 1e-3 * t) - bump(p - 1e-3 * t)) / 2e-3;
            let expected = -(tangent * by(tangent) + other * by(other));
            let found = Vec3::from_slice(&deviation[3 * at..]);
            assert!(found.distance(expected) < 0.01, "{found} {expected}");
            compared += 1;
        }
        assert!(compared > 3000);
    }

    #[test]
    fn adjoint_is_the_transpose() {
        let field = HeightField::new(&Atlas::new(&testing::dome(8), 24), 6.0);
        let wave =
            |count: usize, k: f32| (0..count).map(|i| (i as f32 * k).sin()).collect::<Vec<_>>();
        let (height, gradient) = (wave(24 * 24, 0.7), wave(3 * 24 * 24, 1.3));
        let product = |a: &[f32], b: &[f32]| {
            a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>()
        };
        let left = product(&field.deviation(&height), &gradient);
        let right = product(&height, &field.adjoint(&gradient));
        assert!((left - right).abs() < 1e-4 * left.abs().max(1.0), "{left} {right}");
    }
}
