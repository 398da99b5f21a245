//! Textures of four channels at half their side and back, row by row; the steps of a [`super::pyramid`].
//!
//! A coarse texel is the weighted mean of 4 x 4 fine ones (1, 3, 3, 1), the transpose of bilinear interpolation.

use std::ops::Range;

use rayon::prelude::*;

use super::pairs::{double_row, halve_row};
use super::strips::add_parts;
use crate::parallel::from_parts;
use crate::region::Region;
use crate::simd::widened;

/// Values of a texel.
pub const CHANNELS: usize = 4;
/// A texel.
pub type Texel = [f32; CHANNELS];

/// Weights of the nearer and the further texel.
pub(super) const NEAR: f32 = 0.75;
pub(super) const FAR: f32 = 0.25;
/// Rows of a texture that one task works through. Sums depend on it where textures are halved.
pub const ROWS: usize = 16;
/// Zeros on both sides of what is halved.
const PAD: usize = 3;
/// Values of edges that one task adds.
const EDGE: usize = 1 << 16;

/// Rows of a texture and of the next coarser one that are worked on.
pub struct Lines {
    pub(super) fine: Vec<Texel>,
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

/// The coarse row that a row lies in, and the nearest other one, of `count`; beyond the border, the last one.
pub(super) fn neighbours(row: usize, count: usize) -> [usize; 2] {
    let near = row / 2;
    [near, if row.is_multiple_of(2) { near.saturating_sub(1) } else { (near + 1).min(count - 1) }]
}

/// Values as whole texels.
pub(super) fn texels(values: &[f32]) -> &[Texel] {
    values.as_chunks().0
}

/// Columns with what completes pairs.
pub(super) fn even(columns: &Range<usize>, size: usize) -> Range<usize> {
    columns.start / 2 * 2..columns.end.next_multiple_of(2).min(size)
}

/// What has a part in a region of the next finer texture, or depends on it.
pub(super) fn halved_region(region: &Region, size: usize) -> Region {
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
pub(super) fn halve(texture: &[Texel], size: usize, region: &Region, out: &mut [Texel]) {
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
pub(super) fn double(coarse: &[f32], size: usize, region: &Region) -> Vec<f32> {
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
pub(super) fn doubled_row(
    coarse: &[f32],
    size: usize,
    row: usize,
    columns: &Range<usize>,
    lines: &mut Lines,
) {
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
