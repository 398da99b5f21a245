//! A wide Gaussian blur on a texture that is as coarse as the blur allows.
//!
//! A texture is halved (each coarse texel is the mean of 4 x 4 fine ones by 1, 3, 3, 1) until the blur's
//! standard deviation is less than four texels, convolved there, and interpolated back: the pyramid of Burt
//! and Adelson ("The Laplacian Pyramid as a Compact Image Code", 1983). Halving and interpolation blur by three
//! quarters of a squared texel each, by which the convolution is narrower. What comes out is within .6 % of the
//! Gaussian that is not cut off (root mean square, white noise; 2 % with the borders), as a convolution to three
//! standard deviations is within .4 %. A value costs 8 operations and its share of a coarse convolution, instead
//! of 12 multiply-adds for every texel of the standard deviation.

use std::ops::Range;

use super::halving::{
    CHANNELS, FAR, Lines, NEAR, ROWS, Texel, double, doubled_row, even, halve, halved_region,
    neighbours, texels,
};
use crate::convolution::{Shape, convolve, gaussian};
use crate::parallel::from_parts;
use crate::region::Region;
use crate::simd::widened;

/// Texels of the blur's standard deviation, at least, where it is convolved on a coarser texture.
const LEAST_SIGMA: f32 = 2.0;
/// What halving and interpolating once blur by: squared texels of the finer texture.
const VARIANCE: f32 = 1.5;

/// Blurs square textures of four channels; near the border the weights that remain are scaled to sum to one.
///
/// The blur is N K: K is symmetric, halves once ([`Sums`](super::halving::Sums) of rows), convolves the *base*
/// ([`Pyramid::convolved`]) and interpolates its rows ([`Pyramid::row`]); N is diagonal ([`Pyramid::scale`]), so
/// that the adjoint is K N.
#[derive(Clone, Debug)]
pub struct Pyramid {
    size: usize,
    /// How often a texture is halved before it is convolved.
    levels: usize,
    /// Of the coarsest level, from the centre outwards.
    kernel: Vec<f32>,
    /// One over the sum of K's weights, by column (and by row).
    norms: Vec<f32>,
    /// The same for every value of a row.
    scales: Vec<f32>,
}

impl Pyramid {
    /// `sigma` is the standard deviation in texels; zero leaves textures as they are.
    pub fn new(size: usize, sigma: f32) -> Self {
        let least = |levels: usize| (LEAST_SIGMA * (1 << levels) as f32).powi(2);
        let fits = |levels: &usize| {
            sigma * sigma >= least(*levels)
                && size.is_multiple_of(1 << levels)
                && size >> levels > 1
        };
        let levels = (1..usize::BITS as usize).take_while(fits).last().unwrap_or(0);
        let halvings = ((1 << (2 * levels)) - 1) as f32 / 3.0;
        let rest = (sigma * sigma - VARIANCE * halvings).sqrt() / (1 << levels) as f32;
        let mut pyramid =
            Self { size, levels, kernel: gaussian(rest), norms: vec![], scales: vec![] };
        let sums = pyramid.line(&vec![1.0; size], 0);
        pyramid.norms = sums.into_iter().map(|sum| 1.0 / sum).collect();
        pyramid.scales = pyramid.norms.iter().flat_map(|norm| [*norm; CHANNELS]).collect();
        pyramid
    }

    /// K of one row of one channel, from a level on.
    fn line(&self, line: &[f32], level: usize) -> Vec<f32> {
        if level < self.levels {
            let mut coarse = vec![0.0; line.len() / 2];
            let near = |at: usize| neighbours(at, line.len() / 2).into_iter().zip([NEAR, FAR]);
            for (at, value) in line.iter().enumerate() {
                near(at).for_each(|(near, weight)| coarse[near] += weight * value);
            }
            let coarse = self.line(&coarse, level + 1);
            let value = |at: usize| near(at).map(|(near, weight)| weight * coarse[near]).sum();
            return (0..line.len()).map(value).collect();
        }
        let weight = |a: usize, b: usize| self.kernel.get(a.abs_diff(b)).copied().unwrap_or(0.0);
        let sum = |at: usize| (0..line.len()).map(|other| weight(at, other) * line[other]).sum();
        (0..line.len()).map(sum).collect()
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// How often they are halved.
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// Weights of the convolution along a row.
    pub fn taps(&self) -> usize {
        2 * self.kernel.len() - 1
    }

    /// Weights of the coarsest level from the centre outwards, before they are scaled.
    pub(crate) fn kernel(&self) -> &[f32] {
        &self.kernel
    }

    /// Of every column (and row), one over the sum of the weights inside the texture.
    pub(crate) fn norms(&self) -> &[f32] {
        &self.norms
    }

    /// Side of the base.
    pub fn base_size(&self) -> usize {
        self.size >> self.levels.min(1)
    }

    /// What depends on a region, and what it depends on: of the texture, and of every level.
    pub fn reach(&self, region: &Region) -> Vec<Region> {
        let reach = (self.kernel.len() + 3) << self.levels;
        let mut regions = vec![region.dilated(reach, self.size)];
        for level in 0..self.levels {
            regions.push(halved_region(&regions[level], self.size >> level));
        }
        regions
    }

    /// A texture halved to the base, in what is reached; if it is halved at all.
    pub fn halved(&self, texture: &[Texel], reach: &[Region]) -> Option<Vec<Texel>> {
        (self.levels > 0).then(|| {
            let mut out = vec![[0.0; CHANNELS]; self.base_size() * self.base_size()];
            halve(texture, self.size, &reach[0], &mut out);
            out
        })
    }

    /// K between the halving to the base and the interpolation from there, in what is reached.
    pub fn convolved(&self, base: &[Texel], reach: &[Region]) -> Vec<f32> {
        self.convolved_from(base, self.levels.min(1), reach)
    }

    fn convolved_from(&self, texture: &[Texel], level: usize, reach: &[Region]) -> Vec<f32> {
        let size = self.size >> level;
        if level < self.levels {
            let mut coarse = vec![[0.0; CHANNELS]; size / 2 * (size / 2)];
            halve(texture, size, &reach[level], &mut coarse);
            let coarse = self.convolved_from(&coarse, level + 1, reach);
            return double(&coarse, size, &reach[level]);
        }
        if self.kernel.len() == 1 {
            return texture.as_flattened().to_vec();
        }
        let shape = Shape { width: size, height: size, channels: CHANNELS };
        let nothing = |_: usize, _: usize, _: &mut [f32]| {};
        let values = texture.as_flattened();
        convolve(values, &self.kernel, shape, &reach[level], nothing, nothing)
    }

    /// Multiplies columns of a row as N does.
    pub fn scale(&self, row: usize, columns: &Range<usize>, texels: &mut [Texel]) {
        scale(texels, &self.scales[CHANNELS * columns.start..], self.norms[row]);
    }

    /// Columns of a row of the blurred texture, from its base.
    pub fn blurred_row<'a>(
        &self,
        base: &[f32],
        row: usize,
        columns: &Range<usize>,
        lines: &'a mut Lines,
    ) -> &'a [Texel] {
        let texels = self.row(base, row, columns, lines);
        self.scale(row, columns, texels);
        texels
    }

    /// Columns of a row of a texture, from its base.
    pub fn row<'a>(
        &self,
        base: &[f32],
        row: usize,
        columns: &Range<usize>,
        lines: &'a mut Lines,
    ) -> &'a mut [Texel] {
        let wide = even(columns, self.size);
        match self.levels {
            0 => lines.fine[wide.clone()].copy_from_slice(&texels(base)[row * self.size..][wide]),
            _ => doubled_row(base, self.size, row, &wide, lines),
        }
        &mut lines.fine[columns.clone()]
    }

    /// The blurred texture, texel by texel.
    pub fn apply(&self, texture: &[Texel]) -> Vec<f32> {
        let reach = &self.reach(&Region::whole(self.size, self.size));
        let halved = self.halved(texture, reach);
        let base = self.convolved(halved.as_deref().unwrap_or(texture), reach);
        let line = CHANNELS * self.size;
        let task = |number: usize, out: &mut [f32]| {
            let mut lines = Lines::new(self.size);
            for (row, out) in (number * ROWS..).zip(out.chunks_exact_mut(line)) {
                let texels = self.blurred_row(&base, row, &(0..self.size), &mut lines);
                out.copy_from_slice(texels.as_flattened());
            }
        };
        from_parts(self.size * line, ROWS * line, task).0
    }
}

widened! {
    /// Multiplies with what the row and the columns are scaled by.
    fn scale(texels: &mut [Texel], columns: &[f32], row: f32) {
        for (value, column) in texels.as_flattened_mut().iter_mut().zip(columns) {
            *value *= row * column;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::halving::{Sums, add_edges};
    use super::*;

    fn noise(size: usize, seed: u32) -> Vec<Texel> {
        let value = |i: usize| {
            let mixed = (i as u32 ^ seed << 24).wrapping_mul(0x9e37_79b9);
            let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b);
            ((mixed ^ mixed >> 13) as f32 / u32::MAX as f32) - 0.5
        };
        (0..size * size).map(|i| std::array::from_fn(|c| value(CHANNELS * i + c))).collect()
    }

    fn dot(a: &[Texel], b: &[Texel]) -> f64 {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
    }

    /// K N, by the rows of the texture in two parts.
    fn adjoint(pyramid: &Pyramid, texture: &[Texel]) -> Vec<Texel> {
        let size = pyramid.size();
        let all = 0..size;
        let mut lines = Lines::new(size);
        let width = pyramid.base_size();
        let mut base = vec![[0.0; CHANNELS]; width * width];
        let cut = size / 4 * 2;
        let (upper, lower) = base.split_at_mut(cut * width / size * width);
        let mut edges = vec![];
        for (rows, own) in [(0..cut, upper), (cut..size, lower)] {
            let mut sums = Sums::new(size, width, rows.start, own);
            for row in rows {
                let fill = |out: &mut [Texel]| {
                    out.copy_from_slice(&texture[row * size..][..size]);
                    pyramid.scale(row, &all, out);
                };
                sums.add(row, &all, &mut lines, fill);
            }
            edges.extend(sums.edges());
        }
        add_edges(&mut base, &edges);
        let reach = &pyramid.reach(&Region::whole(size, size));
        let base = pyramid.convolved(&base, reach);
        (0..size).flat_map(|row| pyramid.row(&base, row, &all, &mut lines).to_vec()).collect()
    }

    #[test]
    fn it_is_the_gaussian_that_is_not_cut_off() {
        for (size, sigma, levels) in [(96, 3.9, 0), (96, 4.1, 1), (96, 7.0, 1), (128, 8.2, 2)] {
            let pyramid = Pyramid::new(size, sigma);
            assert_eq!(pyramid.levels(), levels);
            let texture = noise(size, 0);
            let blurred = pyramid.apply(&texture);
            let blurred = texels(&blurred);
            let weight = |d: usize| (-0.5 * (d as f64 / f64::from(sigma)).powi(2)).exp();
            let axis = |at: usize| -> Vec<f64> {
                let weights: Vec<_> = (0..size).map(|other| weight(at.abs_diff(other))).collect();
                let sum: f64 = weights.iter().sum();
                weights.into_iter().map(|weight| weight / sum).collect()
            };
            let axes: Vec<_> = (0..size).map(axis).collect();
            let (mut error, mut square) = (0.0, 0.0);
            let places = |step: usize| (16..size - 16).step_by(step);
            for (y, x) in places(5).flat_map(|y| places(7).map(move |x| (y, x))) {
                let row = |v: usize| -> f64 {
                    (0..size).map(|u| axes[x][u] * f64::from(texture[v * size + u][2])).sum()
                };
                let exact: f64 = (0..size).map(|v| axes[y][v] * row(v)).sum();
                error += (f64::from(blurred[y * size + x][2]) - exact).powi(2);
                square += exact.powi(2);
            }
            let error = (error / square).sqrt();
            assert!(error < 0.01, "{sigma}: {error}");
        }
    }

    #[test]
    fn constants_stay_and_zero_sigma_is_the_identity() {
        for (size, sigma) in [(9, 1.5), (40, 5.0), (64, 9.0)] {
            let blurred = Pyramid::new(size, sigma).apply(&vec![[0.7; CHANNELS]; size * size]);
            assert!(blurred.iter().all(|v| (v - 0.7).abs() < 1e-6), "{size}");
        }
        assert_eq!(texels(&Pyramid::new(5, 0.0).apply(&noise(5, 0))), noise(5, 0));
    }

    #[test]
    fn the_adjoint_is_the_transpose() {
        for (size, sigma) in [(7, 1.3), (42, 4.1), (64, 8.5)] {
            let pyramid = Pyramid::new(size, sigma);
            let (x, y) = (noise(size, 0), noise(size, 1));
            let (left, right) =
                (dot(texels(&pyramid.apply(&x)), &y), dot(&x, &adjoint(&pyramid, &y)));
            assert!((left - right).abs() < 1e-5 * size as f64, "{size}: {left} {right}");
        }
    }

    /// Of a part of the texture, what the whole gives there.
    #[test]
    fn what_is_reached_is_enough() {
        let (size, part) = (128, 40..75);
        for sigma in [2.0, 4.1, 8.5] {
            let pyramid = Pyramid::new(size, sigma);
            let texture = noise(size, 0);
            let blurred = pyramid.apply(&texture);
            let blurred = texels(&blurred);
            let mut rows = vec![0..0; size];
            rows[30..50].fill(part.clone());
            let reach = &pyramid.reach(&Region(rows));
            // What is not reached does not matter.
            let mut texture = texture.clone();
            for (row, columns) in texture.chunks_mut(size).zip(&reach[0].0) {
                row[..columns.start].fill([1e3; CHANNELS]);
                row[columns.end..].fill([1e3; CHANNELS]);
            }
            let halved = pyramid.halved(&texture, reach);
            let base = pyramid.convolved(halved.as_deref().unwrap_or(&texture), reach);
            let mut lines = Lines::new(size);
            for row in 30..50 {
                let got = pyramid.blurred_row(&base, row, &part, &mut lines);
                assert_eq!(got, &blurred[row * size..][part.clone()], "{sigma}");
            }
        }
    }
}
