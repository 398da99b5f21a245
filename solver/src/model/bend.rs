//! The textures that bend the normals, and the specular albedo; as samples see them, rows of texels are made when
//! they are asked for, and do not pass through memory.

use glam::Vec4;

use super::blur::BlurredRows;
use super::deviation::Deviation;
use super::planes::{BLOCK, CHUNK_BLOCKS, Planes, Row};
use super::taps::Taps;
use super::texels::{apart, interpolate};
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
        let rows = [(); 2].map(|()| vec![[0.0; TEXEL]; self.deviation.size()]);
        TexelRows { textures: *self, blurred, rows, made: [None; 2] }
    }
}

/// Two rows of texels, which move downwards.
pub struct TexelRows<'a> {
    textures: BentTextures<'a>,
    blurred: BlurredRows<'a>,
    /// An even one and an odd one; and their numbers.
    rows: [Vec<Texel>; 2],
    made: [Option<usize>; 2],
}

impl TexelRows<'_> {
    /// What the samples of a block see, which comes after those that were asked for before.
    pub fn sample(&mut self, taps: &Taps, block: usize, out: &mut [Row]) {
        let first = block * BLOCK;
        let end = (first + BLOCK).min(taps.cells().len());
        let mut values = [[Vec4::ZERO; VECTORS]; BLOCK];
        let mut at = first;
        while at < end {
            let row = taps.cells()[at] as usize / taps.size();
            let here = at..taps.samples_in(row..row + 1).end.min(end);
            (row..row + 2).for_each(|row| self.make(row));
            let texels = [row, row + 1].map(|row| self.rows[row % 2].as_flattened());
            let values = &mut values[here.start - first..here.end - first];
            at = here.end;
            interpolate(texels, row * taps.size(), taps, here, values);
        }
        apart(&values, out);
    }

    /// Brings a row, if it is not there.
    fn make(&mut self, row: usize) {
        let Self { textures: BentTextures { d, specular, .. }, blurred, rows, made } = self;
        if made[row % 2].replace(row) == Some(row) {
            return;
        }
        let texels = &mut rows[row % 2];
        let first = row * texels.len();
        let (column, blurred) = blurred.row(row, d);
        let first = first + column;
        side_by_side(&mut texels[column..], &d[3 * first..], blurred, &specular[first..]);
    }
}

widened! {
    fn side_by_side(texels: &mut [Texel], sharp: &[f32], blurred: &[f32], specular: &[f32]) {
        let (sharp, _) = sharp.as_chunks::<3>();
        let (blurred, _) = blurred.as_chunks::<3>();
        for (((texel, d), b), s) in texels.iter_mut().zip(sharp).zip(blurred).zip(specular) {
            *texel = [d[0], d[1], d[2], b[0], b[1], b[2], *s, 0.0];
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
