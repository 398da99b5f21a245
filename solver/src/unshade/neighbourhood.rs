//! Residuals in the neighbourhood of every sample: removal of components too coarse for relief, and lower weights where
//! residuals are too large for it.

use capture::gbuffer::GBuffer;
use glam::Vec3;

use super::linear_colour::SLOPES;
use crate::config::ReliefConfig;
use crate::convolution::Shape;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::view_weights::blurred;

/// Residuals below this radiance are penalised by their squares.
pub(super) const RESIDUAL_FLOOR: f32 = 0.002;
/// Standard deviation of the neighbourhood in which residuals are compared, over the side of a square as large as the
/// mesh in the view.
const NEIGHBOURHOOD: f32 = 0.018;
/// Its least standard deviation, pixels: a smaller neighbourhood would be the pixel itself.
const LEAST_NEIGHBOURHOOD: f32 = 3.0;
/// Standard deviation of the blur that gives the components too coarse for relief, over the same side.
const COARSEST: f32 = 0.075;
/// Pixels this close to the silhouette are left out: they mix two surfaces.
const RIM: usize = 2;

/// The samples at their pixels in the views.
pub(super) struct Neighbourhood<'a> {
    config: &'a ReliefConfig,
    samples: &'a Samples,
    views: &'a [GBuffer],
    /// Whether a sample lies farther than [`RIM`] from pixels without samples.
    inner: Vec<bool>,
}

impl<'a> Neighbourhood<'a> {
    pub fn new(config: &'a ReliefConfig, samples: &'a Samples, views: &'a [GBuffer]) -> Self {
        Self { config, samples, views, inner: inner(samples, views, RIM) }
    }

    /// The share of the mean squared residual around every sample that relief and paint of the usual strength can
    /// cause, at most 1. It is small at model errors: shadow edges, hairlines, ears. 0 on the rim.
    pub fn trust(&self, slopes: &Planes, residual: &Planes) -> Planes {
        let ReliefConfig { usual_deviation, usual_albedo_detail, .. } = *self.config;
        let floor = RESIDUAL_FLOOR;
        let squares = self.each(|i| {
            let s: [f32; SLOPES] = slopes.sample(i, 0);
            let residual: [f32; 3] = residual.sample(i, 0);
            let usual = |c: usize| {
                let slope = Vec3::from_slice(&s) + Vec3::from_slice(&s[3 + 3 * c..]);
                // On average, half of the squared deviation is along the slope.
                0.5 * usual_deviation * usual_deviation * slope.length_squared()
                    + (usual_albedo_detail * s[12 + c]).powi(2)
                    + floor * floor
            };
            [residual.iter().map(|z| z * z).sum(), (0..3).map(usual).sum(), 0.0]
        });
        let sigma = |side: f32| (NEIGHBOURHOOD * side).max(LEAST_NEIGHBOURHOOD);
        let around = self.around(&squares, sigma);
        Planes::from_fn(self.samples.len(), |i| {
            let [residual, usual]: [f32; 2] = around.sample(i, 0);
            let share = (usual / residual.max(f32::MIN_POSITIVE)).min(1.0);
            [if self.inner[i] { share } else { 0.0 }]
        })
    }

    /// `residual` (3 rows) without its part coarser than [`COARSEST`].
    pub fn without_coarse(&self, residual: &Planes) -> Planes {
        let coarse = self.around(residual, |side| COARSEST * side);
        self.each(|i| {
            let (fine, coarse): ([f32; 3], [f32; 3]) = (residual.sample(i, 0), coarse.sample(i, 0));
            std::array::from_fn(|c| fine[c] - coarse[c])
        })
    }

    fn each(&self, values: impl Fn(usize) -> [f32; 3] + Sync) -> Planes {
        Planes::from_fn(self.samples.len(), values)
    }

    /// Three rows of values, blurred over the inner pixels of each view; `sigma` in pixels, by the side of a square as
    /// large as the mesh in the view.
    fn around(&self, values: &Planes, sigma: impl Fn(f32) -> f32) -> Planes {
        // The values and the coverage of every view.
        let shape = |view: &GBuffer| Shape { width: view.width, height: view.height, channels: 4 };
        let mut pictures: Vec<Vec<f32>> =
            self.views.iter().map(|view| vec![0.0; 4 * view.width * view.height]).collect();
        for (i, (view, pixel)) in places(self.samples).enumerate().filter(|(i, _)| self.inner[*i]) {
            let [a, b, c]: [f32; 3] = values.sample(i, 0);
            pictures[view][4 * pixel..][..4].copy_from_slice(&[a, b, c, 1.0]);
        }
        for (picture, view) in pictures.iter_mut().zip(self.views) {
            *picture = blurred(picture, shape(view), sigma((view.len() as f32).sqrt()));
        }
        self.each(|i| {
            let (view, pixel) = (self.samples.view_index[i], self.samples.pixel[i]);
            let sums = &pictures[view as usize][4 * pixel as usize..][..4];
            let coverage = sums[3].max(f32::MIN_POSITIVE);
            std::array::from_fn(|row| sums[row] / coverage)
        })
    }
}

/// View and pixel of every sample.
fn places(samples: &Samples) -> impl Iterator<Item = (usize, usize)> {
    let pairs = samples.view_index.iter().zip(&samples.pixel);
    pairs.map(|(view, pixel)| (*view as usize, *pixel as usize))
}

/// Whether all pixels within `rim` of a sample's, horizontally, vertically and diagonally, are samples too. The
/// picture's border is not a rim.
fn inner(samples: &Samples, views: &[GBuffer], rim: usize) -> Vec<bool> {
    let mut covered: Vec<Vec<bool>> =
        views.iter().map(|view| vec![false; view.width * view.height]).collect();
    places(samples).for_each(|(view, pixel)| covered[view][pixel] = true);
    let is_inner = |(view, pixel): (usize, usize)| {
        let (width, height) = (views[view].width, views[view].height);
        let within = |at: usize, size: usize| at.saturating_sub(rim)..(at + rim + 1).min(size);
        within(pixel / width, height)
            .all(|y| within(pixel % width, width).all(|x| covered[view][y * width + x]))
    };
    places(samples).map(is_inner).collect()
}
