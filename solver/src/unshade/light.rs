//! The light, its distance, and what each region reflects of it.

use serde::{Deserialize, Serialize};

use super::explicit::{ExplicitModel, JointFit, exp};
use super::first_colours::FirstColours;
use super::recolour::recoloured;
use super::region_terms::{RegionTerms, evenness};
use super::two_fold::{TwoFoldLightFit, half_disagreement, mean};
use crate::config::UnshadeConfig;
use crate::model::samples::Samples;
use crate::run::Run;
use crate::run::error::SolveError;
use crate::transport::{CHANNELS, Transport, contrast};

/// The light under albedos that stay.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct LightEstimate {
    /// Logarithm of the light, R, G, B per cell.
    pub log_light: Vec<f32>,
    /// Likewise, by either half of the face; see [`super::two_fold`].
    pub halves: [Vec<f32>; 2],
    /// The mean absolute difference of the shadings by both halves over their mean; 0 before they are fitted.
    pub half_disagreement: f32,
    /// Inverse distance from the head's centre, per metre.
    pub nearness: f32,
    /// Reflectance, 0 to 1, off which light bounces: that of most of the face.
    pub bounce_albedo: f32,
    /// The specular terms of the regions.
    pub terms: RegionTerms,
    /// R, G, B by which the light has been multiplied to give it the colour of its highlights; the albedo that it was
    /// found with is to be divided by it.
    pub tint: [f32; CHANNELS],
}

impl LightEstimate {
    /// A sky of radiance 1 at infinity.
    pub fn even(cells: usize, bounce_albedo: f32, terms: RegionTerms) -> Self {
        let log_light = vec![0.0; CHANNELS * cells];
        Self {
            halves: [log_light.clone(), log_light.clone()],
            log_light,
            half_disagreement: 0.0,
            nearness: 0.0,
            bounce_albedo,
            terms,
            tint: [1.0; CHANNELS],
        }
    }
}

/// One round of the light and its distance from an estimate, `round` from 1. After each, the regions' reflectance is
/// measured by their highlights; after the last, the colour of the light.
pub(super) fn fit_light(
    run: &mut Run,
    config: &UnshadeConfig,
    far: &Transport,
    colours: &FirstColours,
    estimate: &LightEstimate,
    round: usize,
) -> Result<LightEstimate, SolveError> {
    if run.is_interrupted() {
        return Ok(estimate.clone());
    }
    let samples = colours.of_skin();
    let terms = estimate.terms.texture(colours.regions);
    let nearness = estimate.nearness;
    let model = |samples: &Samples, log_light: &[f32]| {
        ExplicitModel::new(config, far, samples, &terms, &exp(log_light), nearness)
    };
    let mut fit = TwoFoldLightFit::new(
        config,
        &samples,
        colours.albedo,
        &estimate.halves,
        nearness / far.near(),
        config.light.steps_of(round),
        model,
    );
    run.fit(&format!("light {round}"), &mut fit)?;
    let (halves, nearer) = fit.best();
    let log_light = mean(&halves);
    let light = exp(&log_light);
    let model = model(&samples, &estimate.log_light);
    let weight = colours.samples.thinned(config.light.samples).weight;
    let evenness = evenness(contrast(config.transport.rows, &light));
    let errors = Some(&config.model_error);
    let regression = model.regression(&light, nearer, colours.albedo, &weight, errors);
    let factor = relative_peak(far, &light, &exp(&estimate.log_light));
    let terms = estimate.terms.relative_to(factor).with_reflectance(
        &config.reflectance,
        evenness,
        &regression,
        colours.regions,
    );
    let tint = match round == config.light.rounds {
        true => model.tint(&light, nearer, colours.albedo),
        false => [1.0; CHANNELS],
    };
    let tinted = |values: &[f32], apply: &dyn Fn(f32, f32) -> f32| -> Vec<f32> {
        values.iter().zip(tint.iter().cycle()).map(|(value, tint)| apply(*value, *tint)).collect()
    };
    let log_light = tinted(&log_light, &|log, tint| log + tint.ln());
    let albedo = tinted(colours.albedo, &|albedo, tint| albedo / tint);
    Ok(LightEstimate {
        half_disagreement: half_disagreement(far, &halves, nearer),
        halves,
        nearness: nearer * far.near(),
        bounce_albedo: bounce_albedo(far, &exp(&log_light), &albedo),
        log_light,
        terms,
        tint,
    })
}

/// The median over texels of the mean reflectance of R, G and B under a light: what light bounces off.
fn bounce_albedo(transport: &Transport, light: &[f32], albedo: &[f32]) -> f32 {
    let mut means: Vec<f32> =
        albedo.chunks_exact(CHANNELS).map(|rgb| rgb.iter().sum::<f32>() / 3.0).collect();
    let middle = means.len() / 2;
    let (_, median, _) = means.select_nth_unstable_by(middle, f32::total_cmp);
    (*median * transport.peak(light)).min(1.0)
}

/// The peak of a light over that of another; 1 if either is black.
fn relative_peak(transport: &Transport, light: &[f32], other: &[f32]) -> f32 {
    let [peak, other] = [light, other].map(|light| transport.peak(light));
    if peak > 0.0 && other > 0.0 { peak / other } else { 1.0 }
}

/// Light and diffuse albedo together.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct JointEstimate {
    /// Logarithm of the light, R, G, B per cell.
    pub log_light: Vec<f32>,
    /// R, G, B per texel of the transport.
    pub albedo: Vec<f32>,
    /// The specular terms relative to this light.
    pub terms: RegionTerms,
}

/// Light and diffuse albedo under the transport from the light's distance, with a prior on grey light: a tint of the
/// light and one of the skin look alike in diffuse shading, until highlights are explained.
pub(super) fn fit_light_and_albedo(
    run: &mut Run,
    config: &UnshadeConfig,
    near: &Transport,
    colours: &FirstColours,
    estimate: &LightEstimate,
) -> Result<JointEstimate, SolveError> {
    let light = exp(&estimate.log_light);
    let tint = estimate.tint.iter().cycle();
    let albedo: Vec<f32> = colours.albedo.iter().zip(tint).map(|(a, tint)| a / tint).collect();
    if run.is_interrupted() {
        let (log_light, terms) = (estimate.log_light.clone(), estimate.terms.clone());
        return Ok(JointEstimate { log_light, albedo, terms });
    }
    let albedo =
        recoloured(run.backend, &config.skin, near, colours, &light, &estimate.terms, albedo);
    let terms = estimate.terms.texture(colours.regions);
    let model =
        ExplicitModel::new(config, near, colours.samples, &terms, &light, estimate.nearness);
    let model = model.with_grey_prior(true);
    let (steps, log_light) = (config.joint.grey_steps, estimate.log_light.clone());
    let mut fit = JointFit::new(config, model, steps, log_light, albedo);
    run.fit("joint, grey light", &mut fit)?;
    Ok(joint_estimate(near, fit, &light, &estimate.terms))
}

/// Light and diffuse albedo from an estimate of both, without a prior on the light's colour.
pub(super) fn refit_light_and_albedo(
    run: &mut Run,
    config: &UnshadeConfig,
    near: &Transport,
    colours: &FirstColours,
    estimate: &LightEstimate,
    joint: &JointEstimate,
) -> Result<JointEstimate, SolveError> {
    if run.is_interrupted() {
        return Ok(joint.clone());
    }
    let (light, terms) = (exp(&joint.log_light), joint.terms.texture(colours.regions));
    let model =
        ExplicitModel::new(config, near, colours.samples, &terms, &light, estimate.nearness);
    let (log_light, albedo) = (joint.log_light.clone(), joint.albedo.clone());
    let mut fit = JointFit::new(config, model, config.joint.steps, log_light, albedo);
    run.fit("joint", &mut fit)?;
    Ok(joint_estimate(near, fit, &light, &joint.terms))
}

/// The estimate of a fit from a `light` with these terms.
fn joint_estimate(
    near: &Transport,
    fit: JointFit,
    light: &[f32],
    terms: &RegionTerms,
) -> JointEstimate {
    let JointFit { log_light, albedo, .. } = fit;
    let terms = terms.relative_to(relative_peak(near, &exp(&log_light), light));
    JointEstimate { log_light, albedo, terms }
}
