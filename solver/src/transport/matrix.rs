//! Matrices from the light's cells to texels or samples, and their products.

use rayon::prelude::*;

use super::CHANNELS;
use crate::config::TransportConfig;
use crate::simd::widened;

/// The weights of the rows that a texel's blocked rays hit, by row.
pub(super) type Bounces = Vec<(u32, f32)>;

/// Rows per task of the gradient, summed in order.
const CHUNK: usize = 256;
/// Independent sums of a product, which the compiler vectorises.
const LANES: usize = 16;

/// Rows of `cells` weights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Matrix {
    pub rows: Vec<f32>,
    pub cells: usize,
}

impl Matrix {
    /// The rows of `direct` light plus those of its bounces.
    pub fn with_bounces(
        direct: Vec<f32>,
        bounces: &[Bounces],
        cells: usize,
        config: &TransportConfig,
    ) -> Self {
        let mut rows = direct.clone();
        let mut last = direct;
        let mut albedo = 1.0;
        for _ in 0..config.bounces {
            albedo *= config.bounce_albedo;
            last = bounced(bounces, &last, cells);
            rows.par_iter_mut().zip(&last).for_each(|(sum, once)| *sum += albedo * once);
        }
        Self { rows, cells }
    }

    /// The products of every row with a light of R, G, B per cell.
    pub fn product(&self, light: &[f32]) -> Vec<[f32; CHANNELS]> {
        let planes = planes(light);
        let planes = planes.each_ref().map(Vec::as_slice);
        self.rows.par_chunks(self.cells).map(|row| dots(row, planes)).collect()
    }

    /// [`Self::product`] of some rows; 0 elsewhere.
    pub fn product_of_rows(&self, light: &[f32], is_used: &[bool]) -> Vec<[f32; CHANNELS]> {
        let planes = planes(light);
        let planes = planes.each_ref().map(Vec::as_slice);
        let rows = self.rows.par_chunks(self.cells).zip(is_used);
        rows.map(|(row, used)| if *used { dots(row, planes) } else { [0.0; CHANNELS] }).collect()
    }

    /// The adjoint of [`Self::product`]: the gradient with respect to the light.
    pub fn adjoint(&self, by_row: &[[f32; CHANNELS]]) -> Vec<f32> {
        self.summed(|i, _| (by_row[i], ())).0
    }

    /// [`Self::product`] with a light and [`Self::adjoint`] in one pass over the rows: `value` returns the gradient
    /// with respect to a row's product, and another result, which is returned in order.
    pub fn exchange<T: Send>(
        &self,
        light: &[f32],
        value: impl Fn(usize, [f32; CHANNELS]) -> ([f32; CHANNELS], T) + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        let planes = planes(light);
        let planes = planes.each_ref().map(Vec::as_slice);
        self.summed(|i, row| value(i, dots(row, planes)))
    }

    /// The sum of the rows with the factors from `value`, R, G, B per cell; and the other results of `value`.
    fn summed<T: Send>(
        &self,
        value: impl Fn(usize, &[f32]) -> ([f32; CHANNELS], T) + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        let part = |(chunk, rows): (usize, &[f32])| {
            let mut sums = vec![0.0f32; CHANNELS * self.cells];
            let work = |(i, row)| {
                let (by_row, rest): ([f32; CHANNELS], T) = value(chunk * CHUNK + i, row);
                if by_row != [0.0; CHANNELS] {
                    add_to_channels(&mut sums, row, by_row);
                }
                rest
            };
            let rest = rows.chunks_exact(self.cells).enumerate().map(work).collect();
            (sums, rest)
        };
        let parts = self.rows.par_chunks(CHUNK * self.cells).enumerate().map(part);
        let (parts, rest): (Vec<Vec<f32>>, Vec<Vec<T>>) = parts.unzip();
        let total = |at: usize| parts.iter().map(|part| f64::from(part[at])).sum::<f64>() as f32;
        let at = |i: usize| i % CHANNELS * self.cells + i / CHANNELS;
        let sums = (0..CHANNELS * self.cells).map(|i| total(at(i))).collect();
        (sums, rest.into_iter().flatten().collect())
    }
}

/// Splits a light of R, G, B per cell into channels.
fn planes(light: &[f32]) -> [Vec<f32>; CHANNELS] {
    std::array::from_fn(|c| light.iter().skip(c).step_by(CHANNELS).copied().collect())
}

/// B x `rows`.
fn bounced(bounces: &[Bounces], rows: &[f32], cells: usize) -> Vec<f32> {
    let mut out = vec![0.0; rows.len()];
    out.par_chunks_mut(cells.max(1)).zip(bounces).for_each(|(out, bounces)| {
        for (row, weight) in bounces {
            let from = &rows[*row as usize * cells..][..cells];
            add_scaled(out, from, *weight);
        }
    });
    out
}

widened! {
    pub(crate) fn add_scaled(sum: &mut [f32], values: &[f32], factor: f32) {
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum += factor * value;
        }
    }
}

widened! {
    /// Adds `row` times the factor of each channel to that channel's sums.
    fn add_to_channels(sums: &mut [f32], row: &[f32], factors: [f32; CHANNELS]) {
        let [r, g, b] = factors;
        let (red, rest) = sums.split_at_mut(row.len());
        let (green, blue) = rest.split_at_mut(row.len());
        let sums = red.iter_mut().zip(green).zip(blue);
        for (((red, green), blue), value) in sums.zip(row) {
            *red += r * value;
            *green += g * value;
            *blue += b * value;
        }
    }
}

widened! {
    /// The products of `row` with the light of each channel.
    fn dots(row: &[f32], light: [&[f32]; CHANNELS]) -> [f32; CHANNELS] {
        let (whole, rest) = row.as_chunks::<LANES>();
        let mut dots = [0.0; CHANNELS];
        // Channel by channel: otherwise the compiler uses narrow vectors of the three channels.
        for (dot, light) in dots.iter_mut().zip(light) {
            let (parts, last) = light[..row.len()].as_chunks::<LANES>();
            let mut lanes = [0.0f32; LANES];
            for (row, light) in whole.iter().zip(parts) {
                for lane in 0..LANES {
                    lanes[lane] += row[lane] * light[lane];
                }
            }
            let rest: f32 = rest.iter().zip(last).map(|(a, b)| a * b).sum();
            *dot = lanes.iter().sum::<f32>() + rest;
        }
        dots
    }
}
