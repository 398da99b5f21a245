//! The light of all cells that explains a chart best with one reflectance for each of its regions.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::chart::{Chart, luminance, means};
use super::colours::largest;
use crate::config::ColourRegionConfig;
use crate::transport::add_scaled;

/// Texels whose normal equations are summed by one task, in their order.
const CHUNK: usize = 512;
/// Sweeps over all cells for each of the normal equations.
const SWEEPS: usize = 60;

/// A light of R, G, B per cell, and the chart that it shines on.
pub(super) struct CellLight<'a> {
    chart: &'a Chart,
    config: &'a ColourRegionConfig,
    light: Vec<DVec3>,
    /// The colours of the texels seen divided by their shading, of mean 1.
    pub divided: Vec<Vec3>,
}

impl<'a> CellLight<'a> {
    /// 1 from everywhere.
    pub fn new(chart: &'a Chart, config: &'a ColourRegionConfig) -> Self {
        let light = vec![DVec3::ONE; chart.cells(0).len()];
        Self { chart, config, light, divided: chart.colours.clone() }
    }

    /// Finds the light that explains the chart best with one albedo for each of the `regions`, and from it the albedo
    /// of every texel seen. The less light a texel gets, the more it is taken for the largest region, whose colour
    /// counts as much as its own at a shading of `shading_prior`.
    pub fn albedo(&mut self, regions: &[u8]) -> Vec<Vec3> {
        let ColourRegionConfig { dark, shading_floor, shading_prior: prior, .. } = *self.config;
        let of_regions = means(&self.divided, regions, dark);
        let shading = self.find(&of_regions, regions);
        let lit: Vec<Vec3> = shading.iter().map(|s| s.max(Vec3::splat(shading_floor))).collect();
        self.divided = self.chart.divided(&lit);
        let largest = means(&self.divided, regions, dark)[usize::from(largest(regions))];
        let texel = |(colour, shading)| (colour + prior * largest) / (shading + prior);
        self.chart.colours.iter().copied().zip(shading).map(texel).collect()
    }

    /// Least squares with weights towards L1, over light that is not negative: of the normal equations, one cell
    /// after the other. Gives the shading of the texels seen.
    fn find(&mut self, means: &[Vec3], regions: &[u8]) -> Vec<Vec3> {
        let (chart, config) = (self.chart, self.config);
        let mean = |region: &u8| means[usize::from(*region)];
        let most = means.iter().map(luminance).fold(0.0, f32::max);
        let share: Vec<f32> =
            regions.iter().map(|region| luminance(&mean(region)) / most).collect();
        let wanted: Vec<Vec3> = chart
            .colours
            .iter()
            .zip(regions)
            .map(|(colour, region)| colour.max(Vec3::ZERO) / mean(region))
            .collect();
        for _ in 0..config.reweightings {
            let found = self.found();
            let weight = |at: usize| {
                let residual = (wanted[at] - found[at]).abs().element_sum() / 3.0;
                share[at] / (residual + config.residual_floor)
            };
            let equations = Equations::new(chart, &wanted, weight);
            equations.solve(&mut self.light);
        }
        let found = self.found();
        let mean = found.iter().map(|s| s.as_dvec3()).sum::<DVec3>() / found.len() as f64;
        let mean = mean.as_vec3().max(Vec3::splat(f32::MIN_POSITIVE));
        found.into_iter().map(|shading| shading / mean).collect()
    }

    /// The shading of the texels seen.
    fn found(&self) -> Vec<Vec3> {
        let light: Vec<Vec3> = self.light.iter().map(|light| light.as_vec3()).collect();
        let texel = |at: usize| self.chart.cells(at).iter().zip(&light).map(|(c, l)| *c * *l).sum();
        (0..self.chart.seen.len()).into_par_iter().map(texel).collect()
    }
}

/// Normal equations of the light: symmetric, cells x cells, and one right side of R, G, B.
struct Equations {
    matrix: Vec<f64>,
    right: Vec<DVec3>,
}

impl Equations {
    fn new(chart: &Chart, wanted: &[Vec3], weight: impl Fn(usize) -> f32 + Sync) -> Self {
        let cells = chart.cells(0).len();
        let chunk = |start: usize| {
            let mut matrix = vec![0.0_f32; cells * cells];
            let mut right = vec![Vec3::ZERO; cells];
            for at in start..(start + CHUNK).min(wanted.len()) {
                let (row, weight) = (chart.cells(at), weight(at));
                for (i, value) in row.iter().enumerate().filter(|(_, value)| **value > 0.0) {
                    right[i] += weight * value * wanted[at];
                    add_scaled(&mut matrix[i * cells..][..cells], row, weight * value);
                }
            }
            (matrix, right)
        };
        let starts: Vec<usize> = (0..wanted.len()).step_by(CHUNK).collect();
        let chunks: Vec<_> = starts.into_par_iter().map(chunk).collect();
        let matrix = |at: usize| chunks.iter().map(|chunk| f64::from(chunk.0[at])).sum();
        let right = |at: usize| chunks.iter().map(|chunk| chunk.1[at].as_dvec3()).sum();
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
                // A cell that no texel sees stays as it is.
                if row[at] > 0.0 {
                    light[at] = (light[at] + (self.right[at] - found) / row[at]).max(DVec3::ZERO);
                }
            }
        }
    }
}
