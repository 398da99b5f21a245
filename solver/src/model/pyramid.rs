//! A wide Gaussian blur on a texture that is as coarse as the blur allows.
//!
//! A texture is halved (each coarse texel is the mean of 4 x 4 fine ones by 1, 3, 3, 1) until the blur's
//! standard deviation is less than four texels, convolved there, and interpolated back: the pyramid of Burt
//! and Adelson ("The Laplacian Pyramid as a Compact Image Code", 1983). Halving and interpolation blur by three
//! quarters of a squared texel each, by which the convolution is narrower. What comes out is within .5 % of the
//! Gaussian that is not cut off (root mean square, white noise), as a convolution to three standard deviations
//! is, for 9 operations a value and a coarse convolution in place of 12 standard deviations.

use std::ops::Range;

use rayon::prelude::*;

use crate::convolution::{Shape, convolve, gaussian};
use crate::parallel::from_parts;
use crate::region::Region;
use crate::simd::widened;

/// Values of a texel.
pub const CHANNELS: usize = 4;
/// A texel.
pub type Texel = [f32; CHANNELS];

/// Texels of the blur's standard deviation, at least, where it is convolved on a coarser texture.
const LEAST_SIGMA: f32 = 2.0;
/// What halving and interpolating once blur by: squared texels of the finer texture.
const VARIANCE: f32 = 1.5;
/// Weights of the nearer and the further texel.
const NEAR: f32 = 0.75;
const FAR: f32 = 0.25;
/// Rows that one task makes.
const ROWS: usize = 8;

/// Blurs square textures of four channels; near the border the weights that remain are scaled to sum to one.
///
/// The blur is N K: K is symmetric, halves once ([`Pyramid::halved`], or [`Sums`] of rows), convolves the
/// *base* ([`Pyramid::convolved`]) and interpolates its rows ([`Pyramid::row`]); N is diagonal, so that the
/// adjoint is K N.
#[derive(Clone, Debug)]
pub struct Pyramid {
    size: usize,
    /// How often a texture is halved before it is convolved.
    levels: usize,
    /// Of the coarsest level, from the centre outwards.
    kernel: Vec<f32>,
    /// One over the sum of K's weights, by column (and by row).
    norms: Vec<f32>,
}

impl Pyramid {
    /// `sigma` is the standard deviation in texels; zero leaves textures as they are.
    pub fn new(size: usize, sigma: f32) -> Self {
        let least = |levels: usize| (LEAST_SIGMA * (1 << levels) as f32).powi(2);
        let fits = |levels: &usize| {
            sigma * sigma >= least(*levels) && size.is_multiple_of(1 << levels) && size >> levels > 1
        };
        let levels = (1..usize::BITS as usize).take_while(fits).last().unwrap_or(0);
        let halvings = ((1 << (2 * levels)) - 1) as f32 / 3.0;
        let rest = (sigma * sigma - VARIANCE * halvings).sqrt() / (1 << levels) as f32;
        let mut pyramid = Self { size, levels, kernel: gaussian(rest), norms: vec![] };
        let line = pyramid.line(&vec![[1.0; CHANNELS]; size], 0);
        pyramid.norms = line.into_iter().map(|[sum, ..]| 1.0 / sum).collect();
        pyramid
    }

    /// K of one row, from a level on.
    fn line(&self, line: &[Texel], level: usize) -> Vec<Texel> {
        if level < self.levels {
            let mut coarse = vec![[0.0; CHANNELS]; line.len() / 2];
            let fine = [&[[0.0; CHANNELS]], line, &[[0.0; CHANNELS]]].concat();
            halve_row(&mut coarse, &fine);
            let coarse = self.line(&coarse, level + 1);
            let coarse = [&[[0.0; CHANNELS]], &*coarse, &[[0.0; CHANNELS]]].concat();
            let mut out = vec![[0.0; CHANNELS]; line.len()];
            double_row(&mut out, &coarse);
            return out;
        }
        let weight = |a: usize, b: usize| self.kernel.get(a.abs_diff(b)).copied().unwrap_or(0.0);
        let sum = |at: usize| (0..line.len()).map(|other| weight(at, other) * line[other][0]).sum();
        (0..line.len()).map(|at| [sum(at); CHANNELS]).collect()
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// How often they are halved.
    pub fn levels(&self) -> usize {
        self.levels
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
    pub fn base(&self) -> usize {
        self.size >> self.levels.min(1)
    }

    /// What depends on a region, and what it depends on: of the texture, and of every level.
    pub fn reach(&self, region: &Region) -> Vec<Region> {
        let reach = (self.kernel.len() + 2) << self.levels;
        let mut regions = vec![region.dilated(reach, self.size)];
        for level in 0..self.levels {
            regions.push(halved_region(&regions[level], self.size >> level));
        }
        regions
    }

    /// All of K but the interpolation from the base, in what is reached.
    pub fn halved(&self, texture: &[Texel], reach: &[Region]) -> Vec<f32> {
        self.convolved_from(texture, 0, reach)
    }

    /// K between the halving to the base and the interpolation from there, in what is reached.
    pub fn convolved(&self, base: &[f32], reach: &[Region]) -> Vec<f32> {
        self.convolved_from(texels(base), self.levels.min(1), reach)
    }

    fn convolved_from(&self, texture: &[Texel], level: usize, reach: &[Region]) -> Vec<f32> {
        let size = self.size >> level;
        if level < self.levels {
            let coarse = halve(texture, size, &reach[level + 1]);
            let coarse = self.convolved_from(texels(&coarse), level + 1, reach);
            // The base is interpolated row by row, where it is used.
            return if level == 0 { coarse } else { double(&coarse, size, &reach[level]) };
        }
        if self.kernel.len() == 1 {
            return texture.as_flattened().to_vec();
        }
        let shape = Shape { width: size, height: size, channels: CHANNELS };
        let nothing = |_: usize, _: usize, _: &mut [f32]| {};
        let values = texture.as_flattened();
        convolve(values, &self.kernel, shape, &reach[level], nothing, nothing)
    }

    /// Columns of a row of the blurred texture, from its base.
    pub fn blurred_row<'a>(
        &self,
        base: &[f32],
        row: usize,
        columns: &Range<usize>,
        lines: &'a mut Lines,
    ) -> &'a [Texel] {
        let texels = self.fine_row(base, row, columns, lines);
        scale(texels, &self.norms[columns.start..], self.norms[row]);
        texels
    }

    /// Columns of a row of a texture, from its base.
    pub fn row<'a>(
        &self,
        base: &[f32],
        row: usize,
        columns: &Range<usize>,
        lines: &'a mut Lines,
    ) -> &'a [Texel] {
        self.fine_row(base, row, columns, lines)
    }

    fn fine_row<'a>(
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

    /// The blurred texture.
    pub fn apply(&self, texture: &[Texel]) -> Vec<Texel> {
        let reach = &self.reach(&Region::whole(self.size, self.size));
        let (base, all) = (self.halved(texture, reach), 0..self.size);
        let mut out = vec![[0.0; CHANNELS]; texture.len()];
        let rows = out.par_chunks_mut(self.size).enumerate();
        rows.for_each_init(
            || Lines::new(self.size),
            |lines, (row, out)| out.copy_from_slice(self.blurred_row(&base, row, &all, lines)),
        );
        out
    }
}

/// Rows of a texture and of the next coarser one that are worked on.
pub struct Lines {
    fine: Vec<Texel>,
    /// With neighbours on both sides, and with three of them.
    coarse: Vec<Texel>,
    padded: Vec<Texel>,
}

impl Lines {
    /// Of textures of side `size`.
    pub fn new(size: usize) -> Self {
        let [fine, coarse, padded] =
            [size, size / 2 + 2, size + 2 * PAD].map(|length| vec![[0.0; CHANNELS]; length]);
        Self { fine, coarse, padded }
    }
}

/// Rows of the base, from a first one on, that rows of N t are added to.
pub struct Sums {
    /// The first row.
    pub first: usize,
    /// The rows that there are so far.
    pub texels: Vec<Texel>,
}

impl Sums {
    /// For rows of a texture from `row` on.
    pub fn new(pyramid: &Pyramid, row: usize) -> Self {
        let first = if pyramid.levels == 0 { row } else { (row / 2).saturating_sub(1) };
        Self { first, texels: vec![] }
    }

    /// Adds columns of a row, which `fill` adds to zeros.
    pub fn add(
        &mut self,
        pyramid: &Pyramid,
        row: usize,
        columns: &Range<usize>,
        Lines { coarse, padded, .. }: &mut Lines,
        fill: impl FnOnce(&mut [Texel]),
    ) {
        let (wide, width) = (even(columns, pyramid.size), pyramid.base());
        let padded = &mut padded[..wide.len() + 2 * PAD];
        padded.fill([0.0; CHANNELS]);
        let fine = &mut padded[PAD + columns.start - wide.start..][..columns.len()];
        fill(fine);
        scale(fine, &pyramid.norms[columns.start..], pyramid.norms[row]);
        if pyramid.levels == 0 {
            add(self.row(row, width, columns), fine, 1.0);
            return;
        }
        // Two more than half of them, of which the border may cut off one.
        let (first, count) = (wide.start / 2, wide.len() / 2 + 2);
        halve_row(&mut coarse[..count], padded);
        let inside = first.saturating_sub(1)..(first + count - 1).min(width);
        let coarse = &coarse[inside.start + 1 - first..][..inside.len()];
        let (near, far) = neighbours(row, width);
        add(self.row(near, width, &inside), coarse, NEAR);
        if let Some(far) = far {
            add(self.row(far, width, &inside), coarse, FAR);
        }
    }

    fn row(&mut self, row: usize, width: usize, columns: &Range<usize>) -> &mut [Texel] {
        let at = (row - self.first) * width;
        if self.texels.len() < at + width {
            self.texels.resize(at + width, [0.0; CHANNELS]);
        }
        &mut self.texels[at..at + width][columns.clone()]
    }
}

/// Zeros on both sides of what is halved.
const PAD: usize = 3;

/// The coarse row that a row lies in, and the nearest other one, of `count`.
fn neighbours(row: usize, count: usize) -> (usize, Option<usize>) {
    let near = row / 2;
    let far = if row.is_multiple_of(2) { near.checked_sub(1) } else { Some(near + 1) };
    (near, far.filter(|far| *far < count))
}

/// Values as whole texels.
fn texels(values: &[f32]) -> &[Texel] {
    values.as_chunks().0
}

/// Columns with what completes pairs.
fn even(columns: &Range<usize>, size: usize) -> Range<usize> {
    columns.start / 2 * 2..columns.end.next_multiple_of(2).min(size)
}

/// What has a part in a region of the next finer texture, or depends on it.
fn halved_region(region: &Region, size: usize) -> Region {
    let rows = |row: usize| {
        let columns = region.columns((2 * row).saturating_sub(1)..(2 * row + 3).min(size));
        match columns.is_empty() {
            true => 0..0,
            // One more on each side, for texels that complete a pair.
            false => (columns.start / 2).saturating_sub(2)..(columns.end / 2 + 2).min(size / 2),
        }
    };
    Region((0..size / 2).map(rows).collect())
}

/// The transpose of [`double`], in a region of the coarse texture.
fn halve(texture: &[Texel], size: usize, region: &Region) -> Vec<f32> {
    let half = size / 2;
    let task = |number: usize, out: &mut [f32]| {
        let mut line = vec![[0.0; CHANNELS]; size + 2];
        for (row, out) in (number * ROWS..).zip(out.as_chunks_mut().0.chunks_exact_mut(half)) {
            let columns = region.0[row].clone();
            if columns.is_empty() {
                continue;
            }
            // The line begins a texel before the first column's.
            let first = 2 * columns.start;
            let inside = first.saturating_sub(1)..(2 * columns.end + 1).min(size);
            let line = &mut line[..2 * columns.len() + 2];
            line.fill([0.0; CHANNELS]);
            let sums = &mut line[inside.start + 1 - first..][..inside.len()];
            for (at, weight) in [FAR, NEAR, NEAR, FAR].into_iter().enumerate() {
                if let Some(row) = (2 * row + at).checked_sub(1).filter(|row| *row < size) {
                    add(sums, &texture[row * size..][inside.clone()], weight);
                }
            }
            halve_row(&mut out[columns], line);
        }
    };
    from_parts(half * half * CHANNELS, ROWS * half * CHANNELS, task).0
}

/// A texture interpolated to twice its side, in a region of the result.
fn double(coarse: &[f32], size: usize, region: &Region) -> Vec<f32> {
    let task = |number: usize, out: &mut [f32]| {
        let mut lines = Lines::new(size);
        for (row, out) in (number * ROWS..).zip(out.as_chunks_mut().0.chunks_exact_mut(size)) {
            let columns = even(&region.0[row], size);
            if !columns.is_empty() {
                doubled_row(coarse, size, row, &columns, &mut lines);
                out[columns.clone()].copy_from_slice(&lines.fine[columns]);
            }
        }
    };
    from_parts(size * size * CHANNELS, ROWS * size * CHANNELS, task).0
}

/// Columns of a row of the texture of side `size` that a coarse one is interpolated to.
fn doubled_row(coarse: &[f32], size: usize, row: usize, columns: &Range<usize>, lines: &mut Lines) {
    let half = size / 2;
    let (first, count) = (columns.start / 2, columns.len() / 2 + 2);
    let inside = first.saturating_sub(1)..(first + count - 1).min(half);
    let line = &mut lines.coarse[..count];
    (line[0], line[count - 1]) = ([0.0; CHANNELS], [0.0; CHANNELS]);
    let of = |row: usize| &texels(coarse)[row * half..][inside.clone()];
    let (near, far) = neighbours(row, half);
    between(&mut line[inside.start + 1 - first..][..inside.len()], of(near), far.map(of).unwrap_or_default());
    double_row(&mut lines.fine[columns.clone()], line);
}

widened! {
    /// The transpose of [`double_row`]. The line begins a texel before the first two that become one.
    fn halve_row(out: &mut [Texel], line: &[Texel]) {
        for (k, out) in out.iter_mut().enumerate() {
            let Some([a, b, c, d]) = line[2 * k..].first_chunk() else { return };
            for k in 0..CHANNELS {
                out[k] = FAR * (a[k] + d[k]) + NEAR * (b[k] + c[k]);
            }
        }
    }
}

widened! {
    /// Interpolates pairs of texels of a line which begins a texel before that of the first pair.
    fn double_row(out: &mut [Texel], line: &[Texel]) {
        for (k, out) in out.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let Some([a, b, c]) = line[k..].first_chunk() else { return };
            for k in 0..CHANNELS {
                out[0][k] = FAR * a[k] + NEAR * b[k];
                out[1][k] = NEAR * b[k] + FAR * c[k];
            }
        }
    }
}

widened! {
    /// Between a near row and a far one; beyond the border there are zeros.
    fn between(out: &mut [Texel], near: &[Texel], far: &[Texel]) {
        let (out, near) = (out.as_flattened_mut(), near.as_flattened());
        if far.is_empty() {
            for (out, near) in out.iter_mut().zip(near) {
                *out = NEAR * near;
            }
        }
        for ((out, near), far) in out.iter_mut().zip(near).zip(far.as_flattened()) {
            *out = NEAR * near + FAR * far;
        }
    }
}

widened! {
    fn add(sums: &mut [Texel], texels: &[Texel], weight: f32) {
        let texels = texels.as_flattened().iter();
        for (sum, value) in sums.as_flattened_mut().iter_mut().zip(texels) {
            *sum += weight * value;
        }
    }
}

widened! {
    /// Multiplies with what the row and the columns are scaled by.
    fn scale(texels: &mut [Texel], columns: &[f32], row: f32) {
        for (texel, column) in texels.iter_mut().zip(columns) {
            let factor = row * column;
            for value in texel {
                *value *= factor;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(size: usize, seed: f32) -> Vec<Texel> {
        let value = |i: usize| ((i as f32 + seed) * 12.9898).sin();
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
        let mut base = vec![[0.0; CHANNELS]; pyramid.base().pow(2)];
        for rows in [0..size / 3, size / 3..size] {
            let mut sums = Sums::new(pyramid, rows.start);
            for row in rows {
                let fill = |out: &mut [Texel]| out.copy_from_slice(&texture[row * size..][..size]);
                sums.add(pyramid, row, &all, &mut lines, fill);
            }
            add(&mut base[sums.first * pyramid.base()..], &sums.texels, 1.0);
        }
        let reach = &pyramid.reach(&Region::whole(size, size));
        let base = pyramid.convolved(base.as_flattened(), reach);
        (0..size).flat_map(|row| pyramid.row(&base, row, &all, &mut lines).to_vec()).collect()
    }

    #[test]
    fn it_is_the_gaussian_that_is_not_cut_off() {
        for (size, sigma, levels) in [(96, 3.9, 0), (96, 4.1, 1), (96, 7.0, 1), (128, 8.2, 2)] {
            let pyramid = Pyramid::new(size, sigma);
            assert_eq!(pyramid.levels(), levels);
            let texture = noise(size, 0.0);
            let blurred = pyramid.apply(&texture);
            let weight = |d: usize| (-0.5 * (d as f64 / f64::from(sigma)).powi(2)).exp();
            let axis = |at: usize| -> Vec<f64> {
                let weights: Vec<_> = (0..size).map(|other| weight(at.abs_diff(other))).collect();
                let sum: f64 = weights.iter().sum();
                weights.into_iter().map(|weight| weight / sum).collect()
            };
            let axes: Vec<_> = (0..size).map(axis).collect();
            let (mut error, mut square) = (0.0, 0.0);
            for (y, x) in (0..size).step_by(5).flat_map(|y| (0..size).step_by(7).map(move |x| (y, x))) {
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
            assert!(blurred.as_flattened().iter().all(|v| (v - 0.7).abs() < 1e-6), "{size}");
        }
        assert_eq!(Pyramid::new(5, 0.0).apply(&noise(5, 0.0)), noise(5, 0.0));
    }

    #[test]
    fn the_adjoint_is_the_transpose() {
        for (size, sigma) in [(7, 1.3), (42, 4.1), (64, 8.5)] {
            let pyramid = Pyramid::new(size, sigma);
            let (x, y) = (noise(size, 0.0), noise(size, 100.0));
            let (left, right) = (dot(&pyramid.apply(&x), &y), dot(&x, &adjoint(&pyramid, &y)));
            assert!((left - right).abs() < 1e-5 * size as f64, "{size}: {left} {right}");
        }
    }

    /// Of a part of the texture, what the whole gives there.
    #[test]
    fn what_is_reached_is_enough() {
        let (size, part) = (128, 40..75);
        for sigma in [2.0, 4.1, 8.5] {
            let pyramid = Pyramid::new(size, sigma);
            let texture = noise(size, 0.0);
            let blurred = pyramid.apply(&texture);
            let mut rows = vec![0..0; size];
            rows[30..50].fill(part.clone());
            let reach = &pyramid.reach(&Region(rows));
            let base = pyramid.halved(&texture, reach);
            let mut lines = Lines::new(size);
            for row in 30..50 {
                let got = pyramid.blurred_row(&base, row, &part, &mut lines);
                assert_eq!(got, &blurred[row * size..][part.clone()], "{sigma}");
            }
        }
    }
}
