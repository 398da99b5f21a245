//! A light that is turned with respect to the head.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Mat3, Vec3};

use super::CHANNELS;
use super::sky::Sky;

/// Points along a side of a cell at which the turned light is read.
const POINTS: usize = 32;
/// Largest distance of the head's centre from the light's, in units of the light's distance.
const LARGEST_OFFSET: f32 = 0.8;

/// The matrix from a light of R, G, B per cell of a lat-long sky to the mean of the turned light over each cell.
///
/// A light of one radiance stays the same, and the energy of a cell (radiance x solid angle) is preserved to the
/// spacing of the points. The identity is exact.
#[derive(Clone, Debug, PartialEq)]
pub struct LightRotation {
    /// The cells of the light that each turned cell overlaps, with the overlap's share of the turned cell.
    overlaps: Vec<Vec<(u32, f32)>>,
}

impl LightRotation {
    /// `rotation` takes directions in the frame of the light to those of the head; the sky has `rows` rows. `offset` is
    /// the head's centre from the light's, in the frame of the light and in units of the light's distance; it ends within
    /// the sphere of the light.
    pub fn new(rows: usize, rotation: Mat3, offset: Vec3) -> Self {
        let columns = 2 * rows;
        let back = rotation.as_dmat3().transpose();
        let offset = offset.clamp_length_max(LARGEST_OFFSET).as_dvec3();
        let points = Sky::lat_long(rows).points(POINTS);
        let overlaps = points.chunks_exact(POINTS * POINTS).map(|points| {
            let mut cells: Vec<u32> = points
                .iter()
                .map(|point| cell(rows, columns, seen(back * *point, offset)))
                .collect();
            cells.sort_unstable();
            let runs = cells.chunk_by(|a, b| a == b);
            runs.map(|run| (run[0], run.len() as f32 / points.len() as f32)).collect()
        });
        Self { overlaps: overlaps.collect() }
    }

    /// The turned light, R, G, B per cell.
    pub fn apply(&self, light: &[f32]) -> Vec<f32> {
        let (light, _) = light.as_chunks::<CHANNELS>();
        let turned = |overlaps: &Vec<(u32, f32)>| {
            let mut sum = [0.0; CHANNELS];
            for (cell, share) in overlaps {
                (0..CHANNELS).for_each(|c| sum[c] += share * light[*cell as usize][c]);
            }
            sum
        };
        self.overlaps.iter().flat_map(turned).collect()
    }

    /// The adjoint of [`Self::apply`]: the gradient with respect to the light from that with respect to the turned
    /// light.
    pub fn adjoint(&self, by_turned: &[f32]) -> Vec<f32> {
        let mut by_light = vec![0.0; by_turned.len()];
        let (light, _) = by_light.as_chunks_mut::<CHANNELS>();
        for (overlaps, by) in self.overlaps.iter().zip(by_turned.as_chunks::<CHANNELS>().0) {
            for (cell, share) in overlaps {
                (0..CHANNELS).for_each(|c| light[*cell as usize][c] += share * by[c]);
            }
        }
        by_light
    }
}

/// The direction from the centre of the unit sphere to its point in a direction from `offset`.
fn seen(direction: DVec3, offset: DVec3) -> DVec3 {
    let along = direction.dot(offset);
    let distance = (along * along + 1.0 - offset.length_squared()).max(0.0).sqrt() - along;
    offset + distance * direction
}

/// The cell in which a unit direction lies.
fn cell(rows: usize, columns: usize, d: DVec3) -> u32 {
    let row = d.y.clamp(-1.0, 1.0).acos() / PI * rows as f64;
    let column = d.x.atan2(-d.z).rem_euclid(TAU) / TAU * columns as f64;
    let (row, column) = ((row as usize).min(rows - 1), (column as usize).min(columns - 1));
    (row * columns + column) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: usize = 16;

    fn rotation() -> Mat3 {
        Mat3::from_rotation_y(0.7) * Mat3::from_rotation_x(-0.3) * Mat3::from_rotation_z(0.2)
    }

    /// Pseudo-random values, 0 to 1.
    fn values(seed: f32) -> Vec<f32> {
        let value = |i: usize| ((i as f32 * 12.9898 + seed).sin() * 43758.547).fract().abs();
        (0..CHANNELS * Sky::lat_long(ROWS).len()).map(value).collect()
    }

    /// R, G, B of every cell by its centre.
    fn light(radiance: impl Fn(Vec3) -> Vec3) -> Vec<f32> {
        Sky::lat_long(ROWS).centres().into_iter().flat_map(|w| radiance(w).to_array()).collect()
    }

    #[test]
    fn the_identity_changes_no_bit() {
        let light = values(1.0);
        assert_eq!(LightRotation::new(ROWS, Mat3::IDENTITY, Vec3::ZERO).apply(&light), light);
    }

    #[test]
    fn a_smooth_light_turns_as_its_formula_does() {
        let (rotation, axis) = (rotation(), Vec3::new(0.36, 0.48, 0.8));
        let radiance = |w: Vec3| Vec3::new(1.0 + 0.8 * w.dot(axis), (1.0 + w.x).powi(2), 2.0);
        let found = LightRotation::new(ROWS, rotation, Vec3::ZERO).apply(&light(radiance));
        let expected = light(|w| radiance(rotation.transpose() * w));
        let error = |at: usize| (found[at] - expected[at]).abs();
        let largest = (0..found.len()).map(error).fold(0.0, f32::max);
        // Half a cell is 0.1 rad; the slopes are at most 2.6.
        assert!(largest < 0.2, "{largest}");
        let mean = (0..found.len()).map(error).sum::<f32>() / found.len() as f32;
        assert!(mean < 0.02, "{mean}");
        // The opposite rotation is another light.
        let wrong = light(|w| radiance(rotation * w));
        assert!(found.iter().zip(&wrong).any(|(a, b)| (a - b).abs() > 0.5));
    }

    #[test]
    fn energy_is_preserved() {
        let solid_angles: Vec<f64> =
            Sky::lat_long(ROWS).rays(1, 0).iter().map(|ray| f64::from(ray.solid_angle)).collect();
        let energy = |light: &[f32]| -> f64 {
            let cells = light.as_chunks::<CHANNELS>().0.iter().zip(&solid_angles);
            cells.map(|(rgb, solid_angle)| f64::from(rgb[1]) * solid_angle).sum()
        };
        // A lamp in one cell, near the equator and at a pole.
        for cell in [7 * 2 * ROWS + 5, 3] {
            let mut lamp = vec![0.0; CHANNELS * solid_angles.len()];
            lamp[CHANNELS * cell + 1] = 1.0;
            let turned = LightRotation::new(ROWS, rotation(), Vec3::ZERO).apply(&lamp);
            let ratio = energy(&turned) / energy(&lamp);
            assert!((ratio - 1.0).abs() < 0.02, "{cell}: {ratio}");
        }
        let ones = vec![1.0; CHANNELS * solid_angles.len()];
        let turned = LightRotation::new(ROWS, rotation(), Vec3::ZERO).apply(&ones);
        assert!(turned.iter().all(|value| (value - 1.0).abs() < 1e-6));
    }

    #[test]
    fn a_near_lamp_is_seen_from_where_the_head_is() {
        // The lamp is at a distance of 1 from the light's centre, the head at a fifth of it.
        let (rows, offset) = (64, Vec3::new(0.16, -0.08, 0.1));
        let sky = Sky::lat_long(rows);
        let centres = sky.centres();
        let at = Vec3::new(0.48, 0.36, 0.8);
        let lamp = (0..centres.len())
            .min_by(|a, b| centres[*a].distance(at).total_cmp(&centres[*b].distance(at)));
        let mut light = vec![0.0; CHANNELS * centres.len()];
        light[CHANNELS * lamp.unwrap() + 1] = 1.0;
        let seen = LightRotation::new(rows, rotation(), offset).apply(&light);
        let (mut energy, mut before, mut mean) = (0.0, 0.0, Vec3::ZERO);
        for ray in sky.rays(1, 0) {
            let at = CHANNELS * ray.cell as usize + 1;
            energy += ray.solid_angle * seen[at];
            before += ray.solid_angle * light[at];
            mean += ray.solid_angle * seen[at] * centres[ray.cell as usize];
        }
        let towards = centres[lamp.unwrap()] - offset;
        let expected = rotation() * towards.normalize();
        assert!(mean.normalize().distance(expected) < 0.02, "{mean} {expected}");
        // The cell faces the light's centre.
        let facing = centres[lamp.unwrap()].dot(towards.normalize());
        let gain = facing / towards.length_squared();
        assert!((energy / before / gain - 1.0).abs() < 0.03, "{} {gain}", energy / before);
    }

    #[test]
    fn the_adjoint_is_the_transpose() {
        let (light, turned) = (values(1.0), values(2.0));
        let rotation = LightRotation::new(ROWS, rotation(), Vec3::ZERO);
        let dot = |a: &[f32], b: &[f32]| -> f64 {
            a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
        };
        let (there, back) =
            (dot(&rotation.apply(&light), &turned), dot(&light, &rotation.adjoint(&turned)));
        assert!((there - back).abs() < 1e-6 * there, "{there} {back}");
    }
}
