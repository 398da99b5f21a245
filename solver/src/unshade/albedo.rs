//! The diffuse albedo on the full pictures, under the light.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::confidence::{confidence, picture_weight};
use super::inpainting::inpaint_from_region;
use super::lighting::{Lighting, SHADING_ROWS, bent_shading};
use super::region_terms::RegionTerms;
use super::relief::Relief;
use crate::config::{AdamConfig, ModelErrorConfig, UnshadeConfig};
use crate::fit::adam::Adam;
use crate::fit::albedo::{AlbedoFit, AlbedoSteps};
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::resample;
use crate::run::Run;
use crate::run::error::SolveError;
use crate::semantic::regions::FaceRegions;
use crate::transport::{CHANNELS, LIGHT_EXPONENT};

/// The channel by which a pixel is weighed.
const GREEN: usize = 1;
/// Diffuse albedo that counts as the least where errors or highlights are compared with it.
const DARKEST_ALBEDO: f32 = 0.02;
/// Weight of the prior in hair that labels call skin, relative to skin's: strands on skin vary more than either.
const PRIOR_OF_HAIR_IN_SKIN: f32 = 0.33;
/// Standard deviation of the neighbourhood by which hair, brows and lips begin where pictures hardly show them, texels.
const INPAINTING_REACH: f32 = 60.0;

/// The diffuse albedo, in units of 1 / S_d, and the confidence in every texel, 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct AlbedoEstimate {
    pub albedo: Vec<f32>,
    pub confidence: Vec<f32>,
}

/// Shading and highlights of the light on relief, at samples.
pub(super) struct Layers {
    /// S_d, R, G, B.
    pub shading: Planes,
    /// See [`Lighting::sampled`].
    changes: Planes,
    /// R, G, B in its first rows.
    pub highlights: Planes,
}

impl Layers {
    /// Under the normals of the relief, whose side is that of the samples' taps.
    pub fn new(
        run: &Run,
        lighting: &Lighting,
        terms: &RegionTerms,
        relief: &Relief,
        blurred: &[f32],
        samples: &Samples,
    ) -> Self {
        let sharp = samples.taps.sample::<3>(&relief.deviation);
        let soft = samples.taps.sample::<3>(blurred);
        let highlights = lighting.highlights(run.backend, terms, samples, LIGHT_EXPONENT);
        let changes = lighting.sampled(samples);
        let shading = Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let bent = (normal + Vec3::from_array(soft.sample(i, 0))).normalize();
            bent_shading(&changes.sample(i, 0), normal, bent)
        });
        Self { shading, highlights: highlights.at(samples, &sharp), changes }
    }
}

/// The full pictures on the final texture.
pub(super) struct FullPictures<'a> {
    pub samples: &'a Samples,
    pub face: &'a FaceRegions,
    /// The region of every texel.
    pub regions: &'a [u8],
}

/// The diffuse albedo on the final texture.
pub(super) fn fit_albedo(
    run: &mut Run,
    config: &UnshadeConfig,
    pictures: &FullPictures,
    lighting: &Lighting,
    terms: &RegionTerms,
    relief: &Relief,
) -> Result<AlbedoEstimate, SolveError> {
    let FullPictures { samples, face, regions } = *pictures;
    let size = samples.taps.size();
    let Layers { shading, changes, highlights } =
        Layers::new(run, lighting, terms, relief, &relief.blurred(), samples);
    let target = Planes::from_fn::<CHANNELS>(samples.len(), |i| {
        std::array::from_fn(|c| samples.target.get(c, i) - highlights.get(c, i))
    });
    let mut diffuse = resample(&lighting.albedo, lighting.size(), CHANNELS, size);
    let albedo = samples.taps.sample::<CHANNELS>(&diffuse);
    let model = Model { shading: &shading, changes: &changes, albedo: &albedo, target: &target };
    let weight = model.weights(&config.model_error, lighting.half_disagreement, samples);
    let weight = Planes::from_fn(samples.len(), |i| {
        let hair = face.hair_in_skin.contains(&regions[samples.taps.nearest(i)]);
        [weight.get(0, i) / if hair { PRIOR_OF_HAIR_IN_SKIN } else { 1.0 }]
    });
    // What the fit reads, and no more.
    let rest = Samples {
        weight,
        target,
        taps: samples.taps.clone(),
        pixel: samples.pixel.clone(),
        ..Samples::none(size)
    };
    let prior = config.albedo.prior;
    let picture_weights = picture_weight(prior, &rest, &shading);
    inpaint_from_region(&mut diffuse, regions, &face.skin, &picture_weights, INPAINTING_REACH);
    let steps = AlbedoSteps { iterations: config.albedo.steps, prior, minimum: 0.0 };
    let by_albedo = Adam::new(&AdamConfig::default(), config.albedo.rate, diffuse.len());
    let no_highlights = Planes::from_fn(rest.len(), |i| {
        let [r, g, b]: [f32; CHANNELS] = shading.sample(i, 0);
        [r, g, b, 0.0]
    });
    let mut fit = AlbedoFit::new(steps, by_albedo, &rest, &no_highlights, diffuse);
    run.fit("albedo", &mut fit)?;
    let albedo = rest.taps.sample::<CHANNELS>(&fit.albedo);
    let confidence = confidence(prior, &rest, &samples.target, &shading, &albedo);
    Ok(AlbedoEstimate { albedo: fit.albedo, confidence })
}

/// Error of the shading over its mean, in any light. Halves that agree to the bit were not fitted, which is no
/// evidence.
fn shadow_error(errors: &ModelErrorConfig, half_disagreement: f32) -> f32 {
    let apart = errors.disagreement * half_disagreement;
    if apart > 0.0 { apart.max(errors.shading) } else { errors.shadow }
}

/// The model of every sample before the albedo is fitted.
struct Model<'a> {
    shading: &'a Planes,
    /// See [`Lighting::sampled`].
    changes: &'a Planes,
    albedo: &'a Planes,
    /// The pictures without highlights.
    target: &'a Planes,
}

impl Model<'_> {
    /// The weights of the samples, over the error of the layer that explains them: the albedo times the error of its
    /// shading. Shading errs by about as much in shadow as in light, and by the more the more the lights of both
    /// halves of the face disagree ([`super::two_fold`]); by more where normals matter and highlights are strong. So
    /// the prior is strong where a light explains little, and hair keeps its strands beside skin that is ten times as
    /// bright.
    fn weights(
        &self,
        errors: &ModelErrorConfig,
        half_disagreement: f32,
        samples: &Samples,
    ) -> Planes {
        let count = samples.len().max(1) as f32;
        let mean = (0..samples.len()).map(|i| self.shading.get(GREEN, i)).sum::<f32>() / count;
        let shadow = shadow_error(errors, half_disagreement);
        let albedo = |i: usize| self.albedo.get(GREEN, i).max(DARKEST_ALBEDO);
        let usual = (0..samples.len()).map(albedo).sum::<f32>() / count;
        Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let changes: [f32; SHADING_ROWS] = self.changes.sample(i, 0);
            let change = Vec3::from_slice(&changes[CHANNELS + 3 * GREEN..]);
            let change = (change - normal * normal.dot(change)).length();
            let highlight = samples.target.get(GREEN, i) - self.target.get(GREEN, i);
            let squares = [
                errors.shading * self.shading.get(GREEN, i),
                errors.normal * change,
                errors.highlights * highlight / albedo(i),
                shadow * mean,
            ];
            let error = squares.map(|error| error * error).iter().sum::<f32>().sqrt();
            [samples.weight.get(0, i) * errors.shadow * mean / error * usual / albedo(i)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::UnshadeConfig;

    /// Weights of two samples, of these shadings and albedos, without highlights.
    fn weights(shading: [f32; 2], albedo: [f32; 2], half_disagreement: f32) -> [f32; 2] {
        let planes = |values: [f32; 2]| Planes::from_fn(2, |i| [values[i]; CHANNELS]);
        let black = planes([0.0; 2]);
        let samples = Samples {
            normal: Planes::from_fn(2, |_| [0.0, 0.0, 1.0]),
            weight: Planes::from_fn(2, |_| [1.0]),
            target: black.clone(),
            pixel: vec![0; 2],
            ..Samples::none(2)
        };
        let changes = Planes::from_fn(2, |_| [0.0; SHADING_ROWS]);
        let (shading, albedo) = (planes(shading), planes(albedo));
        let model = Model { shading: &shading, changes: &changes, albedo: &albedo, target: &black };
        let weights =
            model.weights(&UnshadeConfig::default().model_error, half_disagreement, &samples);
        [0, 1].map(|i| weights.get(0, i))
    }

    #[test]
    fn halves_that_agree_to_the_bit_are_no_evidence() {
        let [dark, lit] = weights([0.0, 2.0], [0.2; 2], 0.0);
        assert!((dark - 1.0).abs() < 1e-6 && (0.9..1.0).contains(&lit), "{dark} {lit}");
        // However little they differ, shading is never better known than where it is bright.
        let [dark, lit] = weights([0.0, 2.0], [0.2; 2], 1e-9);
        assert!((dark - 0.3 / 0.05).abs() < 1e-3 && lit < dark, "{dark} {lit}");
    }

    #[test]
    fn disagreement_strengthens_the_prior() {
        let of = |apart: f32| weights([1.0; 2], [0.2; 2], apart)[0];
        assert!(of(0.02) > 1.5 * of(0.06) && of(0.06) > 1.5 * of(0.2));
    }

    #[test]
    fn residuals_are_relative_to_the_albedo() {
        let [hair, skin] = weights([1.0; 2], [0.04, 0.4], 0.03);
        assert!((hair / skin - 10.0).abs() < 1e-4, "{hair} {skin}");
        let [black, least] = weights([1.0; 2], [0.0, 0.02], 0.03);
        assert!((black / least - 1.0).abs() < 1e-6, "{black} {least}");
    }
}
