//! Residuals in the neighbourhood of every sample: those that are too coarse for relief, and those that are too large.

use capture::gbuffer::GBuffer;
use glam::Vec3;

use super::linear_colour::SLOPES;
use crate::config::HeightConfig;
use crate::convolution::Shape;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::view_weights::blurred;

/// The samples in the pictures that they come from.
pub(super) struct Nearby<'a> {
    config: &'a HeightConfig,
    samples: &'a Samples,
    views: &'a [GBuffer],
    /// Whether a sample lies farther inside its view's samples than [`HeightConfig::rim`].
    inner: Vec<bool>,
}

impl<'a> Nearby<'a> {
    pub fn new(config: &'a HeightConfig, samples: &'a Samples, views: &'a [GBuffer]) -> Self {
        Self { config, samples, views, inner: inner(samples, views, config.rim) }
    }

    /// The share of `left` around every sample that relief and paint of the usual strength would explain,
    /// at most 1: the rest is what the model gets wrong, along shadow edges and hairlines and in the ears.
    /// 0 on the rim.
    pub fn trust(&self, slopes: &Planes, left: &Planes) -> Planes {
        let HeightConfig { residual_floor: floor, usual_deviation, usual_albedo_detail, .. } =
            *self.config;
        let squares = self.each(|i| {
            let (s, left): ([f32; SLOPES], [f32; 3]) = (slopes.sample(i, 0), left.sample(i, 0));
            let usual = |c: usize| {
                let slope = Vec3::from_slice(&s) + Vec3::from_slice(&s[3 + 3 * c..]);
                // Half of a deviation's square lies along the slope.
                0.5 * usual_deviation * usual_deviation * slope.length_squared()
                    + (usual_albedo_detail * s[12 + c]).powi(2)
                    + floor * floor
            };
            [left.iter().map(|z| z * z).sum(), (0..3).map(usual).sum(), 0.0]
        });
        let around = self.around(&squares, |_| self.config.neighbourhood);
        Planes::from_fn(self.samples.len(), |i| {
            let [left, usual]: [f32; 2] = around.sample(i, 0);
            let share = (usual / left.max(f32::MIN_POSITIVE)).min(1.0);
            [if self.inner[i] { share } else { 0.0 }]
        })
    }

    /// `residual` (3 rows) less what of it is coarser than [`HeightConfig::coarsest`].
    pub fn without_coarse(&self, residual: &Planes) -> Planes {
        let share = self.config.coarsest;
        if share == 0.0 {
            return residual.clone();
        }
        let coarse = self.around(residual, |view| share * (view.len() as f32).sqrt());
        self.each(|i| {
            let (fine, coarse): ([f32; 3], [f32; 3]) = (residual.sample(i, 0), coarse.sample(i, 0));
            std::array::from_fn(|c| fine[c] - coarse[c])
        })
    }

    /// Mostly the smaller of two residuals (3 rows), sample by sample: each is weighted by the other's mean
    /// square around the sample.
    pub fn smaller(&self, a: &Planes, b: &Planes) -> Planes {
        let square =
            |of: &Planes, i: usize| of.sample::<3>(i, 0).iter().map(|z| z * z).sum::<f32>();
        let squares = self.each(|i| [square(a, i), square(b, i), 0.0]);
        let around = self.around(&squares, |_| self.config.neighbourhood);
        self.each(|i| {
            let [by_a, by_b]: [f32; 2] = around.sample(i, 0);
            let share = by_b / (by_a + by_b).max(f32::MIN_POSITIVE);
            std::array::from_fn(|c| share * a.get(c, i) + (1.0 - share) * b.get(c, i))
        })
    }

    fn each(&self, values: impl Fn(usize) -> [f32; 3] + Sync) -> Planes {
        Planes::from_fn(self.samples.len(), values)
    }

    /// Three rows of values, blurred over the inner pixels of every view by `sigma` pixels of its.
    fn around(&self, values: &Planes, sigma: impl Fn(&GBuffer) -> f32) -> Planes {
        // The values and the cover of every view.
        let shape = |view: &GBuffer| Shape { width: view.width, height: view.height, channels: 4 };
        let mut pictures: Vec<Vec<f32>> =
            self.views.iter().map(|view| vec![0.0; 4 * view.width * view.height]).collect();
        for (i, (view, pixel)) in places(self.samples).enumerate().filter(|(i, _)| self.inner[*i]) {
            let [a, b, c]: [f32; 3] = values.sample(i, 0);
            pictures[view][4 * pixel..][..4].copy_from_slice(&[a, b, c, 1.0]);
        }
        for (picture, view) in pictures.iter_mut().zip(self.views) {
            *picture = blurred(picture, shape(view), sigma(view));
        }
        self.each(|i| {
            let (view, pixel) = (self.samples.view_index[i], self.samples.pixel[i]);
            let sums = &pictures[view as usize][4 * pixel as usize..][..4];
            let cover = sums[3].max(f32::MIN_POSITIVE);
            std::array::from_fn(|row| sums[row] / cover)
        })
    }
}

/// View and pixel of every sample.
fn places(samples: &Samples) -> impl Iterator<Item = (usize, usize)> {
    let pairs = samples.view_index.iter().zip(&samples.pixel);
    pairs.map(|(view, pixel)| (*view as usize, *pixel as usize))
}

/// Whether all pixels of a view within `rim` of a sample's, to the sides and diagonally, are samples too.
/// The picture's own edge is no rim.
fn inner(samples: &Samples, views: &[GBuffer], rim: usize) -> Vec<bool> {
    let mut covered: Vec<Vec<bool>> =
        views.iter().map(|view| vec![false; view.width * view.height]).collect();
    places(samples).for_each(|(view, pixel)| covered[view][pixel] = true);
    let alone = |(view, pixel): (usize, usize)| {
        let (width, height) = (views[view].width, views[view].height);
        let within = |at: usize, size: usize| at.saturating_sub(rim)..(at + rim + 1).min(size);
        within(pixel / width, height)
            .all(|y| within(pixel % width, width).all(|x| covered[view][y * width + x]))
    };
    places(samples).map(alone).collect()
}
