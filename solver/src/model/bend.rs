//! The textures that bend the normals, and the specular albedo, as samples see them.

use std::ops::Range;

use glam::Vec4;

use super::deviation::Deviation;
use super::halving::{CHANNELS, Lines, Texel};
use super::planes::{BLOCK, CHUNK_BLOCKS, Planes, Row, first_rows, first_rows_mut};
use super::taps::Taps;
use super::texels::turned;
use crate::region::Region;
use crate::simd::widened;

/// What a sample sees of a texel: d (3 values), the specular albedo, blur(d) (3), and one that fills up two
/// vectors; or gradients by them.
pub type Bent = [f32; BENT];
const BENT: usize = 2 * CHANNELS;
/// Rows at a sample: d, blur(d), specular albedo.
pub const ROWS: usize = BENT - 1;

/// The textures d and blur(d), 3 channels each.
pub struct Bend {
    /// For the specular normal.
    pub sharp: Vec<f32>,
    /// For the diffuse normal.
    pub blurred: Vec<f32>,
}

/// The deviation d ([`Deviation::seen`]), its blur and the specular albedo.
#[derive(Clone, Copy)]
pub struct BentTextures<'a> {
    /// Blurs d.
    pub deviation: &'a Deviation,
    /// d, and the specular albedo.
    pub texels: &'a [Texel],
    /// The base of the blur ([`Deviation::base`]).
    pub base: &'a [f32],
    /// The texels that samples see ([`Taps::region`]).
    pub region: &'a Region,
}

impl<'a> BentTextures<'a> {
    /// d, blur(d) and the specular albedo at every sample (7 rows).
    pub fn sample(&self, taps: &Taps) -> Planes {
        let task = |(): &mut (), first: usize, out: &mut [Row]| {
            let mut rows = self.rows();
            for (block, out) in out.chunks_exact_mut(ROWS).enumerate() {
                rows.sample(taps, first + block, out);
            }
        };
        Planes::from_tasks(ROWS, taps.cells().len(), CHUNK_BLOCKS, || (), task).0
    }

    /// The same block by block, best downwards.
    pub fn rows(&self) -> TexelRows<'a> {
        let size = self.deviation.size();
        let rows = [(); 2].map(|()| vec![[0.0; BENT]; size]);
        let values = vec![Bent::default(); BLOCK];
        TexelRows { textures: *self, rows, made: [None; 2], lines: Lines::new(size), values }
    }
}

/// Two rows of texels.
pub struct TexelRows<'a> {
    textures: BentTextures<'a>,
    /// An even one and an odd one; and their numbers.
    rows: [Vec<Bent>; 2],
    made: [Option<usize>; 2],
    lines: Lines,
    /// Of a block's samples, and whatever the last one's left where there are fewer.
    values: Vec<Bent>,
}

impl TexelRows<'_> {
    /// What the samples of a block see.
    pub fn sample(&mut self, taps: &Taps, block: usize, out: &mut [Row]) {
        let first = block * BLOCK;
        let (end, size) = ((first + BLOCK).min(taps.cells().len()), taps.size());
        let mut at = first;
        while at < end {
            let row = taps.cells()[at] as usize / size;
            let here = at..taps.samples_in(row..row + 1).end.min(end);
            (row..row + 2).for_each(|row| self.make(row));
            at = here.end;
            let values = &mut self.values[here.start - first..here.end - first];
            let [upper, lower] = [row, row + 1].map(|row| &*self.rows[row % 2]);
            interpolate(upper, lower, row * size, taps, here, values);
        }
        apart(&self.values, first_rows_mut(out));
    }

    /// Brings a row, if it is not there.
    fn make(&mut self, row: usize) {
        let Self { textures, rows, made, lines, .. } = self;
        let BentTextures { deviation, texels, base, region } = textures;
        if made[row % 2].replace(row) != Some(row) {
            let columns = &region.0[row];
            let blurred = deviation.blur().blurred_row(base, row, columns, lines);
            let own = &texels[row * deviation.size()..][columns.clone()];
            side_by_side(&mut rows[row % 2][columns.clone()], own, blurred);
        }
    }
}

widened! {
    fn side_by_side(out: &mut [Bent], own: &[Texel], blurred: &[Texel]) {
        for (out, (own, blurred)) in out.iter_mut().zip(own.iter().zip(blurred)) {
            out[..CHANNELS].copy_from_slice(own);
            out[CHANNELS..].copy_from_slice(blurred);
        }
    }
}

/// A texel and the next one: one vector, or two or four narrower ones.
type Pair = [f32; 2 * BENT];

#[inline(always)]
fn pair(row: &[Bent], at: usize) -> Pair {
    let mut pair = [0.0; 2 * BENT];
    pair.copy_from_slice(row[at..at + 2].as_flattened());
    pair
}

widened! {
    /// What samples of a row of cells, of which the first has number `first`, see of the rows of texels on
    /// either side. (To read a cell's texels for each of its samples is faster than to find out whether they are
    /// the last one's, which no processor foresees.)
    fn interpolate(
        upper: &[Bent],
        lower: &[Bent],
        first: usize,
        taps: &Taps,
        samples: Range<usize>,
        values: &mut [Bent],
    ) {
        let places = taps.cells()[samples.clone()].iter().zip(&taps.fractions()[samples]);
        for (value, (cell, [fx, fy])) in values.iter_mut().zip(places) {
            let at = *cell as usize - first;
            let (mut both, lower) = (pair(upper, at), pair(lower, at));
            for lane in 0..2 * BENT {
                both[lane] += fy * (lower[lane] - both[lane]);
            }
            for lane in 0..BENT {
                value[lane] = both[lane] + fx * (both[BENT + lane] - both[lane]);
            }
        }
    }
}

widened! {
    /// The adjoint of [`interpolate`]: adds what samples have to the rows on either side. The sums of a cell
    /// stay in registers while its samples pass.
    pub(super) fn gather(
        upper: &mut [Bent],
        lower: &mut [Bent],
        first: usize,
        taps: &Taps,
        samples: Range<usize>,
        values: &[Bent],
    ) {
        let (cells, fractions) = (&taps.cells()[samples.clone()], &taps.fractions()[samples]);
        assert!(fractions.len() == cells.len() && values.len() >= cells.len());
        let mut sample = 0;
        while sample < cells.len() {
            let cell = cells[sample];
            let (mut above, mut below) = ([0.0; 2 * BENT], [0.0; 2 * BENT]);
            while sample < cells.len() && cells[sample] == cell {
                let [fx, fy] = fractions[sample];
                let mut both = [0.0; 2 * BENT];
                for lane in 0..BENT {
                    both[lane] = (1.0 - fx) * values[sample][lane];
                    both[BENT + lane] = fx * values[sample][lane];
                }
                for lane in 0..2 * BENT {
                    above[lane] += (1.0 - fy) * both[lane];
                    below[lane] += fy * both[lane];
                }
                sample += 1;
            }
            let at = cell as usize - first;
            for (row, sums) in [(&mut *upper, above), (&mut *lower, below)] {
                for (value, sum) in row[at..at + 2].as_flattened_mut().iter_mut().zip(sums) {
                    *value += sum;
                }
            }
        }
    }
}

widened! {
    /// Samples' values as rows.
    fn apart(values: &[Bent], rows: &mut [Row; ROWS]) {
        let [a, b, c, d, e, f, g] = rows;
        for (at, values) in values.as_chunks::<CHANNELS>().0.iter().enumerate() {
            let at = CHANNELS * at;
            let own = turned(std::array::from_fn(|i| Vec4::from_slice(&values[i])));
            let blurred = turned(std::array::from_fn(|i| Vec4::from_slice(&values[i][CHANNELS..])));
            for (row, values) in [(&mut *a, own[0]), (b, own[1]), (c, own[2]), (g, own[3])] {
                row.0[at..at + CHANNELS].copy_from_slice(&values.to_array());
            }
            for (row, values) in [(&mut *d, blurred[0]), (e, blurred[1]), (f, blurred[2])] {
                row.0[at..at + CHANNELS].copy_from_slice(&values.to_array());
            }
        }
    }
}

widened! {
    /// The reverse.
    pub(super) fn together(rows: &[Row], values: &mut [Bent]) {
        let [a, b, c, d, e, f, g] = first_rows::<ROWS>(rows);
        let zero = Row::ZERO;
        for (at, values) in values.as_chunks_mut::<CHANNELS>().0.iter_mut().enumerate() {
            let at = CHANNELS * at;
            for (half, rows) in [[a, b, c, g], [d, e, f, &zero]].into_iter().enumerate() {
                let lanes = turned(rows.map(|row| Vec4::from_slice(&row.0[at..])));
                for (values, lanes) in values.iter_mut().zip(lanes) {
                    values[half * CHANNELS..][..CHANNELS].copy_from_slice(&lanes.to_array());
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::config::Config;

    /// On samples so sparse that blocks leave out rows, and on dense ones, of several tasks; with blurs of
    /// several levels.
    #[test]
    fn samples_see_the_textures() {
        let (size, mut config) = (300, Config::preset("paper").unwrap());
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs();
        let t: Vec<f32> = (0..3 * size * size).map(|i| noise(i, 0.37) - 0.5).collect();
        let specular: Vec<f32> = (0..size * size).map(|i| noise(i, 0.11)).collect();
        for (blur, count, low, high) in
            [(0.01, 300, 0.1, 0.9), (0.02, 20_000, 0.0, 1.0), (0.03, 9000, 0.7, 0.75)]
        {
            config.fine_tuning.deviation_blur = blur;
            let deviation = Deviation::new(&config, size);
            let bend = deviation.textures(&t);
            let place =
                |i: usize| Vec2::new(noise(i, 12.9898), low + (high - low) * noise(i, 78.233));
            let taps = Taps::sorted(size, &(0..count).map(place).collect::<Vec<_>>()).0;
            let region = &taps.region();
            let reach = deviation.reach(region);
            let seen = deviation.seen(&t, &specular, &reach);
            let base = &deviation.base(&seen, &reach);
            let textures =
                BentTextures { deviation: &deviation, texels: &seen.texels, base, region };
            let seen = textures.sample(&taps);
            let [sharp, blurred] = [&bend.sharp, &bend.blurred].map(|t| taps.sample::<3>(t));
            let specular = taps.sample::<1>(&specular);
            for i in 0..count {
                let [a, b, c]: [f32; 3] = sharp.sample(i, 0);
                let [e, f, g]: [f32; 3] = blurred.sample(i, 0);
                assert_eq!(seen.sample::<7>(i, 0), [a, b, c, e, f, g, specular.get(0, i)], "{i}");
            }
        }
    }
}
