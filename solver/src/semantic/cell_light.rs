//! The light of free cells with the least residual on a chart, given one reflectance for each region.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::chart::{Chart, largest, luminance, means};
use super::settings::ColourSettings;
use crate::transport::add_scaled;

/// Tasks that sum the normal equations, each of an equal number of texels, in order.
const TASKS: usize = 16;
/// Sweeps over all cells of the solver of the normal equations.
const SWEEPS: usize = 60;

/// A light of R, G, B per cell, and the lit chart.
pub(super) struct CellLight<'a> {
    chart: &'a Chart,
    config: &'a ColourSettings,
    light: Vec<DVec3>,
    /// The colours of the visible texels divided by their shading, of mean 1.
    pub divided: Vec<Vec3>,
}

impl<'a> CellLight<'a> {
    /// Starts from a light of 1 in every cell.
    pub fn new(chart: &'a Chart, config: &'a ColourSettings) -> Self {
        let light = vec![DVec3::ONE; chart.cells()];
        Self { chart, config, light, divided: chart.colours.clone() }
    }

    /// Fits the light with one albedo for each of the `regions`, and returns the albedo of every visible texel. In low
    /// light it tends to the albedo of the largest region, with half of the weight at a shading of `shading_prior`.
    pub fn albedo(&mut self, regions: &[u8]) -> Vec<Vec3> {
        let ColourSettings { dark, shading_floor, shading_prior: prior, .. } = *self.config;
        let of_regions = means(&self.divided, regions, dark);
        let shading = self.solve(&of_regions, regions);
        let lit: Vec<Vec3> = shading.iter().map(|s| s.max(Vec3::splat(shading_floor))).collect();
        self.divided = self.chart.divided(&lit);
        let of_largest = means(&self.divided, regions, dark)[usize::from(largest(regions))];
        let texel = |(colour, shading)| (colour + prior * of_largest) / (shading + prior);
        self.chart.colours.iter().copied().zip(shading).map(texel).collect()
    }

    /// Fits non-negative light by least squares reweighted towards L1, with coordinate descent over the cells, and
    /// returns the shading of the visible texels.
    fn solve(&mut self, of_regions: &[Vec3], regions: &[u8]) -> Vec<Vec3> {
        let (chart, config) = (self.chart, self.config);
        let mean = |region: &u8| of_regions[usize::from(*region)];
        let most = of_regions.iter().map(luminance).fold(0.0, f32::max);
        let share: Vec<f32> =
            regions.iter().map(|region| luminance(&mean(region)) / most).collect();
        let wanted: Vec<Vec3> = chart
            .colours
            .iter()
            .zip(regions)
            .map(|(colour, region)| colour.max(Vec3::ZERO) / mean(region))
            .collect();
        for _ in 0..config.reweightings {
            let found = self.shading();
            let weight = |at: usize| {
                let residual = (wanted[at] - found[at]).abs().element_sum() / 3.0;
                share[at] / (residual + config.residual_floor)
            };
            let texel = |at: usize| (chart.row(at), weight(at), wanted[at]);
            Equations::new(chart.cells(), wanted.len(), texel).solve(&mut self.light);
        }
        let found = self.shading();
        let mean = found.iter().map(|s| s.as_dvec3()).sum::<DVec3>() / found.len() as f64;
        let mean = mean.as_vec3().max(Vec3::splat(f32::MIN_POSITIVE));
        found.into_iter().map(|shading| shading / mean).collect()
    }

    /// The shading of the visible texels.
    fn shading(&self) -> Vec<Vec3> {
        let light: Vec<Vec3> = self.light.iter().map(|light| light.as_vec3()).collect();
        let texel = |at: usize| self.chart.row(at).iter().zip(&light).map(|(c, l)| *c * *l).sum();
        (0..self.chart.seen.len()).into_par_iter().map(texel).collect()
    }
}

/// Normal equations of the light: symmetric, cells x cells, and one right side of R, G, B.
struct Equations {
    matrix: Vec<f64>,
    right: Vec<DVec3>,
}

impl Equations {
    /// Sums over texels, each with the share of every cell in its shading, its weight, and its target shading.
    fn new<'a>(
        cells: usize,
        texels: usize,
        texel: impl Fn(usize) -> (&'a [f32], f32, Vec3) + Sync,
    ) -> Self {
        let each = texels.div_ceil(TASKS);
        let sum = |task: usize| {
            let mut matrix = vec![0.0_f32; cells * cells];
            let mut right = vec![Vec3::ZERO; cells];
            for at in task * each..((task + 1) * each).min(texels) {
                let (row, weight, wanted) = texel(at);
                for (i, value) in row.iter().enumerate().filter(|(_, value)| **value > 0.0) {
                    right[i] += weight * value * wanted;
                    add_scaled(&mut matrix[i * cells..][..cells], row, weight * value);
                }
            }
            (matrix, right)
        };
        let sums: Vec<_> = (0..TASKS).into_par_iter().map(sum).collect();
        let matrix = |at: usize| sums.iter().map(|sum| f64::from(sum.0[at])).sum();
        let right = |at: usize| sums.iter().map(|sum| sum.1[at].as_dvec3()).sum();
        Self {
            matrix: (0..cells * cells).map(matrix).collect(),
            right: (0..cells).map(right).collect(),
        }
    }

    fn solve(&self, light: &mut [DVec3]) {
        let cells = light.len();
        for _ in 0..SWEEPS {
            for at in 0..cells {
                let row = &self.matrix[at * cells..][..cells];
                let found: DVec3 = row.iter().zip(&*light).map(|(m, l)| *m * *l).sum();
                // A cell that lights no texel does not change.
                if row[at] > 0.0 {
                    light[at] = (light[at] + (self.right[at] - found) / row[at]).max(DVec3::ZERO);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of pseudo-random values, 0 to 1.
    fn row(at: usize) -> Vec<f32> {
        (0..12)
            .map(|i| ((at as f32 * 12.9898 + i as f32 * 78.233).sin() * 43758.547).fract().abs())
            .collect()
    }

    /// The Karush-Kuhn-Tucker conditions of non-negative light: the gradient is 0 in cells with light and not negative
    /// in others, within half a percent of the share of a light of 1 in the cell.
    #[test]
    fn the_light_is_the_optimal_non_negative_one() {
        let rows: Vec<Vec<f32>> = (0..90).map(row).collect();
        let weight = |at: usize| 0.5 + (at % 3) as f32;
        let wanted = |at: usize| Vec3::new(rows[at][1], rows[at][0] - 0.4 * rows[at][3], 1.0);
        let texel = |at: usize| (rows[at].as_slice(), weight(at), wanted(at));
        let mut light = vec![DVec3::ONE; 12];
        Equations::new(12, 90, texel).solve(&mut light);
        assert!((light[1].x - 1.0).abs() < 1e-3 && light[3].y == 0.0);
        for cell in 0..12 {
            let gradient = |at: usize| {
                let found: DVec3 =
                    rows[at].iter().zip(&light).map(|(r, l)| f64::from(*r) * *l).sum();
                f64::from(weight(at) * rows[at][cell]) * (found - wanted(at).as_dvec3())
            };
            let gradient: DVec3 = (0..90).map(gradient).sum();
            for channel in 0..3 {
                let most = if light[cell][channel] > 0.0 { 0.2 } else { f64::INFINITY };
                assert!((-0.2..most).contains(&gradient[channel]), "{cell} {gradient} {light:?}");
            }
        }
    }
}
