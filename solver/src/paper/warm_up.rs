//! The warm-up: networks and albedos together (section 4.3.1).

use serde::{Deserialize, Serialize};

use super::fields::ShadingFields;
use crate::backend::resident::{Job, Variable};
use crate::backend::{ALBEDOS, Backend};
use crate::config::PaperConfig;
use crate::fit::Fit;
use crate::fit::adam::Adam;
use crate::model::networks::Networks;
use crate::model::normals::DirectionScale;
use crate::model::planes::Planes;
use crate::model::prior::albedo_prior;
use crate::model::samples::Samples;
use crate::model::texture::part;
use crate::run::Run;
use crate::run::error::SolveError;

/// Networks and both albedos, on samples whose taps are of the fields' size.
pub struct WarmUp<'a> {
    /// The parameters.
    pub fields: ShadingFields,
    config: &'a PaperConfig,
    iterations: usize,
    samples: &'a Samples,
    directions: Planes,
    network_adam: Adam,
    diffuse_adam: Adam,
    specular_adam: Adam,
}

impl<'a> WarmUp<'a> {
    /// Starts from these fields.
    pub fn new(config: &'a PaperConfig, samples: &'a Samples, fields: ShadingFields) -> Self {
        let (w, adam) = (&config.warm_up, &config.adam);
        Self {
            config,
            iterations: w.iterations,
            samples,
            directions: DirectionScale::from(&config.networks).directions(samples, None),
            network_adam: Adam::new(adam, w.network_rate, fields.networks.parameters.len()),
            diffuse_adam: Adam::new(adam, w.diffuse_rate, fields.diffuse.len()),
            specular_adam: Adam::new(adam, w.specular_rate, fields.specular.len()),
            fields,
        }
    }
}

impl Fit for WarmUp<'_> {
    fn iterations(&self) -> usize {
        self.iterations
    }

    fn gradient(&self, backend: &dyn Backend) -> (f64, Vec<Vec<f32>>) {
        let fields = &self.fields;
        let albedo = fields.albedo_texture();
        let joint =
            backend.joint_textures(&fields.networks, self.samples, &self.directions, &albedo);
        let mut diffuse = part::<ALBEDOS, 3>(&joint.albedo, 0);
        let specular = part::<ALBEDOS, 1>(&joint.albedo, 3);
        let weight = self.config.warm_up.prior;
        let penalty = albedo_prior(&fields.diffuse, fields.size, weight, &mut diffuse);
        (joint.loss + penalty, vec![joint.networks, diffuse, specular])
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Joint {
            samples: self.samples,
            directions: &self.directions,
            shape: &self.fields.networks.shape,
            prior: self.config.warm_up.prior,
        })
    }

    fn variables(&mut self) -> Vec<Variable<'_>> {
        let (free, minimum) = (f32::NEG_INFINITY, self.config.minimum_albedo());
        let fields = &mut self.fields;
        vec![
            Variable::new(&mut fields.networks.parameters, &mut self.network_adam, free),
            Variable::new(&mut fields.diffuse, &mut self.diffuse_adam, minimum),
            Variable::new(&mut fields.specular, &mut self.specular_adam, minimum),
        ]
    }
}

/// A short warm-up from the networks of one seed.
#[derive(Serialize, Deserialize)]
struct Start {
    losses: Vec<f64>,
    fields: ShadingFields,
    optimisers: [Adam; 3],
}

impl Start {
    /// The mean of the last tenth of its losses.
    fn loss(&self) -> f64 {
        let tail = &self.losses[self.losses.len() - self.losses.len().div_ceil(10)..];
        tail.iter().sum::<f64>() / tail.len().max(1) as f64
    }
}

/// The number of starts; a single start is the warm-up itself.
pub(super) fn starts(config: &PaperConfig) -> usize {
    if config.initialisation.starts > 1 { config.initialisation.starts } else { 0 }
}

/// Steps of the warm-up after the best start.
pub(super) fn steps_after_start(config: &PaperConfig) -> usize {
    let start = if starts(config) > 0 { config.initialisation.start_iterations } else { 0 };
    config.warm_up.iterations.saturating_sub(start)
}

/// Returns the fields after the warm-up, which continues the start with the least loss.
pub(super) fn warm_up(
    run: &mut Run,
    config: &PaperConfig,
    samples: &Samples,
    initial: &ShadingFields,
) -> Result<ShadingFields, SolveError> {
    let mut best: Option<Start> = None;
    for number in 0..starts(config) {
        let name = format!("start {}", number + 1);
        let start =
            run.stage(&name, |run, name| start(run, name, number, config, samples, initial))?;
        if best.as_ref().is_none_or(|best| start.loss() < best.loss()) {
            best = Some(start);
        }
        if run.is_interrupted() {
            break;
        }
    }
    run.stage("warm-up", |run, name| {
        let (fields, losses, optimisers) = match best {
            Some(Start { losses, fields, optimisers }) => (fields, losses, Some(optimisers)),
            None => (initial.clone(), vec![], None),
        };
        let mut fit = WarmUp::new(config, samples, fields);
        fit.iterations = steps_after_start(config);
        if let Some(optimisers) = optimisers {
            [fit.network_adam, fit.diffuse_adam, fit.specular_adam] = optimisers;
        }
        run.continue_fit(name, &mut fit, losses)?;
        Ok(fit.fields)
    })
}

fn start(
    run: &mut Run,
    name: &str,
    number: usize,
    config: &PaperConfig,
    samples: &Samples,
    initial: &ShadingFields,
) -> Result<Start, SolveError> {
    let networks = Networks::new(&config.networks, config.seed + number as u64);
    let mut fit = WarmUp::new(config, samples, ShadingFields { networks, ..initial.clone() });
    fit.iterations = config.initialisation.start_iterations;
    let losses = run.unrecorded_fit(name, &mut fit)?;
    let optimisers = [fit.network_adam, fit.diffuse_adam, fit.specular_adam];
    Ok(Start { losses, fields: fit.fields, optimisers })
}
