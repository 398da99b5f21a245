//! The deviation texture: from what is optimised to what bends the normals, and back.

use std::borrow::Cow;

use rayon::prelude::*;

use super::blur::Blur;
use super::normals::DirectionScale;
use super::planes::{Planes, Row};
use super::samples::Samples;
use crate::backend::BENT;
use crate::backend::cpu::exp;
use crate::config::Config;
use crate::parallel::from_parts;
use crate::region::Region;
use crate::simd::widened;

/// Values that one task works through.
const CHUNK: usize = 1 << 14;

/// Deviations from the mesh normal: d = range x tanh(B t) for the specular normal, blurred for the
/// diffuse one (sections 4.3.2 and 5.3). B is the identity in the paper; otherwise a band-pass, the
/// difference of a narrow and a wide blur: coarse relief is the mesh's, the finest is noise.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Without it, the texture is d itself.
    range: Option<f32>,
    size: usize,
    narrow: Blur,
    wide: Option<Blur>,
    blur: Blur,
    /// How directions are scaled.
    pub scale: DirectionScale,
}

/// The textures d and blur(d), 3 channels each.
pub struct Bend {
    /// For the specular normal.
    pub sharp: Vec<f32>,
    /// For the diffuse normal.
    pub blurred: Vec<f32>,
}

/// What [`Deviation`] is made of.
pub(crate) struct Parts<'a> {
    pub range: Option<f32>,
    pub narrow: &'a Blur,
    pub wide: Option<&'a Blur>,
    pub blur: &'a Blur,
}

impl Deviation {
    /// For a device that does the same.
    pub(crate) fn parts(&self) -> Parts<'_> {
        let Self { range, narrow, wide, blur, .. } = self;
        Parts { range: *range, narrow, wide: wide.as_ref(), blur }
    }

    /// For textures of side `size`.
    pub fn new(config: &Config, size: usize) -> Self {
        let fine = &config.fine_tuning;
        let blur = |sigma: f32| Blur::new(size, 3, sigma * size as f32);
        if config.height.enabled {
            return Self {
                range: None,
                size,
                narrow: blur(0.0),
                wide: None,
                blur: blur(config.height.blur),
                scale: DirectionScale::from(&config.networks),
            };
        }
        Self {
            range: Some(fine.deviation_range),
            size,
            narrow: blur(fine.deviation_smoothing),
            wide: (fine.deviation_extent > 0.0).then(|| blur(fine.deviation_extent)),
            blur: blur(fine.deviation_blur),
            scale: DirectionScale::from(&config.networks),
        }
    }

    /// d and its blur.
    pub fn textures(&self, deviation: &[f32]) -> Bend {
        self.textures_in(&Region::whole(self.size, self.size), deviation)
    }

    /// The same; the blur in a region only.
    pub fn textures_in(&self, region: &Region, deviation: &[f32]) -> Bend {
        let band = self.band(Cow::Borrowed(deviation), Blur::apply);
        let sharp = match self.range {
            Some(range) => {
                let fill = |part: usize, out: &mut [f32]| {
                    squash(out, &band[part * CHUNK..], range);
                };
                from_parts(band.len(), CHUNK, fill).0
            }
            None => band.into_owned(),
        };
        let blurred = self.blur.apply_in(region, &sharp);
        Bend { sharp, blurred }
    }

    /// The region on which texels of another depend: where [`Self::adjoint_in`] is not zero if the
    /// gradients are zero outside of the other.
    pub fn reaches(&self, region: &Region) -> Region {
        region.dilated(self.blur.reach(), self.size)
    }

    /// Carries gradients by d and by its blur, zero outside of a region, to the deviation texture;
    /// `reached` is what it [reaches](Self::reaches).
    pub fn adjoint_in(
        &self,
        reached: &Region,
        bend: &Bend,
        by_sharp: &[f32],
        by_blurred: &[f32],
    ) -> Vec<f32> {
        let after = |at: usize, gradient: &mut [f32]| {
            unsquash(gradient, &by_sharp[at..], &bend.sharp[at..], self.range);
        };
        let gradient = self.blur.adjoint_in(reached, by_blurred, after);
        self.band(Cow::Owned(gradient), Blur::adjoint).into_owned()
    }

    /// B or its transpose.
    fn band<'a>(
        &self,
        texture: Cow<'a, [f32]>,
        blur: fn(&Blur, &[f32]) -> Vec<f32>,
    ) -> Cow<'a, [f32]> {
        let coarse = self.wide.as_ref().map(|wide| blur(wide, &texture));
        let mut band = match self.narrow.reach() {
            0 => texture,
            _ => Cow::Owned(blur(&self.narrow, &texture)),
        };
        if let Some(coarse) = coarse {
            band.to_mut().par_iter_mut().zip(&coarse).for_each(|(band, coarse)| *band -= coarse);
        }
        band
    }
}

widened! {
    /// The derivative of d = range x tanh(t), by d, times both gradients by d.
    fn unsquash(gradient: &mut [f32], by_sharp: &[f32], sharp: &[f32], range: Option<f32>) {
        let (range, square) = range.map_or((1.0, 0.0), |range| (range, 1.0 / range));
        for ((g, by_sharp), d) in gradient.iter_mut().zip(by_sharp).zip(sharp) {
            *g = (*g + by_sharp) * (range - d * d * square);
        }
    }
}

widened! {
    /// range x tanh(t), accurate to about 1e-7 of the range.
    fn squash(out: &mut [f32], t: &[f32], range: f32) {
        for (out, t) in out.iter_mut().zip(t) {
            *out = range * (1.0 - 2.0 / (exp(2.0 * t) + 1.0));
        }
    }
}

impl Bend {
    /// d, its blur and the specular albedo at every sample.
    pub fn sample(&self, specular: &[f32], samples: &Samples) -> Planes {
        Planes::from_blocks(BENT, samples.len(), |block, rows| {
            rows.first_chunk_mut().into_iter().for_each(|rows| {
                self.sample_block(specular, samples, block, rows);
            });
        })
    }

    /// The same at the samples of a block.
    pub fn sample_block(
        &self,
        specular: &[f32],
        samples: &Samples,
        block: usize,
        rows: &mut [Row; BENT],
    ) {
        let [a, b, c, d, e, f, g] = rows;
        samples.taps.sample_block(&self.sharp, block, [a, b, c]);
        samples.taps.sample_block(&self.blurred, block, [d, e, f]);
        samples.taps.sample_block(specular, block, [g]);
    }
}
