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

use rayon::prelude::*;

use super::strips::add_parts;
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
/// Rows of a texture that one task works through. Sums depend on it where textures are halved.
pub const ROWS: usize = 16;

/// Blurs square textures of four channels; near the border the weights that remain are scaled to sum to one.
///
/// The blur is N K: K is symmetric, halves once ([`Sums`] of rows), convolves the *base*
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
    pub fn base(&self) -> usize {
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
            let mut out = vec![[0.0; CHANNELS]; self.base() * self.base()];
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

/// Rows of a texture that is half as large as another (or as large), to which rows of the other one are added,
/// downwards.
pub struct Sums<'a> {
    width: usize,
    halves: bool,
    /// The first row's number.
    first: usize,
    own: &'a mut [Texel],
    /// The row above these, and those below.
    edges: [Vec<Texel>; 2],
}

impl<'a> Sums<'a> {
    /// For rows from `row` on (an even one, if they are halved) of textures of side `size`, into rows so wide.
    pub fn new(size: usize, width: usize, row: usize, own: &'a mut [Texel]) -> Self {
        own.fill([0.0; CHANNELS]);
        let halves = width < size;
        let first = if halves { row / 2 } else { row };
        Self { width, halves, first, own, edges: [vec![], vec![]] }
    }

    /// Adds columns of a row, which `fill` writes.
    pub fn add(
        &mut self,
        row: usize,
        columns: &Range<usize>,
        Lines { fine, coarse, padded }: &mut Lines,
        fill: impl FnOnce(&mut [Texel]),
    ) {
        if columns.is_empty() {
            return;
        }
        let wide = even(columns, fine.len());
        let padded = &mut padded[..wide.len() + 2 * PAD];
        let first = PAD + columns.start - wide.start;
        padded[..first].fill([0.0; CHANNELS]);
        padded[first + columns.len()..].fill([0.0; CHANNELS]);
        let texels = &mut padded[first..first + columns.len()];
        fill(texels);
        if !self.halves {
            add(self.row(row, columns), texels, 1.0);
            return;
        }
        // Two more than half of them.
        let (first, count) = (wide.start / 2, wide.len() / 2 + 2);
        halve_row(&mut coarse[..count], padded);
        if first == 0 {
            fold(coarse, 0, 1);
        }
        if first + count - 1 > self.width {
            fold(coarse, count - 1, count - 2);
        }
        let inside = first.saturating_sub(1)..(first + count - 1).min(self.width);
        let coarse = &coarse[inside.start + 1 - first..][..inside.len()];
        for (row, weight) in neighbours(row, self.width).into_iter().zip([NEAR, FAR]) {
            add(self.row(row, &inside), coarse, weight);
        }
    }

    fn row(&mut self, row: usize, columns: &Range<usize>) -> &mut [Texel] {
        let Self { width, first, own, edges: [above, below], .. } = self;
        let end = *first + own.len() / *width;
        let (rows, at) = match row {
            _ if row < *first => (above, 0),
            _ if row < end => return &mut own[(row - *first) * *width..][columns.clone()],
            _ => (below, (row - end) * *width),
        };
        rows.resize(rows.len().max(at + *width), [0.0; CHANNELS]);
        &mut rows[at..][columns.clone()]
    }

    /// What belongs to others, each with the number of its first texel.
    pub fn edges(self) -> [Edge; 2] {
        let [above, below] = self.edges;
        let start = self.first * self.width;
        [(start - above.len(), above), (start + self.own.len(), below)]
    }
}

/// What lies beyond the border belongs to the last texel inside.
fn fold(texels: &mut [Texel], outer: usize, inner: usize) {
    let beyond = texels[outer];
    texels[inner].iter_mut().zip(beyond).for_each(|(value, beyond)| *value += beyond);
}

/// Texels to be added, and the number of the first.
pub type Edge = (usize, Vec<Texel>);

/// Adds them, in their order.
pub fn add_edges(texels: &mut [Texel], edges: &[Edge]) {
    let values = texels.as_flattened_mut().par_chunks_mut(EDGE).enumerate();
    values.for_each(|(number, values)| {
        let parts = edges.iter().map(|(first, part)| (CHANNELS * first, part.as_flattened()));
        add_parts(number * EDGE, values, parts);
    });
}

/// Values that one task adds to.
const EDGE: usize = 1 << 16;

/// Zeros on both sides of what is halved.
const PAD: usize = 3;

/// The coarse row that a row lies in, and the nearest other one, of `count`; beyond the border, the last one.
fn neighbours(row: usize, count: usize) -> [usize; 2] {
    let near = row / 2;
    [near, if row.is_multiple_of(2) { near.saturating_sub(1) } else { (near + 1).min(count - 1) }]
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

/// The transpose of [`double`], of a region of the finer texture.
fn halve(texture: &[Texel], size: usize, region: &Region, out: &mut [Texel]) {
    let half = size / 2;
    let task = |lines: &mut Lines, (number, own): (usize, &mut [Texel])| {
        let first = number * ROWS;
        let mut sums = Sums::new(size, half, first, own);
        for row in first..(first + ROWS).min(size) {
            let columns = &region.0[row];
            let texels = &texture[row * size..][columns.clone()];
            sums.add(row, columns, lines, |out| out.copy_from_slice(texels));
        }
        sums.edges()
    };
    let tasks = out.par_chunks_mut(ROWS / 2 * half).enumerate();
    let edges: Vec<_> = tasks.map_init(|| Lines::new(size), task).collect();
    add_edges(out, edges.as_flattened());
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
    let of = |row: usize| &texels(coarse)[row * half..][inside.clone()];
    let [near, far] = neighbours(row, half).map(of);
    between(&mut line[inside.start + 1 - first..][..inside.len()], near, far);
    if first == 0 {
        line[0] = line[1];
    }
    if first + count - 1 > half {
        line[count - 1] = line[count - 2];
    }
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
    /// Between a near row and a far one.
    fn between(out: &mut [Texel], near: &[Texel], far: &[Texel]) {
        let texels = near.as_flattened().iter().zip(far.as_flattened());
        for (out, (near, far)) in out.as_flattened_mut().iter_mut().zip(texels) {
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
        for (value, column) in texels.as_flattened_mut().iter_mut().zip(columns) {
            *value *= row * column;
        }
    }
}

#[cfg(test)]
mod tests {
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
        let width = pyramid.base();
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
