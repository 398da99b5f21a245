//! The diffuse albedo on the full pictures, under the light.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::confidence::{confidence, picture_weight};
use super::inpainting::inpaint_from_region;
use super::known::Known;
use super::light::JointEstimate;
use super::lighting::{Lighting, SHADING_ROWS, bent_shadings};
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
use crate::transport::{CHANNELS, GREEN, LIGHT_EXPONENT};

/// Least albedo by which errors and highlights are divided.
const LEAST_DIVISOR: f32 = 0.02;
/// Weight of the prior in hair that labels call skin, relative to skin: strands on skin vary more than hair or skin
/// alone. The fit has one weight of the prior for all texels, so the weights of these samples are divided by it.
const PRIOR_OF_HAIR_IN_SKIN: f32 = 0.33;
/// Side of the texture on which `albedo.prior` is stated, texels. The prior is a mean over texels of the differences
/// between neighbours. In skin they halve with the texels, and its weight grows with the side, so that it tends to an
/// integral. Strands of hair differ from texel to texel on any texture, and its weight is the same there.
const SIDE_OF_PRIOR: f32 = 512.0;
/// Standard deviation of the neighbourhood from which hair, brows and lips are inpainted, over the texture's side.
const INPAINTING_REACH: f32 = 0.117;

/// The unscaled diffuse albedo (see [`JointEstimate::albedo`]) and the confidence of every texel, 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct AlbedoEstimate {
    pub albedo: Vec<f32>,
    pub confidence: Vec<f32>,
}

/// Shading and highlights of the light on the relief, at samples.
pub(super) struct SampledLayers {
    /// S_d, R, G, B.
    pub shading: Planes,
    /// See [`Lighting::shading_with_derivative`].
    shading_with_derivative: Planes,
    /// Highlights, R, G, B, in the first rows.
    pub highlights: Planes,
}

impl SampledLayers {
    /// Evaluates the light on the normals of the relief and of its `blurred` deviation, both of the size of the
    /// samples' taps.
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
        let shading_with_derivative = lighting.shading_with_derivative(samples);
        let shading = bent_shadings(samples, &shading_with_derivative, &soft);
        let highlights = highlights.at(samples, &sharp);
        Self { shading, shading_with_derivative, highlights }
    }
}

/// The full pictures on the final texture.
pub(super) struct FullPictures<'a> {
    pub known: Known<'a>,
    pub samples: &'a Samples,
    pub face: &'a FaceRegions,
    /// The region of every texel.
    pub regions: &'a [u8],
}

/// Fits the diffuse albedo on the final texture.
pub(super) fn fit_albedo(
    run: &mut Run,
    name: &str,
    config: &UnshadeConfig,
    pictures: &FullPictures,
    lighting: &Lighting,
    joint: &JointEstimate,
    relief: &Relief,
) -> Result<AlbedoEstimate, SolveError> {
    let FullPictures { known, samples, face, regions } = *pictures;
    let size = samples.taps.size();
    let SampledLayers { shading, shading_with_derivative, highlights } =
        SampledLayers::new(run, lighting, &joint.terms, relief, &relief.blurred(), samples);
    let (shading, highlights) =
        (known.shading(samples, shading), known.highlights(samples, highlights));
    let target = Planes::from_fn::<CHANNELS>(samples.len(), |i| {
        std::array::from_fn(|c| samples.target.get(c, i) - highlights.get(c, i))
    });
    let mut diffuse = resample(&joint.albedo, lighting.size(), CHANNELS, size);
    let albedo = samples.taps.sample::<CHANNELS>(&diffuse);
    let model = Model {
        shading: &shading,
        shading_with_derivative: &shading_with_derivative,
        shadow_edges: &lighting.shadow_edges(samples),
        albedo: &albedo,
        target: &target,
    };
    let weight = model.weights(&config.model_error, lighting.fold_disagreement, samples);
    let known_parts = model.known_parts(&config.model_error, lighting.fold_disagreement);
    let weight = Planes::from_fn(samples.len(), |i| {
        let region = regions[samples.taps.nearest(i)];
        let factor = match region {
            hair if face.hair_in_skin.contains(&hair) => PRIOR_OF_HAIR_IN_SKIN.recip(),
            // Other regions vary too much for the prior.
            skin if face.skin.contains(&skin) => known_parts.get(0, i),
            _ => 1.0,
        };
        [factor * weight.get(0, i)]
    });
    // Only what the fit reads.
    let mut diffuse_samples = Samples {
        weight,
        target,
        taps: samples.taps.clone(),
        pixel: samples.pixel.clone(),
        ..Samples::none(size)
    };
    let prior_weight = config.albedo.prior;
    let picture_weights = picture_weight(prior_weight, &diffuse_samples, &shading);
    let reach = INPAINTING_REACH * size as f32;
    inpaint_from_region(&mut diffuse, regions, &face.skin, &picture_weights, reach);
    let relative_side = size as f32 / SIDE_OF_PRIOR;
    let weight = Planes::from_fn(diffuse_samples.len(), |i| {
        let region = regions[diffuse_samples.taps.nearest(i)];
        let is_skin = face.skin.is_empty() || face.skin.contains(&region);
        let factor = if is_skin { 1.0 } else { relative_side };
        [factor * diffuse_samples.weight.get(0, i)]
    });
    let weight = std::mem::replace(&mut diffuse_samples.weight, weight);
    let steps = AlbedoSteps {
        iterations: config.albedo.steps,
        prior_weight: prior_weight * relative_side,
        minimum: 0.0,
    };
    let adam = Adam::new(&AdamConfig::default(), config.albedo.rate, diffuse.len());
    let no_highlights = Planes::from_fn(diffuse_samples.len(), |i| {
        let [r, g, b]: [f32; CHANNELS] = shading.sample(i, 0);
        [r, g, b, 0.0]
    });
    let mut fit = AlbedoFit::new(steps, adam, &diffuse_samples, &no_highlights, diffuse);
    run.fit(name, &mut fit)?;
    let AlbedoFit { albedo, .. } = fit;
    diffuse_samples.weight = weight;
    let sampled = diffuse_samples.taps.sample::<CHANNELS>(&albedo);
    let confidence =
        confidence(prior_weight, &diffuse_samples, &samples.target, &shading, &sampled);
    Ok(AlbedoEstimate { albedo, confidence })
}

/// The error of the shading over its mean, independent of the brightness. Folds that agree to the bit were not fitted,
/// and carry no information.
fn shadow_error(errors: &ModelErrorConfig, fold_disagreement: f32) -> f32 {
    let error = errors.disagreement * fold_disagreement;
    if error > 0.0 { error.max(errors.shading) } else { errors.shadow }
}

/// The model of every sample before the albedo is fitted.
struct Model<'a> {
    shading: &'a Planes,
    /// See [`Lighting::shading_with_derivative`].
    shading_with_derivative: &'a Planes,
    /// See [`Lighting::shadow_edges`].
    shadow_edges: &'a Planes,
    albedo: &'a Planes,
    /// The pictures without highlights.
    target: &'a Planes,
}

impl Model<'_> {
    /// How much of the shading of every sample is known, 0 to 1: 1 / (1 + r^2)^2, where r is the error of the shading in
    /// shadow and at the edges of shadows over the shading. Errors in a shadow are alike in all of its samples, which
    /// together would outweigh any prior.
    fn known_parts(&self, errors: &ModelErrorConfig, fold_disagreement: f32) -> Planes {
        let shadow = shadow_error(errors, fold_disagreement) * self.mean_shading();
        Planes::from_fn(self.shading.len(), |i| {
            let error = shadow.hypot(self.shadow_edges.get(0, i));
            let relative = error / self.shading.get(GREEN, i).max(f32::MIN_POSITIVE);
            [(1.0 + relative * relative).recip().powi(2)]
        })
    }

    fn mean_shading(&self) -> f32 {
        let shadings = (0..self.shading.len()).map(|i| self.shading.get(GREEN, i));
        shadings.sum::<f32>() / self.shading.len().max(1) as f32
    }

    /// The weights of the samples over the error of the diffuse layer, which is the albedo times the error of the
    /// shading. The error of the shading is about as large in shadow as in light and grows with the disagreement of the
    /// folds ([`super::two_fold`]), with the shading's derivative and with the highlight. The prior therefore dominates
    /// where the error is large, and hair keeps its strands next to skin ten times as bright.
    fn weights(
        &self,
        errors: &ModelErrorConfig,
        fold_disagreement: f32,
        samples: &Samples,
    ) -> Planes {
        let count = samples.len().max(1) as f32;
        let mean = self.mean_shading();
        let shadow = shadow_error(errors, fold_disagreement);
        let albedo = |i: usize| self.albedo.get(GREEN, i).max(LEAST_DIVISOR);
        let mean_albedo = (0..samples.len()).map(albedo).sum::<f32>() / count;
        Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let shading: [f32; SHADING_ROWS] = self.shading_with_derivative.sample(i, 0);
            let slope = Vec3::from_slice(&shading[CHANNELS + 3 * GREEN..]);
            let slope = (slope - normal * normal.dot(slope)).length();
            let highlight = samples.target.get(GREEN, i) - self.target.get(GREEN, i);
            let errors_of_parts = [
                errors.shading * self.shading.get(GREEN, i),
                errors.normal * slope,
                errors.highlights * highlight / albedo(i),
                shadow * mean,
                self.shadow_edges.get(0, i),
            ];
            let error = errors_of_parts.map(|error| error * error).iter().sum::<f32>().sqrt();
            [samples.weight.get(0, i) * errors.shadow * mean / error * mean_albedo / albedo(i)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::UnshadeConfig;

    /// Weights and known parts of two samples, of these shadings and albedos, without highlights.
    fn weighed(shading: [f32; 2], albedo: [f32; 2], fold_disagreement: f32) -> [[f32; 2]; 2] {
        let planes = |values: [f32; 2]| Planes::from_fn(2, |i| [values[i]; CHANNELS]);
        let black = planes([0.0; 2]);
        let samples = Samples {
            normal: Planes::from_fn(2, |_| [0.0, 0.0, 1.0]),
            weight: Planes::from_fn(2, |_| [1.0]),
            target: black.clone(),
            pixel: vec![0; 2],
            ..Samples::none(2)
        };
        let flat = Planes::from_fn(2, |_| [0.0; SHADING_ROWS]);
        let (shading, albedo) = (planes(shading), planes(albedo));
        let model = Model {
            shading: &shading,
            shading_with_derivative: &flat,
            shadow_edges: &Planes::from_fn(2, |_| [0.0]),
            albedo: &albedo,
            target: &black,
        };
        let errors = UnshadeConfig::default().model_error;
        let weights = model.weights(&errors, fold_disagreement, &samples);
        let known = model.known_parts(&errors, fold_disagreement);
        [weights, known].map(|planes| [0, 1].map(|i| planes.get(0, i)))
    }

    fn weights(shading: [f32; 2], albedo: [f32; 2], fold_disagreement: f32) -> [f32; 2] {
        weighed(shading, albedo, fold_disagreement)[0]
    }

    #[test]
    fn skin_is_known_in_light_and_not_in_shadow() {
        let [_, [dark, lit]] = weighed([0.02, 1.98], [0.2; 2], 0.05);
        assert!(dark < 1e-4 && lit > 0.9, "{dark} {lit}");
        let [_, [dim, _]] = weighed([0.25, 1.75], [0.2; 2], 0.05);
        assert!((dim - 0.25).abs() < 1e-6, "as large an error as the shading: {dim}");
    }

    #[test]
    fn folds_that_agree_to_the_bit_are_no_evidence() {
        let [dark, lit] = weights([0.0, 2.0], [0.2; 2], 0.0);
        assert!((dark - 1.0).abs() < 1e-6 && (0.9..1.0).contains(&lit), "{dark} {lit}");
        // However little they differ, shading is never better known than where it is bright.
        let [dark, lit] = weights([0.0, 2.0], [0.2; 2], 1e-9);
        assert!((dark - 0.3 / 0.05).abs() < 1e-3 && lit < dark, "{dark} {lit}");
    }

    #[test]
    fn disagreement_strengthens_the_prior() {
        let of = |disagreement: f32| weights([1.0; 2], [0.2; 2], disagreement)[0];
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
