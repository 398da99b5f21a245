//! The unknown light: a lat-long environment of few cells, in Mitsuba's convention
//! d = (sin t sin p, cos t, -sin t cos p).

use std::f64::consts::{PI, TAU};

use glam::Vec3;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// A direction within a cell and the solid angle it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyRay {
    /// Unit, towards the sky.
    pub direction: Vec3,
    /// Steradians.
    pub solid_angle: f32,
    /// Row * columns + column of the cell.
    pub cell: u32,
}

/// Jittered directions, `side` x `side` to a cell of `rows` x `2 rows` of equal polar and azimuthal
/// angle; of one cell all stand for the same solid angle, and together for the whole sphere.
pub fn sky_rays(rows: usize, side: usize, seed: u64) -> Vec<SkyRay> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut unit = || (f64::from(random.next_u32()) + 0.5) / (1u64 << 32) as f64;
    let columns = 2 * rows;
    let (fine_rows, fine_columns) = (rows * side, columns * side);
    let mut rays = Vec::with_capacity(fine_rows * fine_columns);
    for row in 0..fine_rows {
        let edge = |row: usize| (PI * row as f64 / fine_rows as f64).cos();
        let (top, bottom) = (edge(row), edge(row + 1));
        for column in 0..fine_columns {
            // Even in the cosine within a row, hence even in solid angle.
            let cosine = top + (bottom - top) * unit();
            let azimuth = TAU * (column as f64 + unit()) / fine_columns as f64;
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let direction = [sine * azimuth.sin(), cosine, -sine * azimuth.cos()];
            rays.push(SkyRay {
                direction: Vec3::from_array(direction.map(|x| x as f32)),
                solid_angle: ((top - bottom) * TAU / fine_columns as f64) as f32,
                cell: (row / side * columns + column / side) as u32,
            });
        }
    }
    rays
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_cover_the_sphere_evenly() {
        let rays = sky_rays(16, 3, 0);
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
}
