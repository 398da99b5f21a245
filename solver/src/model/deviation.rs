//! The deviation texture: from the parameters to the deviation of the normals, and the adjoint.

use std::borrow::Cow;

use rayon::prelude::*;

use super::blur::Blur;
use super::deviation_textures::{BLURRED, DeviationTextures, PackedDeviations, ROWS, SPECULAR};
use super::normals::DirectionScale;
use super::pyramid::Pyramid;
use super::texels::TEXEL_VALUES;
use super::texture::part;
use crate::backend::cpu::exp;
use crate::config::PaperConfig;
use crate::parallel::from_parts;
use crate::simd::widened;

/// Components of a deviation.
const AXES: usize = 3;

/// Deviations from the mesh normal: d = range x tanh(B t) for the specular normal, blurred for the
/// diffuse one (sections 4.3.2 and 5.3). B is the identity in the paper; otherwise a band-pass, the
/// difference of a narrow and a wide blur: the mesh has the coarse relief, and the finest is noise.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Largest deviation.
    range: f32,
    size: usize,
    narrow: Blur,
    wide: Option<Blur>,
    /// The blur of d, packed with the specular albedo.
    blur: Pyramid,
    /// The scales of the directions.
    pub scale: DirectionScale,
}

/// The parts of a [`Deviation`].
pub(crate) struct Parts<'a> {
    pub range: f32,
    pub narrow: &'a Blur,
    pub wide: Option<&'a Blur>,
    pub blur: &'a Pyramid,
}

/// Gradients of the loss with respect to the textures.
pub struct TextureGradients {
    /// Gradient with respect to the deviation texture t, 3 values per texel.
    pub deviation: Vec<f32>,
    /// Gradient with respect to the specular albedo.
    pub specular: Vec<f32>,
}

impl Deviation {
    /// The parts, for a device.
    pub(crate) fn parts(&self) -> Parts<'_> {
        let Self { range, narrow, wide, blur, .. } = self;
        Parts { range: *range, narrow, wide: wide.as_ref(), blur }
    }

    /// The deviation of textures of side `size`.
    pub fn new(config: &PaperConfig, size: usize) -> Self {
        let fine = &config.fine_tuning;
        let blur = |sigma: f32| Blur::new(size, AXES, sigma * size as f32);
        Self {
            range: fine.deviation_range,
            size,
            narrow: blur(fine.deviation_smoothing),
            wide: (fine.deviation_extent > 0.0).then(|| blur(fine.deviation_extent)),
            blur: Pyramid::new(size, fine.deviation_blur * size as f32),
            scale: DirectionScale::from(&config.networks),
        }
    }

    /// d and its blur, from a deviation texture.
    pub fn textures(&self, deviation: &[f32]) -> DeviationTextures {
        let PackedDeviations { sharp, blurred } =
            self.packed(deviation, &vec![0.0; self.size * self.size]);
        let [sharp, blurred] =
            [sharp, blurred].map(|texture| part::<TEXEL_VALUES, AXES>(&texture, 0));
        DeviationTextures { sharp, blurred }
    }

    /// d and its blur, packed with the specular albedo.
    pub fn packed(&self, deviation: &[f32], specular: &[f32]) -> PackedDeviations {
        let (band, size, range) = (self.band(deviation), self.size, self.range);
        let task = |row: usize, sharp: &mut [f32]| {
            let band = &band[AXES * row * size..][..AXES * size];
            squash(sharp.as_chunks_mut().0, band.as_chunks().0, &specular[row * size..], range);
        };
        let sharp = from_parts(TEXEL_VALUES * size * size, TEXEL_VALUES * size, task).0;
        let blurred = self.blur.apply(&sharp);
        PackedDeviations { sharp, blurred }
    }

    /// The adjoint of [`Self::packed`]: gradients with respect to the textures, from those with respect to the packed
    /// values ([`ROWS`] per texel).
    pub fn adjoint(&self, bent: &PackedDeviations, gradient: &[f32]) -> TextureGradients {
        let (size, range) = (self.size, self.range);
        let [row_of_gradient, row_of_texels] = [ROWS, TEXEL_VALUES].map(|values| values * size);
        let by_blurred = |row: usize, out: &mut [f32]| {
            let texels = gradient[row * row_of_gradient..].as_chunks::<ROWS>().0;
            for (out, texel) in out.as_chunks_mut::<TEXEL_VALUES>().0.iter_mut().zip(texels) {
                out.copy_from_slice(&texel[BLURRED..]);
            }
        };
        let through_blur = self.blur.adjoint(by_blurred);
        let task = |row: usize, by_band: &mut [f32]| {
            let own = gradient[row * row_of_gradient..].as_chunks().0;
            let blurred = through_blur[row * row_of_texels..].as_chunks().0;
            let sharp = bent.sharp[row * row_of_texels..].as_chunks().0;
            unsquash(by_band.as_chunks_mut().0, own, blurred, sharp, range);
        };
        let by_band = from_parts(AXES * size * size, AXES * size, task).0;
        let deviation = self.pass(Cow::Owned(by_band), Blur::adjoint).into_owned();
        TextureGradients { deviation, specular: part::<ROWS, 1>(gradient, SPECULAR) }
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// B t, with t the deviation texture.
    pub fn band<'a>(&self, deviation: &'a [f32]) -> Cow<'a, [f32]> {
        self.pass(Cow::Borrowed(deviation), Blur::apply)
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
    /// Computes d from B t, and packs it with the specular albedo.
    fn squash(sharp: &mut [[f32; TEXEL_VALUES]], band: &[[f32; AXES]], specular: &[f32], range: f32) {
        for (sharp, (band, specular)) in sharp.iter_mut().zip(band.iter().zip(specular)) {
            for c in 0..AXES {
                sharp[c] = range * tanh(band[c]);
            }
            sharp[SPECULAR] = *specular;
        }
    }
}

widened! {
    /// The gradients with respect to d, direct and through the blur, times the derivative of d: range (1 - tanh(B
    /// t)^2).
    fn unsquash(
        by_band: &mut [[f32; AXES]],
        own: &[[f32; ROWS]],
        blurred: &[[f32; TEXEL_VALUES]],
        sharp: &[[f32; TEXEL_VALUES]],
        range: f32,
    ) {
        // A range of zero leaves no deviation, and no gradient.
        let inverse = 1.0 / range.max(f32::MIN_POSITIVE);
        for (by_band, ((own, blurred), d)) in by_band.iter_mut().zip(own.iter().zip(blurred).zip(sharp)) {
            for c in 0..AXES {
                by_band[c] = (blurred[c] + own[c]) * (range - inverse * d[c] * d[c]);
            }
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
    use glam::Vec2;

    use super::super::taps::Taps;
    use super::*;

    const SIZE: usize = 48;

    fn noise(count: usize, k: f32) -> Vec<f32> {
        (0..count).map(|i| (i as f32 * k).sin()).collect()
    }

    /// For any linear function of what samples see: a gradient is a central difference. With blurs, without, and
    /// with a range so small that there is nothing.
    #[test]
    fn gradients_are_central_differences() {
        let texels = SIZE * SIZE;
        let (t, specular) = (noise(AXES * texels, 12.9898), noise(texels, 0.7));
        let gradient = noise(ROWS * texels, 1.3);
        for (range, blur, extent) in
            [(0.5, 0.05, 0.0), (0.5, 0.0, 0.06), (0.2, 0.03, 0.05), (0.0, 0.05, 0.0)]
        {
            let mut config = PaperConfig::default();
            let fine = &mut config.fine_tuning;
            (fine.deviation_range, fine.deviation_blur, fine.deviation_extent) =
                (range, blur, extent);
            let deviation = Deviation::new(&config, SIZE);
            let value = |t: &[f32], specular: &[f32]| -> f64 {
                let PackedDeviations { sharp, blurred } = deviation.packed(t, specular);
                let texel = |at: usize| sharp[4 * at..][..4].iter().chain(&blurred[4 * at..][..3]);
                let seen = (0..texels).flat_map(|at| texel(at).zip(&gradient[ROWS * at..]));
                seen.map(|(value, factor)| f64::from(*value) * f64::from(*factor)).sum()
            };
            let found = deviation.adjoint(&deviation.packed(&t, &specular), &gradient);
            for (at, channel) in [(0, 0), (17, 2), (texels / 2, 1), (texels - 1, 0)] {
                let at = AXES * at + channel;
                let moved = |step: f32| {
                    let mut t = t.clone();
                    t[at] += step;
                    value(&t, &specular)
                };
                let expected = ((moved(1e-2) - moved(-1e-2)) / 2e-2) as f32;
                let got = found.deviation[at];
                assert!((got - expected).abs() < 2e-4, "{range} {at}: {got} not {expected}");
            }
            for (at, by_specular) in found.specular.iter().enumerate() {
                assert_eq!(*by_specular, gradient[ROWS * at + SPECULAR]);
            }
        }
    }

    #[test]
    fn samples_see_the_textures() {
        let texels = SIZE * SIZE;
        let (t, specular) = (noise(AXES * texels, 0.37), noise(texels, 0.11));
        let deviation = Deviation::new(&PaperConfig::default(), SIZE);
        let place = |i: usize| Vec2::new(i as f32 * 0.618, i as f32 * 0.414).fract();
        let taps = Taps::sorted(SIZE, &(0..1000).map(place).collect::<Vec<_>>()).0;
        let seen = deviation.packed(&t, &specular).sample(&taps);
        let DeviationTextures { sharp, blurred } = deviation.textures(&t);
        let [sharp, blurred] = [&sharp, &blurred].map(|texture| taps.sample::<3>(texture));
        let specular = taps.sample::<1>(&specular);
        for i in 0..1000 {
            assert_eq!(seen.sample::<3>(i, 0), sharp.sample(i, 0));
            assert_eq!(seen.sample::<1>(i, SPECULAR), specular.sample(i, 0));
            assert_eq!(seen.sample::<3>(i, BLURRED), blurred.sample(i, 0));
        }
    }
}
