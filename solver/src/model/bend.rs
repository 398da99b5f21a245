//! The textures that bend the normals, and the specular albedo; as samples see them, rows of the blurred one are
//! made when they are asked for, and do not pass through memory.

use std::ops::Range;

use glam::Vec4;

use super::blur::BlurredRows;
use super::deviation::Deviation;
use super::planes::{BLOCK, CHUNK_BLOCKS, Planes, Row};
use super::taps::Taps;
use super::texels::{apart, within};
use crate::region::Region;
use crate::simd::widened;

/// d (3 values), its blur (3), the specular albedo, and one that fills up two vectors; or gradients by
/// them.
pub type Texel = [f32; TEXEL];
/// Values of a texel.
pub const TEXEL: usize = 4 * VECTORS;
/// Vectors of a texel.
pub const VECTORS: usize = 2;

/// The textures d and blur(d), 3 channels each.
pub struct Bend {
    /// For the specular normal.
    pub sharp: Vec<f32>,
    /// For the diffuse normal.
    pub blurred: Vec<f32>,
}

/// Rows at a sample: all of a [`Texel`] but what fills it up.
const ROWS: usize = TEXEL - 1;

/// The deviation d ([`Deviation::squashed`]), its blur and the specular albedo.
#[derive(Clone, Copy)]
pub struct BentTextures<'a> {
    /// Blurs d.
    pub deviation: &'a Deviation,
    /// 3 values a texel.
    pub d: &'a [f32],
    /// One.
    pub specular: &'a [f32],
    /// The texels that samples see ([`Taps::region`]).
    pub region: &'a Region,
}

impl<'a> BentTextures<'a> {
    /// d, its blur and the specular albedo at every sample (7 rows).
    pub fn sample(&self, taps: &Taps) -> Planes {
        let task = |(): &mut (), first: usize, out: &mut [Row]| {
            let mut rows = self.rows();
            for (block, out) in out.chunks_exact_mut(ROWS).enumerate() {
                rows.sample(taps, first + block, out);
            }
        };
        Planes::from_tasks(ROWS, taps.cells().len(), CHUNK_BLOCKS, || (), task).0
    }

    /// The same block by block, downwards.
    pub fn rows(&self) -> TexelRows<'a> {
        let blurred = self.deviation.blurred_rows(self.region);
        let rows = [(); 2].map(|()| vec![0.0; CHANNELS * self.deviation.size()]);
        TexelRows { textures: *self, blurred, rows, made: [None; 2] }
    }
}

/// Of the deviation.
const CHANNELS: usize = 3;

/// Two rows of texels, which move downwards.
pub struct TexelRows<'a> {
    textures: BentTextures<'a>,
    blurred: BlurredRows<'a>,
    /// An even one and an odd one of the blur; and their numbers.
    rows: [Vec<f32>; 2],
    made: [Option<usize>; 2],
}

impl TexelRows<'_> {
    /// What the samples of a block see, which comes after those that were asked for before.
    pub fn sample(&mut self, taps: &Taps, block: usize, out: &mut [Row]) {
        let first = block * BLOCK;
        let (end, size) = ((first + BLOCK).min(taps.cells().len()), taps.size());
        let mut values = [[Vec4::ZERO; VECTORS]; BLOCK];
        let mut at = first;
        while at < end {
            let row = taps.cells()[at] as usize / size;
            let here = at..taps.samples_in(row..row + 1).end.min(end);
            (row..row + 2).for_each(|row| self.make(row));
            let rows = [row, row + 1].map(|row| {
                let BentTextures { d, specular, .. } = self.textures;
                let d = &d[CHANNELS * row * size..][..CHANNELS * size];
                Bent { d, blurred: &self.rows[row % 2], specular: &specular[row * size..][..size] }
            });
            at = here.end;
            let values = &mut values[here.start - first..];
            interpolate(rows.each_ref(), row * size, taps, here, values);
        }
        apart(&values, out);
    }

    /// Brings a row, if it is not there.
    fn make(&mut self, row: usize) {
        let Self { textures, blurred, rows, made } = self;
        if made[row % 2].replace(row) != Some(row) {
            blurred.row(row, textures.d, &mut rows[row % 2]);
        }
    }
}

/// A row of the textures.
struct Bent<'a> {
    d: &'a [f32],
    blurred: &'a [f32],
    specular: &'a [f32],
}

impl Bent<'_> {
    /// A texel and the next one.
    #[inline(always)]
    fn pair(&self, at: usize) -> [[Vec4; VECTORS]; 2] {
        let [d, b] = [self.d, self.blurred].map(|values| &values[CHANNELS * at..][..2 * CHANNELS]);
        let s = &self.specular[at..at + 2];
        [
            [Vec4::new(d[0], d[1], d[2], b[0]), Vec4::new(b[1], b[2], s[0], 0.0)],
            [Vec4::new(d[3], d[4], d[5], b[3]), Vec4::new(b[4], b[5], s[1], 0.0)],
        ]
    }
}

widened! {
    /// What samples of a row of cells, of which the first has number `first`, see of the rows of texels on
    /// either side.
    fn interpolate(
        rows: [&Bent; 2],
        first: usize,
        taps: &Taps,
        samples: Range<usize>,
        values: &mut [[Vec4; VECTORS]],
    ) {
        let (cells, fractions) = (&taps.cells()[samples.clone()], &taps.fractions()[samples]);
        let mut sample = 0;
        while sample < cells.len() {
            let at = cells[sample] as usize - first;
            let four = [rows[0].pair(at), rows[1].pair(at)];
            sample = within(four, sample, cells, fractions, values);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::config::Config;

    /// On samples so sparse that blocks leave out rows, and on dense ones, of several tasks.
    #[test]
    fn samples_see_the_textures() {
        let (size, mut config) = (300, Config::preset("paper").unwrap());
        config.fine_tuning.deviation_blur = 0.01;
        let deviation = Deviation::new(&config, size);
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs();
        let t: Vec<f32> = (0..3 * size * size).map(|i| noise(i, 0.37) - 0.5).collect();
        let specular: Vec<f32> = (0..size * size).map(|i| noise(i, 0.11)).collect();
        let (bend, d) = (deviation.textures(&t), deviation.squashed(&t));
        for (count, low, high) in [(300, 0.1, 0.9), (20_000, 0.0, 1.0), (9000, 0.7, 0.75)] {
            let place =
                |i: usize| Vec2::new(noise(i, 12.9898), low + (high - low) * noise(i, 78.233));
            let taps = Taps::sorted(size, &(0..count).map(place).collect::<Vec<_>>()).0;
            let region = &taps.region();
            let textures =
                BentTextures { deviation: &deviation, d: &d, specular: &specular, region };
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
