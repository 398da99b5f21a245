//! The highlights that a light makes on skin, by the transport's visibility.

use formats::cancel;
use glam::Vec3;
use rayon::prelude::*;

use super::matrix::{Matrix, add_scaled};
use super::skin::reflected;
use super::{CHANNELS, LIGHT_EXPONENT, SkyRay, SpecularTerm, Transport};
use crate::config::SkinConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// Shares of a lobe that are left out: they change no sum, but their products with other factors would be
/// subnormal, which some processors take a hundred times as long for.
const FAINT: f32 = 1e-16;

/// From a light to the highlights of samples, linear.
#[derive(Debug)]
pub struct Reflection(Matrix);

impl Reflection {
    /// Radiance of every sample in a light of R, G, B per cell.
    pub fn radiance(&self, light: &[f32]) -> Vec<[f32; CHANNELS]> {
        self.0.product(light)
    }

    /// The gradient by the light, if `value` makes of a sample and its [radiance](Self::radiance) the gradient
    /// by that; and what else it makes. In one pass over the rows, which are most of the bytes of a step.
    pub fn exchange<T: Send>(
        &self,
        light: &[f32],
        value: impl Fn(usize, [f32; CHANNELS]) -> ([f32; CHANNELS], T) + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        self.0.exchange(light, value)
    }
}

impl Transport {
    /// The highlights of samples with these [`SpecularTerm`] terms, in colour, for lights of the scale that has
    /// this `peak`, at a nearness per metre that may be another than what the rays were
    /// cast for. Takes samples x cells x 4 bytes.
    pub fn reflection(
        &self,
        skin: &SkinConfig,
        samples: &Samples,
        specular: &Planes,
        peak: f32,
        nearness: f32,
    ) -> Reflection {
        let (open, centres) = (&self.open, self.sky.centres());
        let (cells, lobes) = (self.cells(), self.lobes(LIGHT_EXPONENT));
        let mut rows = vec![0.0; samples.len() * cells];
        rows.par_chunks_mut(cells.max(1)).enumerate().for_each(|(i, row)| {
            cancel::check();
            let specular = SpecularTerm::at(specular, i);
            let scale = scale(skin, peak) * specular.reflectance;
            let skin = &specular.lobes_of(skin);
            for (cell, weight) in self.reflecting(skin, open, &centres, samples, i, nearness) {
                add_scaled(row, &lobes[cell * cells..][..cells], scale * weight);
            }
        });
        Reflection(Matrix { rows, cells })
    }

    /// Cells that a sample sees, each with the part of its light that the sample reflects towards its
    /// camera, times F0 / pi.
    fn reflecting<'a>(
        &'a self,
        skin: &'a SkinConfig,
        open: &'a Matrix,
        centres: &'a [Vec3],
        samples: &Samples,
        i: usize,
        nearness: f32,
    ) -> impl Iterator<Item = (usize, f32)> + 'a {
        let row = self.row_of(samples, i);
        let normal = Vec3::from_array(samples.normal.sample(i, 0));
        let view = Vec3::from_array(samples.view.sample(i, 0));
        let from = nearness * self.places[row];
        let cells = open.rows[row * self.cells()..].iter().zip(centres).enumerate();
        cells.filter(|(_, (open, _))| **open > 0.0).map(move |(cell, (open, centre))| {
            (cell, open * reflected(skin, normal, view, (*centre - from).normalize()))
        })
    }

    /// The row of the texel that a sample lies in, whatever the side of its taps.
    pub(super) fn row_of(&self, samples: &Samples, i: usize) -> usize {
        let (at, side) = (samples.taps.nearest(i), samples.taps.size());
        let texel = |x: usize| x * self.size / side;
        self.row[texel(at / side) * self.size + texel(at % side)] as usize
    }

    /// A light of R, G, B per cell, every cell seen through a power of the cosine.
    pub(super) fn through_lobes(&self, light: &[f32], exponent: i32) -> Vec<[f32; CHANNELS]> {
        Matrix { rows: self.lobes(exponent), cells: self.cells() }.product(light)
    }

    /// For every cell the weights of all cells in a lobe around it: rows of sum 1. Finer than that, the cells do
    /// not tell of the light.
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

/// From [`Transport::reflecting`] to radiance by the reflectance at normal incidence, in a light of this
/// peak.
pub(super) fn scale(skin: &SkinConfig, peak: f32) -> f32 {
    std::f32::consts::PI / (skin.f0 * peak.max(f32::MIN_POSITIVE))
}
