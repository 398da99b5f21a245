//! The deviation texture: from what is optimised to what bends the normals, and back.

use rayon::prelude::*;

use super::blur::Blur;
use super::normals::DirectionScale;
use super::planes::Planes;
use super::samples::Samples;
use super::texture::interleave;
use crate::backend::cpu;
use crate::config::Config;
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
                narrow: blur(0.0),
                wide: None,
                blur: blur(config.height.blur),
                scale: DirectionScale::from(&config.networks),
            };
        }
        Self {
            range: Some(fine.deviation_range),
            narrow: blur(fine.deviation_smoothing),
            wide: (fine.deviation_extent > 0.0).then(|| blur(fine.deviation_extent)),
            blur: blur(fine.deviation_blur),
            scale: DirectionScale::from(&config.networks),
        }
    }

    /// d and its blur.
    pub fn textures(&self, deviation: &[f32]) -> Bend {
        let mut sharp = self.band(deviation, Blur::apply);
        if let Some(range) = self.range {
            sharp.par_chunks_mut(CHUNK).for_each(|values| squash(values, range));
        }
        let blurred = self.blur.apply(&sharp);
        Bend { sharp, blurred }
    }

    /// Carries gradients by d and by its blur to the deviation texture.
    pub fn adjoint(&self, bend: &Bend, by_sharp: &[f32], by_blurred: &[f32]) -> Vec<f32> {
        let mut gradient = self.blur.adjoint(by_blurred);
        let parts = by_sharp.par_chunks(CHUNK).zip(bend.sharp.par_chunks(CHUNK));
        gradient.par_chunks_mut(CHUNK).zip(parts).for_each(|(gradient, (by_sharp, sharp))| {
            for ((g, by_sharp), d) in gradient.iter_mut().zip(by_sharp).zip(sharp) {
                // The derivative of d = range x tanh(t), by d.
                *g = (*g + by_sharp) * self.range.map_or(1.0, |range| range - d * d / range);
            }
        });
        self.band(&gradient, Blur::adjoint)
    }

    /// B or its transpose.
    fn band(&self, texture: &[f32], blur: fn(&Blur, &[f32]) -> Vec<f32>) -> Vec<f32> {
        let mut band = blur(&self.narrow, texture);
        if let Some(wide) = &self.wide {
            let coarse = blur(wide, texture);
            band.par_iter_mut().zip(&coarse).for_each(|(band, coarse)| *band -= coarse);
        }
        band
    }
}

widened! {
    /// t becomes range x tanh(t), accurate to about 1e-7 absolute.
    fn squash(values: &mut [f32], range: f32) {
        let (whole, rest) = values.as_chunks_mut::<8>();
        for values in whole {
            squash_eight(values, range);
        }
        let mut last = [0.0; 8];
        last[..rest.len()].copy_from_slice(rest);
        squash_eight(&mut last, range);
        rest.copy_from_slice(&last[..rest.len()]);
    }
}

#[inline(always)]
fn squash_eight(values: &mut [f32; 8], range: f32) {
    let mut t = [0.0; 8];
    for lane in 0..8 {
        t[lane] = 2.0 * values[lane];
    }
    let e = cpu::exp(t);
    for lane in 0..8 {
        values[lane] = range * (1.0 - 2.0 / (e[lane] + 1.0));
    }
}

impl Bend {
    /// d, its blur and the specular albedo at every sample.
    pub fn sample(&self, specular: &[f32], samples: &Samples) -> Planes {
        let parts: [(&[f32], usize); 3] = [(&self.sharp, 3), (&self.blurred, 3), (specular, 1)];
        samples.taps.sample::<7>(&interleave::<7>(&parts))
    }
}
