//! A light in cells of equal solid angle, in which metrics need no weights.

use formats::picture::Picture;
use glam::DVec3;

use crate::metrics::luminance;

/// Cells of equal solid angle: rows of equal height along +Y, columns of equal azimuth.
pub(super) const ROWS: usize = 32;
pub(super) const COLUMNS: usize = 64;
/// Angle around a bright direction within which light as bright belongs to it, degrees.
const REACH: f64 = 10.0;
/// Two bright directions are at least this far apart, degrees.
const APART: f64 = 30.0;
/// Bright directions of the truth, at most, and what fraction of the brightest's light each has.
const PEAKS: usize = 3;
const MIN_PEAK_FRACTION: f64 = 0.2;

/// A light in cells of equal solid angle.
pub(super) struct CellLight {
    /// Mean radiance of each cell, [ROWS, COLUMNS, 3], linear.
    pub picture: Picture,
    /// Luminance times direction, summed over the solid angle of each cell.
    moments: Vec<DVec3>,
}

/// The places of the rows of a lat-long picture; d = (sin t sin p, cos t, -sin t cos p) for both.
#[derive(Clone, Copy)]
pub(super) enum RowsAt {
    /// The first and the last on the poles, as the truth's.
    Poles,
    /// Bands of equal height, as the cells of a solver.
    Bands,
}

impl CellLight {
    /// Sums a lat-long picture into the cells, every texel in parts that are much smaller than one.
    pub fn of(latlong: &Picture, rows: RowsAt) -> Self {
        let (width, height) = (latlong.width, latlong.height);
        let parts = (8 * COLUMNS).div_ceil(width).max(2);
        let mut light = [vec![0.0; 3 * ROWS * COLUMNS], vec![0.0; ROWS * COLUMNS]];
        let mut moments = vec![DVec3::ZERO; ROWS * COLUMNS];
        let pi = std::f64::consts::PI;
        for (y, row) in latlong.data.chunks_exact(3 * width).enumerate() {
            let ends = match rows {
                RowsAt::Poles => [-0.5, 0.5].map(|half| {
                    (y as f64 + half).clamp(0.0, height as f64 - 1.0) / (height as f64 - 1.0)
                }),
                RowsAt::Bands => [0.0, 1.0].map(|end| (y as f64 + end) / height as f64),
            };
            for part in 0..parts {
                let [low, high] = [part, part + 1]
                    .map(|at| pi * (ends[0] + (ends[1] - ends[0]) * at as f64 / parts as f64));
                let (solid, t) = (low.cos() - high.cos(), 0.5 * (low + high));
                let up = t.cos();
                let cell_row = ((1.0 - up) * 0.5 * ROWS as f64).min(ROWS as f64 - 1.0) as usize;
                for (x, pixel) in row.chunks_exact(3).enumerate() {
                    let value: [f64; 3] = std::array::from_fn(|c| f64::from(pixel[c]).max(0.0));
                    for across in 0..parts {
                        let u = (x as f64 + (across as f64 + 0.5) / parts as f64) / width as f64;
                        let cell = cell_row * COLUMNS + (u * COLUMNS as f64) as usize % COLUMNS;
                        let (sin_p, cos_p) = (2.0 * pi * u).sin_cos();
                        let direction = DVec3::new(t.sin() * sin_p, up, -t.sin() * cos_p);
                        (0..3).for_each(|c| light[0][3 * cell + c] += solid * value[c]);
                        light[1][cell] += solid;
                        moments[cell] += direction * (solid * luminance(value.into_iter()));
                    }
                }
            }
        }
        let data = light[0].iter().enumerate().map(|(i, sum)| (sum / light[1][i / 3]) as f32);
        let picture = Picture { width: COLUMNS, height: ROWS, channels: 3, data: data.collect() };
        Self { picture, moments }
    }

    /// A light of which the cells are known.
    #[cfg(test)]
    pub fn of_cells(picture: Picture) -> Self {
        Self { picture, moments: Vec::new() }
    }

    /// The direction of a cell's middle.
    pub fn direction(cell: usize) -> DVec3 {
        let up = 1.0 - 2.0 * ((cell / COLUMNS) as f64 + 0.5) / ROWS as f64;
        let azimuth = std::f64::consts::TAU * ((cell % COLUMNS) as f64 + 0.5) / COLUMNS as f64;
        let level = (1.0 - up * up).sqrt();
        DVec3::new(level * azimuth.sin(), up, -level * azimuth.cos())
    }

    /// The cell of a direction.
    pub fn cell(direction: DVec3) -> usize {
        let row = ((1.0 - direction.y) * 0.5 * ROWS as f64).clamp(0.0, ROWS as f64 - 1.0) as usize;
        let azimuth = direction.x.atan2(-direction.z).rem_euclid(std::f64::consts::TAU);
        let column = (azimuth / std::f64::consts::TAU * COLUMNS as f64) as usize;
        row * COLUMNS + column.min(COLUMNS - 1)
    }

    /// The brightest directions, the brightest first: the maxima of the light within a cone, far
    /// enough apart, each the mean direction of its cone's light.
    pub fn peaks(&self) -> Vec<DVec3> {
        let directions: Vec<DVec3> = (0..ROWS * COLUMNS).map(Self::direction).collect();
        let reach = REACH.to_radians().cos();
        let cone = |centre: DVec3| -> DVec3 {
            let near = directions.iter().zip(&self.moments).filter(|(d, _)| d.dot(centre) >= reach);
            near.map(|(_, moment)| *moment).sum()
        };
        let mut cones: Vec<DVec3> = directions.iter().map(|centre| cone(*centre)).collect();
        let mut peaks: Vec<DVec3> = Vec::new();
        let mut first = 0.0;
        while peaks.len() < PEAKS {
            let brighter = |a: &&DVec3, b: &&DVec3| a.length().total_cmp(&b.length());
            let Some(brightest) = cones.iter().max_by(brighter).copied() else { break };
            if brightest.length() <= MIN_PEAK_FRACTION * first {
                break;
            }
            first = f64::max(first, brightest.length());
            // Once more around its own mean, so that it does not hang on a cell's middle.
            let peak = cone(brightest.normalize()).normalize_or(brightest.normalize());
            for (cone, centre) in cones.iter_mut().zip(&directions) {
                if centre.dot(peak) >= APART.to_radians().cos() {
                    *cone = DVec3::ZERO;
                }
            }
            peaks.push(peak);
        }
        peaks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lat-long picture with a lamp of three texels at a direction in a dim room.
    fn lamp(width: usize, height: usize, row: usize, column: usize) -> Picture {
        let mut picture = Picture::new(width, height, 3);
        picture.data.fill(0.1);
        for x in [column - 1, column, column + 1] {
            picture.pixel_mut(x, row).fill(300.0);
        }
        picture
    }

    #[test]
    fn a_lamp_is_found_where_it_is_and_its_light_is_kept() {
        let light = CellLight::of(&lamp(512, 257, 100, 70), RowsAt::Poles);
        let (t, p): (f64, f64) =
            (std::f64::consts::PI * 100.0 / 256.0, std::f64::consts::TAU * 70.5 / 512.0);
        let there = DVec3::new(t.sin() * p.sin(), t.cos(), -t.sin() * p.cos());
        let angle = light.peaks()[0].dot(there).min(1.0).acos().to_degrees();
        assert!(angle < 0.2, "{angle}");
        // Solid angle by the formula of a band: three texels of 2 pi / 512 in azimuth.
        let band =
            (t - std::f64::consts::PI / 512.0).cos() - (t + std::f64::consts::PI / 512.0).cos();
        let lamp_solid = 3.0 * std::f64::consts::TAU / 512.0 * band;
        let expected = 0.1 + 299.9 * lamp_solid / (4.0 * std::f64::consts::PI);
        let mean = light.picture.data.iter().map(|v| f64::from(*v)).sum::<f64>()
            / light.picture.data.len() as f64;
        assert!((mean / expected - 1.0).abs() < 2e-3, "{mean} {expected}");
    }

    #[test]
    fn a_light_of_cells_is_the_light_it_was_averaged_from() {
        let cell = CellLight::cell(CellLight::direction(777));
        assert_eq!(cell, 777);
        // An even light, whichever its rows, is even, and has no brightest direction but any.
        let mut even = Picture::new(64, 32, 3);
        even.data.fill(2.0);
        for rows in [RowsAt::Poles, RowsAt::Bands] {
            let light = CellLight::of(&even, rows);
            assert!(light.picture.data.iter().all(|v| (v - 2.0).abs() < 1e-5));
        }
    }
}
