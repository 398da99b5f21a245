//! Gradients by the textures that bend the normals, from those by what samples see of them.
//!
//! Strips of rows of samples are worked on downwards. Two rows of texels are in the cache at any time: one that
//! no sample is left of is finished, and written once; what it has for the blur goes to the blur's base.

use std::ops::Range;

use rayon::prelude::*;

use super::bend::{Bent, gather, together};
use super::halving::{CHANNELS, Lines, Sums, Texel, add_edges};
use super::planes::{BLOCK, Row};
use super::pyramid::Pyramid;
use super::taps::Taps;
use crate::region::Region;
use crate::simd::widened;

/// Gradients by d and the specular albedo, zero where samples see nothing; and by the base of the blur.
#[derive(Clone, Debug, PartialEq)]
pub struct BendGradient {
    /// By texel.
    pub own: Vec<Texel>,
    /// By texel of the base ([`Pyramid::base_size`]).
    pub base: Vec<Texel>,
}

impl BendGradient {
    /// Zeros.
    pub fn new(blur: &Pyramid) -> Self {
        let [own, base] =
            [blur.size(), blur.base_size()].map(|side| vec![[0.0; CHANNELS]; side * side]);
        Self { own, base }
    }

    /// Made anew by `work` on strips, of which blocks go to the one that their first sample is in; and its
    /// results, in order. Outside of the samples' `region` texels stay what they are.
    pub fn fill<S, T: Send>(
        &mut self,
        (taps, blur, region): (&Taps, &Pyramid, &Region),
        scratch: impl Fn() -> S + Send + Sync,
        work: impl Fn(&mut S, &mut RowSums) -> T + Sync,
    ) -> Vec<T> {
        let (size, width, rows) = (taps.size(), blur.base_size(), taps.strip().next_multiple_of(2));
        let scratch = || (scratch(), Buffers::new(size));
        let strip = |(scratch, buffers): &mut (S, Buffers),
                     (number, (own, base)): (usize, Rows)| {
            let first = number * rows;
            let samples = taps.blocks_of(first..first + own.len() / size);
            let at = taps.cells().get(samples.start).map_or(first, |cell| *cell as usize / size);
            let base = Sums::new(size, width, first, base);
            let below = vec![];
            let mut sums = RowSums {
                taps,
                blur,
                region,
                samples,
                first,
                own,
                written: first,
                below,
                base,
                at,
                buffers,
            };
            let result = work(scratch, &mut sums);
            sums.finish();
            let RowSums { below, base, own, .. } = sums;
            ((first * size + own.len(), below), (base.edges(), result))
        };
        let own = self.own.par_chunks_mut(rows * size);
        let strips = own.zip(self.base.par_chunks_mut(rows * width / size * width));
        let parts: Vec<_> = strips.enumerate().map_init(scratch, strip).collect();
        let (below, parts): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        let (base, results): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        add_edges(&mut self.own, &below);
        add_edges(&mut self.base, base.as_flattened());
        results
    }
}

/// Rows of the texture, and of the base.
type Rows<'a> = (&'a mut [Texel], &'a mut [Texel]);

/// What samples add to the rows of a strip, downwards.
pub struct RowSums<'a> {
    /// The samples, in whole blocks.
    pub samples: Range<usize>,
    taps: &'a Taps,
    blur: &'a Pyramid,
    region: &'a Region,
    /// Rows of the strip, the first one's number, and what is next to be written.
    own: &'a mut [Texel],
    first: usize,
    written: usize,
    /// Rows below the strip.
    below: Vec<Texel>,
    base: Sums<'a>,
    /// The row that is at hand.
    at: usize,
    buffers: &'a mut Buffers,
}

/// What goes down with a task from strip to strip.
struct Buffers {
    /// An even row and an odd one, zero where there is nothing yet.
    ring: [Vec<Bent>; 2],
    lines: Lines,
    /// Of a block's samples.
    values: Vec<Bent>,
}

impl Buffers {
    fn new(size: usize) -> Self {
        let [even, odd, values] = [size, size, BLOCK].map(|length| vec![Bent::default(); length]);
        Self { ring: [even, odd], lines: Lines::new(size), values }
    }
}

impl RowSums<'_> {
    /// Adds a block's gradients by what its samples see, 7 rows as of
    /// [`BentTextures::sample`](super::bend::BentTextures::sample).
    pub fn add(&mut self, block: usize, rows: &[Row]) {
        together(rows, &mut self.buffers.values);
        let size = self.taps.size();
        let first = block * BLOCK;
        let end = (first + BLOCK).min(self.taps.cells().len());
        let mut at = first;
        while at < end {
            let row = self.taps.cells()[at] as usize / size;
            self.advance(row);
            let here = at..self.taps.samples_in(row..row + 1).end.min(end);
            at = here.end;
            let Buffers { ring: [even, odd], values, .. } = &mut *self.buffers;
            let [upper, lower] = if row.is_multiple_of(2) { [even, odd] } else { [odd, even] };
            gather(
                upper,
                lower,
                row * size,
                self.taps,
                here.clone(),
                &values[here.start - first..],
            );
        }
    }

    /// Goes down to a row of cells.
    fn advance(&mut self, row: usize) {
        if self.at == row {
            return;
        }
        for row in self.at..row.min(self.at + 2) {
            self.write(row);
        }
        self.at = row;
    }

    /// Writes a finished row, and leaves zeros in its place.
    fn write(&mut self, row: usize) {
        let columns = self.region.0.get(row).cloned().unwrap_or_default();
        if columns.is_empty() {
            return;
        }
        let size = self.taps.size();
        let end = self.first + self.own.len() / size;
        let out = if row < end {
            self.clear(row);
            self.written = row + 1;
            &mut self.own[(row - self.first) * size..][columns.clone()]
        } else {
            let start = (row - end) * size;
            self.below.resize(self.below.len().max(start + size), [0.0; CHANNELS]);
            &mut self.below[start..][columns.clone()]
        };
        let Buffers { ring, lines, .. } = &mut *self.buffers;
        let bent = &mut ring[row % 2][columns.clone()];
        let fill = |blurred: &mut [Texel]| {
            take(bent, out, blurred);
            self.blur.scale(row, &columns, blurred);
        };
        self.base.add(row, &columns, lines, fill);
    }

    /// Zeros to the rows that are passed over, up to one.
    fn clear(&mut self, row: usize) {
        let size = self.taps.size();
        for row in self.written..row {
            let columns = self.region.0[row].clone();
            self.own[(row - self.first) * size..][columns].fill([0.0; CHANNELS]);
        }
    }

    fn finish(&mut self) {
        if !self.samples.is_empty() {
            self.advance(self.at + 2);
        }
        self.clear(self.first + self.own.len() / self.taps.size());
    }
}

widened! {
    /// Parts a row's gradients.
    fn take(row: &mut [Bent], own: &mut [Texel], blurred: &mut [Texel]) {
        for (bent, (own, blurred)) in row.iter_mut().zip(own.iter_mut().zip(blurred)) {
            own.copy_from_slice(&bent[..CHANNELS]);
            blurred.copy_from_slice(&bent[CHANNELS..]);
            *bent = Bent::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::super::bend::ROWS;
    use super::super::planes::Planes;
    use super::super::strips::blocks;
    use super::*;

    /// Of samples so sparse that a block reaches over several strips, and only in the upper half.
    #[test]
    fn every_block_is_worked_on_once_and_reaches_all_its_texels() {
        let (size, count) = (300, 1000);
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs();
        let uvs: Vec<_> = (0..count)
            .map(|i| Vec2::new(noise(i, 12.9898), 0.5 + 0.5 * noise(i, 78.233)))
            .collect();
        let taps = Taps::sorted(size, &uvs).0;
        let planes = Planes::from_fn(count, |i| {
            std::array::from_fn::<_, ROWS, _>(|row| noise(i + 10 * row, 0.7))
        });
        let work = |(): &mut (), sums: &mut RowSums| {
            let blocks = blocks(sums.samples.clone());
            blocks.map(|(block, _)| sums.add(block, planes.block(block))).count()
        };
        let (blur, region) = (Pyramid::new(size, 0.0), taps.region());
        let mut gradient = BendGradient::new(&blur);
        // What an earlier step has left.
        for (row, columns) in gradient.own.chunks_mut(size).zip(&region.0) {
            row[columns.clone()].fill([1.0; CHANNELS]);
        }
        let counts = gradient.fill((&taps, &blur, &region), || (), work);
        assert_eq!(counts.iter().sum::<usize>(), count.div_ceil(BLOCK));
        let expected = taps.gather::<ROWS>(&planes, 0);
        for (at, expected) in expected.as_chunks::<ROWS>().0.iter().enumerate() {
            let ([a, b, c, g], [d, e, f, _]) = (gradient.own[at], gradient.base[at]);
            for (sum, expected) in [a, b, c, d, e, f, g].into_iter().zip(expected) {
                assert!((sum - expected).abs() < 1e-5, "{at}: {sum} {expected}");
            }
        }
    }
}
