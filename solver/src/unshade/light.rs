//! The light, its distance, and the specular reflectance per region.

use serde::{Deserialize, Serialize};

use super::explicit::{ExplicitModel, exp};
use super::explicit_fits::JointFit;
use super::illuminations::Illuminations;
use super::light_fit_data::LightFitData;
use super::region_terms::{RegionTerms, uniformity};
use super::tint::without_tint;
use super::two_fold::{TwoFoldLightFit, fold_disagreement, mean};
use crate::config::UnshadeConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::run::Run;
use crate::run::error::SolveError;
use crate::transport::{CHANNELS, Transport};

/// The light under albedos that are held fixed.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct LightEstimate {
    /// Logarithm of the radiance, R, G, B per cell of every group.
    pub log_light: Vec<f32>,
    /// The log radiance fitted to each fold of the face; see [`super::two_fold`].
    pub folds: [Vec<f32>; 2],
    /// The mean absolute deviation of the shadings of both folds from their mean, over that mean; 0 before the fit.
    pub fold_disagreement: f32,
    /// Inverse distance from the head's centre, per metre.
    pub nearness_per_metre: f32,
    /// The albedo of bounces, 0 to 1: the median of the face.
    pub bounce_albedo: f32,
    /// The specular terms of the regions.
    pub terms: RegionTerms,
    /// The factors on R, G, B that gave the light the colour of its highlights. The albedo of the fit is still to be
    /// divided by them.
    pub tint: [f32; CHANNELS],
}

impl LightEstimate {
    /// Skies of radiance 1 at infinity, of this number of cells in all.
    pub fn uniform(cells: usize, bounce_albedo: f32, terms: RegionTerms) -> Self {
        let log_light = vec![0.0; CHANNELS * cells];
        Self {
            folds: [log_light.clone(), log_light.clone()],
            log_light,
            fold_disagreement: 0.0,
            nearness_per_metre: 0.0,
            bounce_albedo,
            terms,
            tint: [1.0; CHANNELS],
        }
    }
}

/// Fits the light and its distance in one round from an estimate, `round` from 1. After each round the reflectance of
/// the regions is estimated from their highlights; after the last, the colour of the light.
pub(super) fn fit_light(
    run: &mut Run,
    name: &str,
    config: &UnshadeConfig,
    far: &Transport,
    data: &LightFitData,
    estimate: &LightEstimate,
    round: usize,
) -> Result<LightEstimate, SolveError> {
    let nearness_per_metre = estimate.nearness_per_metre;
    let (lights, samples) = (&data.illuminations.around(far), data.samples_of_skin());
    let terms = estimate.terms.texture(data.regions);
    let model = |samples: &Samples, log_light: &[f32]| {
        let light = exp(log_light);
        ExplicitModel::new(config, far, lights, samples, &terms, &light, nearness_per_metre)
    };
    let mut fit = TwoFoldLightFit::new(
        config,
        &samples,
        data.region_colours,
        &estimate.folds,
        nearness_per_metre / far.nearness_unit(),
        config.light.steps_of(round),
        model,
    );
    let (folds, relative_nearness) = match data.known.light(far, lights, config.transport.rows) {
        Some((log_light, nearness)) => {
            ([log_light.clone(), log_light], nearness / far.nearness_unit())
        }
        None => {
            run.fit(name, &mut fit)?;
            fit.into_best()
        }
    };
    let log_light = mean(&folds);
    let light = exp(&log_light);
    let model = model(&samples, &estimate.log_light);
    // The weights of all regions. They align with the model's samples, since `samples_of_skin` changes weights alone
    // and `thinned` chooses samples by their number alone.
    let weight = data.samples.thinned(config.light.samples).weight;
    let factor = relative_peak(far, lights, &light, &exp(&estimate.log_light));
    let highlights =
        Highlights { model: &model, light: &light, relative_nearness, albedo: data.region_colours };
    let terms = highlights.terms(config, data, &weight, &estimate.terms.relative_to(factor));
    let has_light = data.known.has_light();
    let tint = match round == config.light.rounds && !has_light {
        true => model.tint(&light, relative_nearness, data.region_colours),
        false => [1.0; CHANNELS],
    };
    let cells = log_light.iter().zip(tint.iter().cycle());
    let log_light: Vec<f32> = cells.map(|(log, tint)| log + tint.ln()).collect();
    let albedo = without_tint(data.region_colours, &tint);
    Ok(LightEstimate {
        fold_disagreement: fold_disagreement(far, lights, &folds, relative_nearness),
        folds,
        nearness_per_metre: relative_nearness * far.nearness_unit(),
        bounce_albedo: bounce_albedo(lights.peak(far, &exp(&log_light)), &albedo),
        log_light,
        terms,
        tint,
    })
}

/// The albedo of bounces under lights of this peak: the median over texels of the mean reflectance of R, G and B.
fn bounce_albedo(peak: f32, albedo: &[f32]) -> f32 {
    let mut means: Vec<f32> =
        albedo.chunks_exact(CHANNELS).map(|rgb| rgb.iter().sum::<f32>() / 3.0).collect();
    let middle = means.len() / 2;
    let (_, median, _) = means.select_nth_unstable_by(middle, f32::total_cmp);
    (*median * peak).min(1.0)
}

/// The [peak](Illuminations::peak) of lights over that of others; 1 if either is black.
fn relative_peak(
    transport: &Transport,
    illuminations: &Illuminations,
    light: &[f32],
    other: &[f32],
) -> f32 {
    let [peak, other] = [light, other].map(|light| illuminations.peak(transport, light));
    if peak > 0.0 && other > 0.0 { peak / other } else { 1.0 }
}

/// Light and diffuse albedo together.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct JointEstimate {
    /// Logarithm of the radiance, R, G, B per cell of every group.
    pub log_light: Vec<f32>,
    /// The unscaled diffuse albedo, R, G, B per texel of the transport. Radiance x
    /// [`Scene::picture_scale`](crate::scene::Scene::picture_scale) = albedo x S_d; times
    /// [`Scales::diffuse`](crate::maps::Scales::diffuse) the albedo is a reflectance.
    pub albedo: Vec<f32>,
    /// Inverse distance of the light from the head's centre, per metre.
    pub nearness_per_metre: f32,
    /// The specular terms relative to this light.
    pub terms: RegionTerms,
}

impl JointEstimate {
    /// The estimated light, and the colours of the regions without its tint.
    pub fn new(light: &LightEstimate, region_colours: &[f32]) -> Self {
        Self {
            log_light: light.log_light.clone(),
            albedo: without_tint(region_colours, &light.tint),
            nearness_per_metre: light.nearness_per_metre,
            terms: light.terms.clone(),
        }
    }
}

/// Fits light and diffuse albedo under the transport from the light's distance. The grey prior is for the first fit: a
/// tint of the light and one of the skin look alike in diffuse shading until highlights are explained.
///
/// Lights that change tell shading from albedo. With the derivative of the `near` transport, the distance and the colour
/// of the light and the reflectance of the regions are estimated again, now from an albedo of each texel.
pub(super) fn fit_joint(
    run: &mut Run,
    name: &str,
    config: &UnshadeConfig,
    near: &Transport,
    data: &LightFitData,
    start: JointEstimate,
    has_grey_prior: bool,
) -> Result<JointEstimate, SolveError> {
    let JointEstimate { log_light, albedo, terms, nearness_per_metre } = start;
    let lights = &data.illuminations.around(near);
    let model = |terms: &RegionTerms, light: &[f32]| {
        let texture = terms.texture(data.regions);
        let nearness = near.nearness_per_metre();
        ExplicitModel::new(config, near, lights, data.samples, &texture, light, nearness)
    };
    let light = exp(&log_light);
    let steps = if has_grey_prior { config.joint.grey_steps } else { config.joint.steps };
    let start = model(&terms, &light).with_grey_prior(has_grey_prior);
    let mut fit = JointFit::new(config, start, steps, log_light, albedo);
    run.fit(name, &mut fit)?;
    let JointFit { mut log_light, mut albedo, relative_nearness, .. } = fit;
    let new = exp(&log_light);
    let mut terms = terms.relative_to(relative_peak(near, lights, &new, &light));
    if near.has_nearness() && !data.known.has_light() {
        let model = model(&terms, &new);
        let relative_nearness = relative_nearness[0];
        let highlights =
            Highlights { model: &model, light: &new, relative_nearness, albedo: &albedo };
        terms = highlights.terms(config, data, &model.samples.weight, &terms);
        let tint = model.tint(&new, relative_nearness, &albedo);
        log_light.iter_mut().zip(tint.iter().cycle()).for_each(|(log, tint)| *log += tint.ln());
        albedo = without_tint(&albedo, &tint);
    }
    let nearer = relative_nearness[0] * near.nearness_unit();
    let nearness_per_metre = (nearness_per_metre + nearer).max(0.0);
    Ok(JointEstimate { log_light, albedo, nearness_per_metre, terms })
}

/// The highlights that a light causes on an albedo.
struct Highlights<'a> {
    model: &'a ExplicitModel<'a>,
    light: &'a [f32],
    relative_nearness: f32,
    albedo: &'a [f32],
}

impl Highlights<'_> {
    /// The posterior of `terms`, which are relative to this light. `weight` has the weights of the model's samples.
    fn terms(
        &self,
        config: &UnshadeConfig,
        data: &LightFitData,
        weight: &Planes,
        terms: &RegionTerms,
    ) -> RegionTerms {
        let Self { model, light, relative_nearness, albedo } = *self;
        let errors = Some(&config.model_error);
        terms.with_reflectance(
            &config.reflectance,
            uniformity(data.illuminations.contrast(config.transport.rows, light)),
            &model.regression(light, relative_nearness, albedo, weight, errors),
            data.regions,
            &model.highlight_limits(light, relative_nearness, weight, data.regions),
        )
    }
}
