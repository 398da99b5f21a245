//! The unknown light: cells of a sphere around the head, lat-long in Mitsuba's convention
//! d = (sin t sin p, cos t, -sin t cos p), each of one colour.

use std::f64::consts::{PI, TAU};

use formats::picture::Picture;
use glam::{DVec3, Vec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;

use super::{CHANNELS, luminance};

/// Points along a side of a cell at which a picture is read.
const POINTS: usize = 64;

/// A direction within a cell and the solid angle it stands for, both from the head's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyRay {
    /// Unit, towards the sky.
    pub direction: Vec3,
    /// Steradians.
    pub solid_angle: f32,
    /// Index of the cell.
    pub cell: u32,
}

/// Polar angle from +Y and azimuth, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    polar: [f64; 2],
    azimuth: [f64; 2],
}

impl Cell {
    /// The part (`row`, `column`) of `parts` x `parts` of equal angles.
    fn part(&self, row: usize, column: usize, parts: usize) -> Self {
        let cut = |[low, high]: [f64; 2], index: usize| {
            [index, index + 1].map(|edge| low + (high - low) * edge as f64 / parts as f64)
        };
        Self { polar: cut(self.polar, row), azimuth: cut(self.azimuth, column) }
    }
}

/// A sphere cut into cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    cells: Vec<Cell>,
    /// Inverse radius, per metre; 0 is an environment at infinity.
    pub nearness: f32,
}

impl Sky {
    /// Returns `rows` x `2 rows` cells of equal polar and azimuthal angle, at infinity.
    pub fn lat_long(rows: usize) -> Self {
        let columns = 2 * rows;
        let cell = |index: usize| {
            let (row, column) = (index / columns, index % columns);
            let edges = |first: usize, count: usize, whole: f64| {
                [first, first + 1].map(|edge| whole * edge as f64 / count as f64)
            };
            Cell { polar: edges(row, rows, PI), azimuth: edges(column, columns, TAU) }
        };
        Self { cells: (0..rows * columns).map(cell).collect(), nearness: 0.0 }
    }

    /// The mean radiance of every cell, R, G, B, in a lat-long picture whose first and last row lie on the poles. The
    /// picture is seen from a point from which the sky's centre lies at `shift`, in units of the distance of the light.
    pub fn means(&self, picture: &Picture, shift: DVec3) -> Vec<f32> {
        let mean = |directions: &[DVec3]| {
            let mut sums = [0.0_f64; CHANNELS];
            for direction in directions {
                let DVec3 { x, y, z } = (*direction + shift).normalize();
                let (polar, azimuth) = (y.clamp(-1.0, 1.0).acos(), x.atan2(-z).rem_euclid(TAU));
                let row = (polar / PI * (picture.height - 1) as f64).round() as usize;
                let column = (azimuth / TAU * picture.width as f64) as usize % picture.width;
                let radiance = &picture.pixel(column, row)[..CHANNELS];
                sums.iter_mut().zip(radiance).for_each(|(sum, value)| *sum += f64::from(*value));
            }
            sums.map(|sum| (sum / directions.len() as f64) as f32)
        };
        self.points(POINTS).chunks_exact(POINTS * POINTS).flat_map(mean).collect()
    }

    /// Moves these cells to a sphere of another nearness.
    pub fn at(self, nearness: f32) -> Self {
        Self { nearness, ..self }
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Returns jittered directions, `side` x `side` to a cell, whose solid angles sum to the whole sphere.
    pub fn rays(&self, side: usize, seed: u64) -> Vec<SkyRay> {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut unit = || (f64::from(random.next_u32()) + 0.5) / (1u64 << 32) as f64;
        let mut rays = Vec::with_capacity(self.cells.len() * side * side);
        for (index, cell) in self.cells.iter().enumerate() {
            for part in 0..side * side {
                let Cell { polar, azimuth } = cell.part(part / side, part % side, side);
                let ([top, bottom], [left, right]) = (polar.map(f64::cos), azimuth);
                // Even in the cosine, hence even in solid angle.
                let cosine = top + (bottom - top) * unit();
                let azimuth = left + (right - left) * unit();
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                let direction = [sine * azimuth.sin(), cosine, -sine * azimuth.cos()];
                rays.push(SkyRay {
                    direction: Vec3::from_array(direction.map(|x| x as f32)),
                    solid_angle: ((top - bottom) * (right - left)) as f32,
                    cell: index as u32,
                });
            }
        }
        rays
    }

    /// Unit directions within each cell, `side` x `side` of equal solid angle, cell by cell.
    pub(super) fn points(&self, side: usize) -> Vec<DVec3> {
        let of_cell = |Cell { polar, azimuth }: &Cell| {
            let ([top, bottom], [left, right]) = (polar.map(f64::cos), *azimuth);
            let along = move |at: usize, from: f64, to: f64| {
                from + (to - from) * (at as f64 + 0.5) / side as f64
            };
            (0..side * side).map(move |at| {
                let cosine = along(at / side, top, bottom);
                let azimuth = along(at % side, left, right);
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                DVec3::new(sine * azimuth.sin(), cosine, -sine * azimuth.cos())
            })
        };
        self.cells.iter().flat_map(of_cell).collect()
    }

    /// The central direction of every cell, unit.
    pub fn centres(&self) -> Vec<Vec3> {
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let centre = |cell: &Cell| {
            let ((sine, cosine), azimuth) = (middle(cell.polar).sin_cos(), middle(cell.azimuth));
            let direction = [sine * azimuth.sin(), cosine, -sine * azimuth.cos()];
            Vec3::from_array(direction.map(|x| x as f32))
        };
        self.cells.iter().map(centre).collect()
    }
}

/// The contrast of a light of R, G, B per cell of [`Sky::lat_long`] with `rows` rows: the standard deviation of its
/// luminance over the mean, over directions in front (+Z), filtered with a lobe as wide as skin's highlights (the
/// eighth power of the cosine). About 0.1 under a dome, 1 under softboxes.
pub fn contrast(rows: usize, light: &[f32]) -> f32 {
    const LOBE: i32 = 8;
    let rays = Sky::lat_long(rows).rays(1, 0);
    let seen = |front: &SkyRay| {
        let (mut sum, mut total) = (0.0, 0.0);
        for ray in &rays {
            let cosine = ray.direction.dot(front.direction).max(0.0);
            let weight = f64::from(cosine.powi(LOBE) * ray.solid_angle);
            sum += weight * luminance::<f64>(&light[CHANNELS * ray.cell as usize..][..CHANNELS]);
            total += weight;
        }
        (f64::from(front.solid_angle), sum / total)
    };
    let front: Vec<&SkyRay> = rays.iter().filter(|ray| ray.direction.z > 0.0).collect();
    let seen: Vec<(f64, f64)> = front.into_par_iter().map(seen).collect();
    let total: f64 = seen.iter().map(|(weight, _)| weight).sum();
    let mean = seen.iter().map(|(weight, value)| weight * value).sum::<f64>() / total;
    let square = |(weight, value): &(f64, f64)| weight * (value - mean) * (value - mean);
    let variance = seen.iter().map(square).sum::<f64>() / total;
    (variance.sqrt() / mean.max(f64::MIN_POSITIVE)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_cover_the_sphere_evenly() {
        let sky = Sky::lat_long(16);
        let rays = sky.rays(3, 0);
        let total: f64 = rays.iter().map(|ray| f64::from(ray.solid_angle)).sum();
        assert!((total - 4.0 * PI).abs() < 1e-4, "{total}");
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.6, -0.48, 0.64)] {
            let lobe = |ray: &SkyRay| f64::from(ray.direction.dot(axis).max(0.0) * ray.solid_angle);
            let irradiance: f64 = rays.iter().map(lobe).sum();
            assert!((irradiance - PI).abs() < 0.01, "{axis}: {irradiance}");
        }
        assert!(rays.iter().all(|ray| (ray.direction.length() - 1.0).abs() < 1e-6));
        // Row 0 is up; column 0 begins behind the face's look, at -Z, and turns towards +X.
        assert!(rays.iter().filter(|ray| ray.cell < 32).all(|ray| ray.direction.y > 0.98));
        let first = rays.iter().find(|ray| ray.cell == 8 * 32).unwrap().direction;
        assert!(first.z < -0.9 && first.x > 0.0);
    }

    #[test]
    fn cells_have_the_means_of_a_picture() {
        let (width, height) = (64, 33);
        let mut picture = Picture::new(width, height, 3);
        let direction = |x: usize, y: usize| {
            let (polar, azimuth) = (
                std::f32::consts::PI * y as f32 / (height - 1) as f32,
                std::f32::consts::TAU * (x as f32 + 0.5) / width as f32,
            );
            let (sin, cos) = polar.sin_cos();
            Vec3::new(sin * azimuth.sin(), cos, -sin * azimuth.cos())
        };
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let d = direction(x, y);
            picture.pixel_mut(x, y).copy_from_slice(&(Vec3::ONE + 0.5 * d).to_array());
        }
        let sky = Sky::lat_long(8);
        for shift in [DVec3::ZERO, DVec3::new(0.3, -0.2, 0.1)] {
            let means = sky.means(&picture, shift);
            for (mean, centre) in means.chunks_exact(CHANNELS).zip(sky.centres()) {
                let expected = Vec3::ONE + 0.5 * (centre + shift.as_vec3()).normalize();
                assert!(Vec3::from_slice(mean).distance(expected) < 0.06, "{centre}: {mean:?}");
            }
        }
    }

    #[test]
    fn a_uniform_light_has_no_contrast_and_a_lamp_has_much() {
        let cells = Sky::lat_long(16).len();
        let mut light = vec![0.5; CHANNELS * cells];
        assert!(contrast(16, &light) < 1e-6);
        let lamp =
            Sky::lat_long(16).rays(1, 0).iter().position(|ray| ray.direction.z > 0.95).unwrap();
        light[CHANNELS * lamp..CHANNELS * (lamp + 1)].fill(500.0);
        assert!(contrast(16, &light) > 1.0);
    }
}
