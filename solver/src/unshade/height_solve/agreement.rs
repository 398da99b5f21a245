//! Cross-validation of relief with views to which it was not fitted.

use super::super::neighbourhood::RESIDUAL_FLOOR;
use super::HeightProblem;
use crate::model::planes::Planes;
use crate::unshade::linear_colour::UNKNOWNS;

/// Weighted sums per texel: the products of the diffuse layer's basis with the relief's highlights (R, G, B), with the
/// pictures' specular part (R, G, B), and with itself (R, G, B).
const MEANS: usize = 9;

impl HeightProblem<'_> {
    /// The agreement of the samples with relief `x` that was fitted to other views: the weighted sums of p r and p^2,
    /// with the change p of the highlights by the relief and the specular part r of the pictures. From both, the mean
    /// over the views of a texel is subtracted, which removes paint: only highlights move with the view. Under several
    /// illuminations paint is in proportion to the shading, onto which the projection is subtracted.
    pub(in crate::unshade) fn agreement(&self, x: &[f32]) -> [f64; 2] {
        let highlights = &self.highlights;
        let samples = self.samples;
        let (slopes, _) = self.linearise(x);
        let unknowns = self.sampled(x);
        let flat = highlights.at(samples, &Planes::new(UNKNOWNS, samples.len()));
        let bent = highlights.at(samples, &unknowns);
        let relief = Planes::from_fn(samples.len(), |i| {
            std::array::from_fn::<f32, 3, _>(|c| bent.get(c, i) - flat.get(c, i))
        });
        let picture = Planes::from_fn(samples.len(), |i| {
            std::array::from_fn::<f32, 3, _>(|c| {
                let diffuse = slopes.get(12 + c, i) * (1.0 + unknowns.get(6 + c, i));
                samples.target.get(c, i) - diffuse - flat.get(c, i)
            })
        });
        drop((flat, bent, unknowns));
        let basis = |i: usize| -> [f32; 3] {
            if self.has_one_illumination {
                [1.0; 3]
            } else {
                self.shading_with_derivative.sample(i, 0)
            }
        };
        let (relief, picture) = (
            self.neighbourhood.without_coarse(&relief),
            self.neighbourhood.without_coarse(&picture),
        );
        let residual = Planes::from_fn(samples.len(), |i| {
            std::array::from_fn::<f32, 3, _>(|c| picture.get(c, i) - relief.get(c, i))
        });
        let trust = self.neighbourhood.trust(&slopes, &residual);
        let weight = |i: usize| trust.get(0, i) * samples.weight.get(0, i);
        let rows = Planes::from_fn(samples.len(), |i| {
            let (relief, picture): ([f32; 3], [f32; 3]) =
                (relief.sample(i, 0), picture.sample(i, 0));
            let basis = basis(i);
            let product = |values: [f32; 3], c: usize| weight(i) * values[c] * basis[c];
            std::array::from_fn::<f32, MEANS, _>(|row| match (row / 3, row % 3) {
                (0, c) => product(relief, c),
                (1, c) => product(picture, c),
                (_, c) => product(basis, c),
            })
        });
        let taps = &samples.taps;
        let means = taps.sample::<MEANS>(&taps.gather::<MEANS>(&rows, 0));
        let mut sums = [0.0; 2];
        for i in 0..samples.len() {
            let means: [f32; MEANS] = means.sample(i, 0);
            let basis = basis(i);
            let mean = |row: usize, c: usize| {
                basis[c] * (means[row + c] / means[6 + c].max(f32::MIN_POSITIVE))
            };
            let residual = residual.sample::<3>(i, 0).iter().map(|z| z.abs()).sum::<f32>() / 3.0;
            let weight = weight(i) / residual.max(RESIDUAL_FLOOR);
            for c in 0..3 {
                let relief = relief.get(c, i) - mean(0, c);
                sums[0] += f64::from(weight * relief * (picture.get(c, i) - mean(3, c)));
                sums[1] += f64::from(weight * relief * relief);
            }
        }
        sums
    }
}
