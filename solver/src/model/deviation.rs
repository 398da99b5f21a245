//! The deviation texture: from what is optimised to what bends the normals, and back.

use std::borrow::Cow;

use rayon::prelude::*;

use super::bend::{Bend, GRADIENT};
use super::blur::Blur;
use super::normals::DirectionScale;
use crate::backend::cpu::exp;
use crate::config::Config;
use crate::region::Region;
use crate::simd::widened;

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
        let mut bend = Bend::new(self.size);
        self.textures_in(&Region::whole(self.size, self.size), deviation, &mut bend);
        bend
    }

    /// The same in a region; elsewhere `bend` may stay as it is.
    pub fn textures_in(&self, region: &Region, deviation: &[f32], bend: &mut Bend) {
        let band = self.band(Cow::Borrowed(deviation), Blur::apply);
        let squash = |at: usize, out: &mut [f32]| {
            let band = &band[at..at + out.len()];
            match self.range {
                Some(range) => squash(out, band, range),
                None => out.copy_from_slice(band),
            }
        };
        self.reaches(region).rows_of(&mut bend.sharp, 3, squash);
        self.blur.apply_in(region, &bend.sharp, &mut bend.blurred);
    }

    /// The region on which texels of another depend: where [`Self::adjoint_in`] is not zero if the
    /// gradients are zero outside of the other.
    pub fn reaches(&self, region: &Region) -> Region {
        region.dilated(self.blur.reach(), self.size)
    }

    /// Where the deviation texture moves, given what [`Self::reaches`] says.
    pub fn moved<'a>(&self, reached: &'a Region) -> Cow<'a, Region> {
        match self.banded() {
            true => Cow::Owned(Region::whole(self.size, self.size)),
            false => Cow::Borrowed(reached),
        }
    }

    /// Whether B is anything but the identity.
    fn banded(&self) -> bool {
        self.wide.is_some() || self.narrow.reach() > 0
    }

    /// Carries gradients by d and by its blur ([`GRADIENT`] values a texel), zero outside of a region, to the
    /// deviation texture, in `out`; `reached` is what it [reaches](Self::reaches).
    pub fn adjoint_in(&self, reached: &Region, bend: &Bend, gradient: &[f32], out: &mut Vec<f32>) {
        let texels =
            |row: usize, column: usize| &gradient.as_chunks().0[row * self.size + column..];
        let read = |row: usize, column: usize, values: &mut [f32]| {
            blurred(values.as_chunks_mut().0, texels(row, column));
        };
        let write = |row: usize, column: usize, values: &[f32], out: &mut [f32]| {
            let sharp = &bend.sharp[3 * (row * self.size + column)..];
            let (values, out) = (values.as_chunks().0, out.as_chunks_mut().0);
            unsquash(out, values, texels(row, column), sharp.as_chunks().0, self.range);
        };
        self.blur.adjoint_in(reached, read, write, out);
        if self.banded() {
            *out = self.band(Cow::Owned(std::mem::take(out)), Blur::adjoint).into_owned();
        }
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
    /// Of the gradients of texels, those by blur(d).
    fn blurred(out: &mut [[f32; 3]], texels: &[[f32; GRADIENT]]) {
        for (out, [_, _, _, x, y, z, _, _]) in out.iter_mut().zip(texels) {
            *out = [*x, *y, *z];
        }
    }
}

widened! {
    /// The derivative of d = range x tanh(t), by d, times both gradients by d.
    fn unsquash(
        out: &mut [[f32; 3]],
        through_blur: &[[f32; 3]],
        texels: &[[f32; GRADIENT]],
        sharp: &[[f32; 3]],
        range: Option<f32>,
    ) {
        let (range, square) = range.map_or((1.0, 0.0), |range| (range, 1.0 / range));
        for (((out, g), texel), d) in out.iter_mut().zip(through_blur).zip(texels).zip(sharp) {
            for c in 0..3 {
                out[c] = (g[c] + texel[c]) * (range - d[c] * d[c] * square);
            }
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
