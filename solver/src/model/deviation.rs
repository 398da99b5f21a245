//! The deviation texture: from what is optimised to what bends the normals, and back.

use std::borrow::Cow;

use rayon::prelude::*;

use super::bend::Bend;
use super::bend_gradient::BendGradient;
use super::blur::Blur;
use super::halving::{Lines, ROWS, Sums, Texel, add_edges};
use super::normals::DirectionScale;
use super::pyramid::Pyramid;
use super::texture::part;
use crate::backend::cpu::exp;
use crate::config::Config;
use crate::region::Place;
use crate::region::Region;
use crate::simd::widened;

/// Of the deviation texture.
const CHANNELS: usize = 3;
/// Texels of a row that are worked on at once: with all that belongs to them, they stay in the nearest cache.
const TILE: usize = 128;

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
    blur: Pyramid,
    /// How directions are scaled.
    pub scale: DirectionScale,
}

/// What [`Deviation`] is made of.
pub(crate) struct Parts<'a> {
    pub range: Option<f32>,
    pub narrow: &'a Blur,
    pub wide: Option<&'a Blur>,
    pub blur: &'a Pyramid,
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
        let pyramid = |sigma: f32| Pyramid::new(size, sigma * size as f32);
        if config.height.enabled {
            return Self {
                range: None,
                size,
                narrow: blur(0.0),
                wide: None,
                blur: pyramid(config.height.blur),
                scale: DirectionScale::from(&config.networks),
            };
        }
        Self {
            range: Some(fine.deviation_range),
            size,
            narrow: blur(fine.deviation_smoothing),
            wide: (fine.deviation_extent > 0.0).then(|| blur(fine.deviation_extent)),
            blur: pyramid(fine.deviation_blur),
            scale: DirectionScale::from(&config.networks),
        }
    }

    /// d and its blur.
    pub fn textures(&self, deviation: &[f32]) -> Bend {
        let texels = self.texels(deviation, &vec![0.0; self.size * self.size]);
        let blurred = self.blur.apply(&texels);
        let [sharp, blurred] =
            [texels.as_flattened(), &blurred].map(|texture| part::<4, CHANNELS>(texture, 0));
        Bend { sharp, blurred }
    }

    /// Side of the textures, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The texels on which what is seen of a region depends, and which depend on it.
    pub fn reach(&self, region: &Region) -> Vec<Region> {
        self.blur.reach(region)
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

    /// Carries gradients to B t: `write` is given those by it and by the specular albedo in what the samples
    /// [reach](Self::reach), row by row, with the texels, which it may change, and what belongs to the row.
    pub fn adjoint<O: Send>(
        &self,
        gradient: &BendGradient,
        reach: &[Region],
        seen: &mut Seen,
        mut rows: Vec<O>,
        write: impl Fn(&Place, Gradients, &mut [Texel], &mut O) + Sync,
    ) {
        let base = self.blur.convolved(&gradient.base, reach);
        let size = self.size;
        let scratch = || (vec![0.0; CHANNELS * size], vec![0.0; size], Lines::new(size));
        self.remake(
            seen,
            reach,
            &mut rows,
            scratch,
            |(by_band, by_specular, lines), place, texels, out| {
                let by_band = &mut by_band[..CHANNELS * texels.len()];
                let by_specular = &mut by_specular[..texels.len()];
                let own = &gradient.own[place.row * size..][place.within(1)];
                let blurred = self.blur.row(&base, place.row, &place.columns, lines);
                unsquash(by_band.as_chunks_mut().0, by_specular, own, blurred, texels, self.range);
                write(place, Gradients { by_band, by_specular }, texels, out);
            },
        );
    }

    /// d of a deviation texture, with the specular albedo.
    pub fn seen(&self, deviation: &[f32], specular: &[f32], reach: &[Region]) -> Seen {
        let side = if self.blur.levels() > 0 { self.blur.base_size() } else { 0 };
        let halved = vec![Texel::default(); side * side];
        let mut seen = Seen { texels: self.texels(deviation, specular), halved };
        self.remake(&mut seen, reach, &mut vec![(); self.size], || (), |(), _, _, ()| {});
        seen
    }

    fn texels(&self, deviation: &[f32], specular: &[f32]) -> Vec<Texel> {
        let (band, size) = (self.band(deviation), self.size);
        let mut texels = vec![Texel::default(); specular.len()];
        let rows = texels.par_chunks_mut(size).enumerate();
        rows.for_each(|(row, texels)| {
            self.put(texels, &band[CHANNELS * row * size..], &specular[row * size..]);
        });
        texels
    }

    /// Has texels changed row by row in what is reached, and halves them.
    fn remake<S, O: Send>(
        &self,
        Seen { texels, halved }: &mut Seen,
        reach: &[Region],
        rows: &mut [O],
        scratch: impl Fn() -> S + Send + Sync,
        change: impl Fn(&mut S, &Place, &mut [Texel], &mut O) + Sync,
    ) {
        let (size, width) = (self.size, self.blur.base_size());
        let empty = halved.is_empty();
        let count = size.div_ceil(ROWS);
        let length = if empty { 0 } else { ROWS / 2 * width };
        let mut halves: Vec<&mut [Texel]> = halved.chunks_mut(length.max(1)).collect();
        halves.resize_with(count, Default::default);
        let task = |(scratch, lines): &mut (S, Lines),
                    (number, ((texels, out), half)): (usize, Task<O>)| {
            let first = number * ROWS;
            let mut sums = (!empty).then(|| Sums::new(size, width, first, half));
            for (row, (texels, out)) in (first..).zip(texels.chunks_mut(size).zip(out)) {
                let all = &reach[0].0[row];
                for start in all.clone().step_by(TILE) {
                    let place = Place { row, columns: start..all.end.min(start + TILE) };
                    change(scratch, &place, &mut texels[place.columns.clone()], out);
                }
                if let Some(sums) = &mut sums {
                    sums.add(row, all, lines, |out| out.copy_from_slice(&texels[all.clone()]));
                }
            }
            sums.map(Sums::edges)
        };
        let tasks = texels.par_chunks_mut(ROWS * size).zip(rows.par_chunks_mut(ROWS)).zip(halves);
        let edges: Vec<_> = tasks
            .enumerate()
            .map_init(|| (scratch(), Lines::new(size)), task)
            .flatten_iter()
            .collect();
        add_edges(halved, edges.as_flattened());
    }

    /// Makes d of as many values of B t, and puts the specular albedo beside.
    pub fn put(&self, texels: &mut [Texel], band: &[f32], specular: &[f32]) {
        put(texels, band.as_chunks().0, specular, self.range);
    }

    /// The base of the blur of d.
    pub fn base(&self, Seen { texels, halved }: &Seen, reach: &[Region]) -> Vec<f32> {
        self.blur.convolved(if halved.is_empty() { texels } else { halved }, reach)
    }

    /// The blur of d.
    pub fn blur(&self) -> &Pyramid {
        &self.blur
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

/// What samples see of the textures.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// d and the specular albedo.
    pub texels: Vec<Texel>,
    /// The same as the blur's pyramid halves it, in what is reached; if it does.
    halved: Vec<Texel>,
}

/// Rows of texels, what belongs to them, and halved rows.
type Task<'a, O> = ((&'a mut [Texel], &'a mut [O]), &'a mut [Texel]);

/// Gradients of some texels of a row.
pub struct Gradients<'a> {
    /// By B t, three values each.
    pub by_band: &'a [f32],
    /// By the specular albedo.
    pub by_specular: &'a [f32],
}

widened! {
    /// Gradients by d, its own and those through the blur, times its derivatives by B t: range (1 - tanh(B t)^2);
    /// and those by the specular albedo.
    fn unsquash(
        by_band: &mut [[f32; CHANNELS]],
        by_specular: &mut [f32],
        own: &[Texel],
        blurred: &[Texel],
        d: &[Texel],
        range: Option<f32>,
    ) {
        // A range of zero leaves no deviation, and no gradient.
        let (range, inverse) = range.map_or((1.0, 0.0), |range| (range, 1.0 / range.max(f32::MIN_POSITIVE)));
        let texels = own.iter().zip(blurred).zip(d);
        for ((by_band, by_specular), ((own, blurred), d)) in by_band.iter_mut().zip(by_specular).zip(texels) {
            for c in 0..CHANNELS {
                by_band[c] = (blurred[c] + own[c]) * (range - inverse * d[c] * d[c]);
            }
            *by_specular = own[CHANNELS];
        }
    }
}

widened! {
    fn put(texels: &mut [Texel], band: &[[f32; CHANNELS]], specular: &[f32], range: Option<f32>) {
        for (texel, (band, specular)) in texels.iter_mut().zip(band.iter().zip(specular)) {
            for c in 0..CHANNELS {
                texel[c] = range.map_or(band[c], |range| range * tanh(band[c]));
            }
            texel[CHANNELS] = *specular;
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
            let texels = |step: f32| {
                let mut texels = [Texel::default(); 2];
                deviation.put(&mut texels, &t.map(|t| t + step), &[0.1, 0.2]);
                texels
            };
            let d = |step: f32, i: usize| texels(step)[i / 3][i % 3];
            let (mut by_t, mut by_specular) = ([[0.0; 3]; 2], [0.0; 2]);
            let (own, blurred) = ([[0.25, 0.25, 0.25, 0.5]; 2], [[0.75; 4]; 2]);
            unsquash(&mut by_t, &mut by_specular, &own, &blurred, &texels(0.0), deviation.range);
            assert_eq!((by_specular, texels(0.0)[1][3]), ([0.5; 2], 0.2));
            for (i, by_t) in by_t.as_flattened().iter().enumerate() {
                let expected = (d(1e-2, i) - d(-1e-2, i)) / 2e-2;
                assert!((by_t - expected).abs() < 1e-4, "{range} {i}: {by_t} not {expected}");
            }
        }
    }
}
