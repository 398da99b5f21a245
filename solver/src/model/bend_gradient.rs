//! Gradients by the textures that bend the normals, from those by what samples see of them.
//!
//! Strips of rows of samples are worked on downwards. Two rows of texels are in the cache at any time: one that
//! no sample is left of is finished, and written once; what it has for the blur goes to the blur's base.

use std::ops::Range;

use rayon::prelude::*;

use super::bend::{Bent, gather, together};
use super::planes::{BLOCK, Row};
use super::pyramid::{CHANNELS, Lines, Pyramid, Sums, Texel};
use super::strips::add_parts;
use super::taps::Taps;
use crate::parallel::from_parts;
use crate::region::Region;
use crate::simd::widened;

/// Gradients by d and the specular albedo, zero where samples see nothing; and by the base of the blur.
#[derive(Clone, Debug, PartialEq)]
pub struct BendGradient {
    /// By texel.
    pub own: Vec<Texel>,
    /// By texel of the base ([`Pyramid::base`]), four values each.
    pub base: Vec<f32>,
}

impl BendGradient {
    /// Zeros.
    pub fn new(blur: &Pyramid) -> Self {
        Self { own: vec![[0.0; CHANNELS]; blur.size() * blur.size()], base: vec![] }
    }

    /// Made anew by `work` on strips, of which blocks go to the one that their first sample is in; and its
    /// results, in order. Outside of the samples' `region` texels stay what they are.
    pub fn fill<S, T: Send>(
        &mut self,
        (taps, blur, region): (&Taps, &Pyramid, &Region),
        scratch: impl Fn() -> S + Send + Sync,
        work: impl Fn(&mut S, &mut RowSums) -> T + Sync,
    ) -> Vec<T> {
        let (size, rows) = (taps.size(), taps.strip());
        let scratch = || {
            let ring = [(); 2].map(|()| vec![Bent::default(); size]);
            (scratch(), ring, Lines::new(size))
        };
        type Scratch<S> = (S, [Vec<Bent>; 2], Lines);
        let strip = |(scratch, ring, lines): &mut Scratch<S>, (number, own): (usize, &mut [Texel])| {
            let first = number * rows;
            let samples = taps.blocks_of(first..first + own.len() / size);
            let at = taps.cells().get(samples.start).map_or(first, |cell| *cell as usize / size);
            let mut sums = RowSums {
                taps,
                blur,
                region,
                samples,
                first,
                own,
                written: first,
                below: vec![],
                base: Sums::new(blur, first),
                at,
                ring,
                lines,
            };
            let result = work(scratch, &mut sums);
            sums.finish();
            let RowSums { below, base, own, .. } = sums;
            let below = (first * size + own.len(), below);
            (below, (base.first * blur.base(), base.texels), result)
        };
        let strips = self.own.par_chunks_mut(rows * size).enumerate();
        let parts: Vec<_> = strips.map_init(scratch, strip).collect();
        let (mut below, mut base, mut results) = (vec![], vec![], vec![]);
        for (rows, sums, result) in parts {
            below.push(rows);
            base.push(sums);
            results.push(result);
        }
        let length = rows * size * CHANNELS;
        let add = |parts: &[(usize, Vec<Texel>)], number: usize, texels: &mut [f32]| {
            let parts = parts.iter().map(|(first, part)| (CHANNELS * first, part.as_flattened()));
            add_parts(number * length, texels, parts);
        };
        let strips = self.own.as_flattened_mut().par_chunks_mut(length).enumerate();
        strips.for_each(|(number, texels)| add(&below, number, texels));
        let base_of = |number: usize, texels: &mut [f32]| add(&base, number, texels);
        self.base = from_parts(CHANNELS * blur.base() * blur.base(), length, base_of).0;
        results
    }
}

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
    base: Sums,
    /// The row that is at hand, and the next; zero where there is nothing yet.
    at: usize,
    ring: &'a mut [Vec<Bent>; 2],
    lines: &'a mut Lines,
}

impl RowSums<'_> {
    /// Adds a block's gradients by what its samples see, 7 rows as of
    /// [`BentTextures::sample`](super::bend::BentTextures::sample).
    pub fn add(&mut self, block: usize, rows: &[Row]) {
        let mut values = [Bent::default(); BLOCK];
        together(rows, &mut values);
        let size = self.taps.size();
        let first = block * BLOCK;
        let end = (first + BLOCK).min(self.taps.cells().len());
        let mut at = first;
        while at < end {
            let row = self.taps.cells()[at] as usize / size;
            self.advance(row);
            let here = at..self.taps.samples_in(row..row + 1).end.min(end);
            at = here.end;
            let [even, odd] = &mut *self.ring;
            let [upper, lower] = if row.is_multiple_of(2) { [even, odd] } else { [odd, even] };
            gather(upper, lower, row * size, self.taps, here.clone(), &values[here.start - first..]);
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
        let bent = &mut self.ring[row % 2][columns.clone()];
        self.base.add(self.blur, row, &columns, self.lines, |blurred| take(bent, out, blurred));
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
