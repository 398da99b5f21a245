//! Highlights of skin as a linear function of the light, with the transport's visibility.

use formats::cancel;
use glam::Vec3;
use rayon::prelude::*;

use super::matrix::{Matrix, add_scaled};
use super::skin::reflected;
use super::{CHANNELS, LIGHT_EXPONENT, SkyRay, SpecularTerm, Transport};
use crate::config::SkinConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// Shares of a lobe below this are left out: they change no sum, but their products would be subnormal numbers, which
/// take some processors a hundred times as long.
const FAINT: f32 = 1e-16;

/// The matrix from a light to the highlights of samples.
#[derive(Debug)]
pub struct Reflection(Matrix);

impl Reflection {
    /// The radiance of every sample in a light of R, G, B per cell.
    pub fn radiance(&self, light: &[f32]) -> Vec<[f32; CHANNELS]> {
        self.0.product(light)
    }

    /// Returns the gradient with respect to the light, where `value` returns the gradient with respect to the
    /// [radiance](Self::radiance) of a sample; and the other results of `value`. One pass over the rows, which are most
    /// of the bytes of a step.
    pub fn exchange<T: Send>(
        &self,
        light: &[f32],
        value: impl Fn(usize, [f32; CHANNELS]) -> ([f32; CHANNELS], T) + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        self.0.exchange(light, value)
    }
}

impl Transport {
    /// Returns the reflection of samples with these [`SpecularTerm`] terms, for lights of this `peak` at a nearness per
    /// metre, which may differ from that of the cast rays. Takes samples x cells x 4 bytes.
    pub fn reflection(
        &self,
        skin: &SkinConfig,
        samples: &Samples,
        specular: &Planes,
        peak: f32,
        nearness_per_metre: f32,
    ) -> Reflection {
        let centres = self.sky.centres();
        let (cells, lobes) = (self.cells(), self.lobes(LIGHT_EXPONENT));
        let mut rows = vec![0.0; samples.len() * cells];
        rows.par_chunks_mut(cells.max(1)).enumerate().for_each(|(i, row)| {
            cancel::check();
            let specular = SpecularTerm::at(specular, i);
            let scale = scale(skin, peak) * specular.reflectance;
            let skin = &specular.lobes_of(skin);
            let from = nearness_per_metre * self.places[self.row_of(samples, i)];
            for (cell, weight) in self.reflecting(skin, &centres, samples, i, from) {
                add_scaled(row, &lobes[cell * cells..][..cells], scale * weight);
            }
        });
        Reflection(Matrix { rows, cells })
    }

    /// Returns the visible cells of a sample, each with the share of its light that is reflected towards the camera,
    /// times F0 / pi. The sample lies at `from`, in units of the sky's radius.
    fn reflecting<'a>(
        &'a self,
        skin: &'a SkinConfig,
        centres: &'a [Vec3],
        samples: &Samples,
        i: usize,
        from: Vec3,
    ) -> impl Iterator<Item = (usize, f32)> + 'a {
        let row = self.row_of(samples, i);
        let normal = Vec3::from_array(samples.normal.sample(i, 0));
        let view = Vec3::from_array(samples.view.sample(i, 0));
        let visible = &self.visible_solid_angle.rows[row * self.cells()..];
        let cells = visible.iter().zip(centres).enumerate();
        cells.filter(|(_, (visible, _))| **visible > 0.0).map(move |(cell, (visible, centre))| {
            (cell, visible * reflected(skin, normal, view, (*centre - from).normalize()))
        })
    }

    /// The row of the texel in which a sample lies, for taps of any side.
    pub(super) fn row_of(&self, samples: &Samples, i: usize) -> usize {
        let (at, side) = (samples.taps.nearest(i), samples.taps.size());
        let texel = |x: usize| x * self.size / side;
        self.row[texel(at / side) * self.size + texel(at % side)] as usize
    }

    /// Filters a light of R, G, B per cell with a power of the cosine.
    pub(super) fn through_lobes(&self, light: &[f32], exponent: i32) -> Vec<[f32; CHANNELS]> {
        Matrix { rows: self.lobes(exponent), cells: self.cells() }.product(light)
    }

    /// The weights of all cells in a lobe around every cell: rows of sum 1.
    fn lobes(&self, exponent: i32) -> Vec<f32> {
        let (rays, centres) = (self.sky.rays(1, 0), self.sky.centres());
        let lobe = |centre: &Vec3| {
            let weight = |(other, ray): (&Vec3, &SkyRay)| {
                ray.solid_angle * centre.dot(*other).max(0.0).powi(exponent)
            };
            let row: Vec<f32> = centres.iter().zip(&rays).map(weight).collect();
            let total: f32 = row.iter().sum();
            row.into_iter()
                .map(move |weight| if weight > FAINT * total { weight / total } else { 0.0 })
        };
        centres.par_iter().flat_map_iter(lobe).collect()
    }
}

/// The factor from [`Transport::reflecting`] to radiance for a reflectance of 1 at normal incidence, in a light of this
/// peak.
pub(super) fn scale(skin: &SkinConfig, peak: f32) -> f32 {
    std::f32::consts::PI / (skin.f0 * peak.max(f32::MIN_POSITIVE))
}
