//! The deviation texture: from what is optimised to what bends the normals, and back.

use std::borrow::Cow;

use rayon::prelude::*;

use super::bend::{Bend, Texel};
use super::blur::{Blur, BlurredRows};
use super::normals::{DIRECTIONS, DirectionScale};
use crate::backend::cpu::exp;
use crate::config::Config;
use crate::convolution::Place;
use crate::parallel::from_parts;
use crate::region::Region;
use crate::simd::widened;

/// Of the deviation texture.
const CHANNELS: usize = 3;

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
        let blur = |sigma: f32| Blur::new(size, CHANNELS, sigma * size as f32);
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
        let sharp = self.squashed(&self.band(deviation));
        Bend { blurred: self.blur.apply(&sharp), sharp }
    }

    /// Rows of the blur of d.
    pub fn blurred_rows<'a>(&'a self, region: &'a Region) -> BlurredRows<'a> {
        self.blur.rows(region)
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The region on which texels of another depend: where [`Self::adjoint_in`] is not zero if the
    /// gradients are zero outside of the other.
    pub fn reaches(&self, region: &Region) -> Region {
        region.dilated(self.blur.reach(), self.size)
    }

    /// Whether B is anything but the identity.
    pub fn banded(&self) -> bool {
        self.wide.is_some() || self.narrow.reach() > 0
    }

    /// B t, with t the deviation texture.
    pub fn band<'a>(&self, deviation: &'a [f32]) -> Cow<'a, [f32]> {
        self.pass(Cow::Borrowed(deviation), Blur::apply)
    }

    /// Carries gradients by B t to t.
    pub fn band_adjoint(&self, gradient: Vec<f32>) -> Vec<f32> {
        self.pass(Cow::Owned(gradient), Blur::adjoint).into_owned()
    }

    /// Carries gradients of texels, zero outside of a region, through the blur: `write` is given those by
    /// d and by the specular albedo in what the region [reaches](Self::reaches), for each of the `rows`.
    pub fn adjoint_in<O: Send>(
        &self,
        reached: &Region,
        gradient: &[Texel],
        rows: Vec<O>,
        write: impl Fn(&Place, &mut [f32], &[f32], &mut O) + Sync,
    ) {
        let read = |row: usize, column: usize, values: &mut [f32]| {
            let gradient = &gradient[row * self.size + column..][..values.len() / CHANNELS];
            by_blur(values.as_chunks_mut().0, gradient);
        };
        let write = |place: &Place, values: &mut [f32], row: &mut O| {
            let texels = &gradient[place.row * self.size + place.columns.start..];
            let mut specular = vec![0.0; place.columns.len()];
            others(values.as_chunks_mut().0, &mut specular, texels);
            write(place, values, &specular, row);
        };
        self.blur.adjoint_in(reached, read, write, rows);
    }

    /// Multiplies gradients by d with its derivatives by B t: range (1 - tanh(B t)^2).
    pub fn unsquash(&self, by_d: &mut [f32], d: &[f32]) {
        if let Some(range) = self.range {
            unsquash(by_d, d, range);
        }
    }

    /// d of a texture's B t ([`Self::band`]).
    pub fn squashed(&self, band: &[f32]) -> Vec<f32> {
        let line = CHANNELS * self.size;
        from_parts(band.len(), line, |row, out| self.squash(out, &band[row * line..])).0
    }

    /// d of so many values of B t.
    pub fn squash(&self, out: &mut [f32], band: &[f32]) {
        match self.range {
            Some(range) => squash(out, band, range),
            None => out.copy_from_slice(&band[..out.len()]),
        }
    }

    /// B or its transpose.
    fn pass<'a>(
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
    /// Of the gradients of texels, those by blur(d).
    fn by_blur(out: &mut [[f32; CHANNELS]], texels: &[Texel]) {
        for (out, [_, _, _, x, y, z, _, _]) in out.iter_mut().zip(texels) {
            *out = [*x, *y, *z];
        }
    }
}

widened! {
    /// Adds those by d to those that came through the blur; and those by the specular albedo.
    fn others(by_d: &mut [[f32; CHANNELS]], by_specular: &mut [f32], texels: &[Texel]) {
        for ((out, specular), texel) in by_d.iter_mut().zip(by_specular).zip(texels) {
            for c in 0..CHANNELS {
                out[c] += texel[c];
            }
            *specular = texel[DIRECTIONS];
        }
    }
}

widened! {
    fn unsquash(by_d: &mut [f32], d: &[f32], range: f32) {
        // A range of zero leaves no deviation, and no gradient.
        let inverse = 1.0 / range.max(f32::MIN_POSITIVE);
        for (g, d) in by_d.iter_mut().zip(d) {
            *g *= range - inverse * d * d;
        }
    }
}

widened! {
    fn squash(out: &mut [f32], t: &[f32], range: f32) {
        for (out, t) in out.iter_mut().zip(t) {
            *out = range * tanh(*t);
        }
    }
}

/// Accurate to about 1e-7.
#[inline(always)]
fn tanh(t: f32) -> f32 {
    1.0 - 2.0 / (exp(2.0 * t) + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_derivative_is_that_of_the_squashed_texture_and_zero_without_a_range() {
        let mut config = Config::preset("paper").unwrap();
        let t = [-1.5f32, -0.2, 0.0, 0.7, 3.0, 20.0];
        for range in [0.0, 1e-40, 0.5] {
            config.fine_tuning.deviation_range = range;
            let deviation = Deviation::new(&config, 4);
            let squashed = |step: f32| {
                let mut d = [0.0; 6];
                deviation.squash(&mut d, &t.map(|t| t + step));
                d
            };
            let mut by_t = [1.0; 6];
            deviation.unsquash(&mut by_t, &squashed(0.0));
            let (ahead, behind) = (squashed(1e-2), squashed(-1e-2));
            for (i, by_t) in by_t.into_iter().enumerate() {
                let expected = (ahead[i] - behind[i]) / 2e-2;
                assert!((by_t - expected).abs() < 1e-4, "{range} {i}: {by_t} not {expected}");
            }
        }
    }
}
