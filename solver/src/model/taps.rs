//! Bilinear taps, computed once: textures are sampled per pixel, gradients are gathered per texel.
//!
//! Samples are sorted by texel. The gradient of a strip of texture rows then comes from one contiguous
//! run of samples, read in a fixed order: no atomics, and the same sums for any number of threads; the
//! sums of a cell stay in registers while its samples pass. A sample's place is 12 bytes.

use std::ops::Range;

use glam::Vec2;
use rayon::prelude::*;

use super::planes::{BLOCK, Planes, Row};
use crate::simd::widened;

/// A gather is cut into about this many strips, whatever the number of threads.
const STRIPS: usize = 64;
/// Rows of a strip, at least.
const LEAST_ROWS: usize = 4;

/// The four texels around each sample, with bilinear weights; outside the texture it is clamped.
#[derive(Clone, Debug)]
pub struct Taps {
    size: usize,
    /// Upper left texel of each sample, row-major, ascending.
    cell: Vec<u32>,
    /// Position between that texel's centre and the next ones', right and down, 0 to 1.
    fraction: Vec<[f32; 2]>,
    /// First sample of every row of cells, and the number of samples.
    row_start: Vec<usize>,
}

impl Taps {
    /// Sorts samples by texel: returns the taps, and for each of them which `uvs` it came from.
    pub fn sorted(size: usize, uvs: &[Vec2]) -> (Self, Vec<usize>) {
        let place = |uv: &Vec2| {
            let clamp = |x: f32| (x * size as f32 - 0.5).clamp(0.0, (size - 1) as f32);
            let (x, y) = (clamp(uv.x), clamp(1.0 - uv.y));
            let (x0, y0) = ((x as usize).min(size - 2), (y as usize).min(size - 2));
            ((y0 * size + x0) as u32, [x - x0 as f32, y - y0 as f32])
        };
        let placed: Vec<_> = uvs.par_iter().map(place).collect();
        let mut order: Vec<usize> = (0..uvs.len()).collect();
        order.par_sort_by_key(|sample| (placed[*sample].0, *sample));
        let cell: Vec<u32> = order.iter().map(|sample| placed[*sample].0).collect();
        let fraction = order.iter().map(|sample| placed[*sample].1).collect();
        let row_start = (0..=size)
            .map(|row| cell.partition_point(|cell| (*cell as usize) < row * size))
            .collect();
        (Self { size, cell, fraction, row_start }, order)
    }

    /// Texture side, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Samples a texture of `C` interleaved channels.
    pub fn sample<const C: usize>(&self, texture: &[f32]) -> Planes {
        let (texels, _) = texture.as_chunks::<C>();
        Planes::from_blocks(C, self.cell.len(), |block, rows| {
            let first = block * BLOCK;
            let last = (first + BLOCK).min(self.cell.len());
            let (cell, fraction) = (&self.cell[first..last], &self.fraction[first..last]);
            sample_block::<C>(cell, fraction, texels, self.size, rows);
        })
    }

    /// The adjoint of [`Taps::sample`]: sums the samples' gradients (rows `first..first + C`) into
    /// the texels they were interpolated from.
    pub fn gather<const C: usize>(&self, gradient: &Planes, first: usize) -> Vec<f32> {
        let cell = |_: usize, run: Range<usize>, _: &mut f64| {
            let mut corners = Corners::default();
            run.for_each(|i| corners.add(self.fraction[i], gradient.sample::<C>(i, first)));
            corners
        };
        self.by_cell(cell).0
    }

    /// [`Taps::sample`] and [`Taps::gather`] in one pass, without the planes between them: `value`
    /// makes of a sample's number and its texture values a gradient and a term of the loss. Returns
    /// the texels' gradients and the sum of the terms.
    pub fn exchange<const C: usize, const D: usize>(
        &self,
        texture: &[f32],
        value: impl Fn(usize, [f32; C]) -> ([f32; D], f64) + Sync,
    ) -> (Vec<f32>, f64) {
        let (texels, _) = texture.as_chunks::<C>();
        self.by_cell(|cell, run, loss| {
            let mut corners = Corners::default();
            let texels = surrounding(texels, self.size, cell);
            for i in run {
                let (gradient, term) = value(i, blend(texels, self.fraction[i]));
                corners.add(self.fraction[i], gradient);
                *loss += term;
            }
            corners
        })
    }

    /// What `cell` adds to the four texels of every cell, given its number and its samples. Each
    /// task has a strip of rows, whose samples are contiguous; the row below the strip's last, which
    /// the next strip begins with, is added afterwards.
    fn by_cell<const D: usize>(
        &self,
        cell: impl Fn(usize, Range<usize>, &mut f64) -> Corners<D> + Sync,
    ) -> (Vec<f32>, f64) {
        let (size, line) = (self.size, self.size * D);
        let strip = size.div_ceil(STRIPS).max(LEAST_ROWS);
        let mut texels = vec![0.0; size * line];
        let task = |(strip_number, out): (usize, &mut [f32])| {
            let mut below = vec![0.0; line];
            let mut sum = 0.0;
            let first = strip_number * strip;
            let rows = out.len() / line;
            for row in 0..rows {
                let (here, rest) = out[row * line..].split_at_mut(line);
                let next = if row + 1 < rows { &mut rest[..line] } else { &mut below[..] };
                let (here, next) = (here.as_chunks_mut::<D>().0, next.as_chunks_mut::<D>().0);
                let mut at = self.row_start[first + row];
                let end = self.row_start[first + row + 1];
                while at < end {
                    let number = self.cell[at];
                    let run = self.cell[at..end].iter().take_while(|cell| **cell == number).count();
                    let Corners([a, b, c, d]) = cell(number as usize, at..at + run, &mut sum);
                    let x = number as usize - (first + row) * size;
                    add(&mut here[x], a);
                    add(&mut here[x + 1], b);
                    add(&mut next[x], c);
                    add(&mut next[x + 1], d);
                    at += run;
                }
            }
            (below, sum)
        };
        let parts: Vec<(Vec<f32>, f64)> =
            texels.par_chunks_mut(strip * line).enumerate().map(task).collect();
        let later = texels.chunks_mut(strip * line).skip(1);
        for (out, (below, _)) in later.zip(&parts) {
            out.iter_mut().zip(below).for_each(|(sum, value)| *sum += value);
        }
        (texels, parts.iter().map(|(_, sum)| sum).sum())
    }
}

/// Sums at the four texels of a cell: upper left, upper right, lower left, lower right.
struct Corners<const D: usize>([[f32; D]; 4]);

impl<const D: usize> Default for Corners<D> {
    fn default() -> Self {
        Self([[0.0; D]; 4])
    }
}

impl<const D: usize> Corners<D> {
    #[inline(always)]
    fn add(&mut self, [fx, fy]: [f32; 2], gradient: [f32; D]) {
        let [a, b, c, d] = &mut self.0;
        for (channel, g) in gradient.into_iter().enumerate() {
            let (upper, lower) = ((1.0 - fy) * g, fy * g);
            a[channel] += (1.0 - fx) * upper;
            b[channel] += fx * upper;
            c[channel] += (1.0 - fx) * lower;
            d[channel] += fx * lower;
        }
    }
}

#[inline(always)]
fn add<const D: usize>(sum: &mut [f32; D], value: [f32; D]) {
    sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += value);
}

/// The texels of a cell, in the order of [`Corners`].
#[inline(always)]
fn surrounding<const C: usize>(texels: &[[f32; C]], size: usize, cell: usize) -> [&[f32; C]; 4] {
    let (upper, lower) = (&texels[cell..cell + 2], &texels[cell + size..cell + size + 2]);
    [&upper[0], &upper[1], &lower[0], &lower[1]]
}

#[inline(always)]
fn blend<const C: usize>([a, b, c, d]: [&[f32; C]; 4], [fx, fy]: [f32; 2]) -> [f32; C] {
    std::array::from_fn(|k| {
        let (upper, lower) = (a[k] + fx * (b[k] - a[k]), c[k] + fx * (d[k] - c[k]));
        upper + fy * (lower - upper)
    })
}

widened! {
    fn sample_block<const C: usize>(
        cell: &[u32],
        fraction: &[[f32; 2]],
        texels: &[[f32; C]],
        size: usize,
        rows: &mut [Row],
    ) {
        assert!(cell.len() <= BLOCK && rows.len() == C);
        for (lane, (cell, fraction)) in cell.iter().zip(fraction).enumerate() {
            let value = blend(surrounding(texels, size, *cell as usize), *fraction);
            rows.iter_mut().zip(value).for_each(|(row, value)| row.0[lane] = value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: usize) -> Vec<Vec2> {
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs().fract();
        (0..count).map(|i| Vec2::new(noise(i, 12.9898), noise(i, 78.233))).collect()
    }

    #[test]
    fn a_linear_texture_is_reproduced_and_clamped() {
        let size = 8;
        let ramp: Vec<f32> = (0..64).flat_map(|t| [(t % 8) as f32, (t / 8) as f32]).collect();
        let uvs = points(500);
        let (taps, order) = Taps::sorted(size, &uvs);
        let values = taps.sample::<2>(&ramp);
        for (i, source) in order.iter().enumerate() {
            let uv = uvs[*source];
            let expected = [uv.x, 1.0 - uv.y].map(|t| (t * 8.0 - 0.5).clamp(0.0, 7.0));
            for (c, expected) in expected.into_iter().enumerate() {
                assert!((values.get(c, i) - expected).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn gather_is_the_transpose_of_sample() {
        let (taps, _) = Taps::sorted(16, &points(1000));
        let texture: Vec<f32> = (0..16 * 16 * 3).map(|i| (i as f32 * 0.37).sin()).collect();
        let gradient = Planes::from_fn(1000, |i| [1.0, 2.0, 3.0].map(|k| (i as f32 * k).cos()));
        let sampled = taps.sample::<3>(&texture);
        let gathered = taps.gather::<3>(&gradient, 0);
        let left: f64 = (0..1000)
            .flat_map(|i| (0..3).map(move |c| (c, i)))
            .map(|(c, i)| f64::from(sampled.get(c, i)) * f64::from(gradient.get(c, i)))
            .sum();
        let right: f64 =
            gathered.iter().zip(&texture).map(|(g, t)| f64::from(*g) * f64::from(*t)).sum();
        assert!((left - right).abs() < 1e-3 * left.abs().max(1.0), "{left} {right}");
    }

    #[test]
    fn an_exchange_is_a_sample_and_a_gather() {
        // More rows than a strip has.
        let (taps, _) = Taps::sorted(300, &points(5000));
        let texture: Vec<f32> = (0..300 * 300 * 2).map(|i| (i as f32 * 0.37).sin()).collect();
        let swap = |i: usize, [a, b]: [f32; 2]| [b, a * i as f32, 1.0];
        let sampled = taps.sample::<2>(&texture);
        let planes = Planes::from_fn(5000, |i| swap(i, sampled.sample(i, 0)));
        let (gathered, sum) = taps.exchange(&texture, |i, v| (swap(i, v), f64::from(v[0])));
        assert_eq!(gathered, taps.gather::<3>(&planes, 0));
        let expected: f64 = (0..5000).map(|i| f64::from(sampled.get(0, i))).sum();
        assert!((sum - expected).abs() < 1e-9, "{sum} {expected}");
    }
}
