//! Diffuse albedo under explicit transport: the light and the albedo are solved for together, the
//! networks explain the specular layer alone.

use rayon::prelude::*;

use super::adam::Adam;
use super::context::{SolveContext, TransportSetup};
use super::error::SolveError;
use super::light_estimate::{LightEstimate, bounce_albedo};
use super::lighting::Lighting;
use super::recolour::recolour;
use super::region_terms::RegionTerms;
use super::specular_floor;
use super::stage::{Memory, Stage, State};
use super::stage_runner::StageRunner;
use crate::backend::resident::{Job, TransportedJob, Variable};
use crate::backend::{ALBEDOS, Backend};
use crate::config::{Config, TransportConfig};
use crate::model::normals::DirectionScale;
use crate::model::planes::Planes;
use crate::model::prior::prior;
use crate::model::samples::Samples;
use crate::transport::{CHANNELS, Transport, light_colour};

/// Light and its distance under the colours of `start`, with the networks that the warm-up trained.
pub(super) fn light(
    runner: &mut StageRunner,
    context: &SolveContext,
    mut start: State,
) -> Result<LightEstimate, SolveError> {
    let transport = context.far_transport();
    runner.lap("rays");
    start.resize(transport.size());
    let samples = context.pictures().samples(&context.space, transport.size());
    let mut stage = Transported::probe(context.config, transport, &samples, &start);
    runner.stage(&mut stage, &mut start)?;
    let nearness = stage.nearness[0] * transport.near();
    let bounce_albedo = bounce_albedo(transport, &stage.light(), &start.diffuse);
    let setup = TransportSetup { nearness, bounce_albedo };
    let log_light = stage.log_light;
    let regions = specular_floor::wanted(context.config)
        .then(|| context.regions_on(transport.size()))
        .flatten();
    let region_terms = regions.map(|regions| RegionTerms::expected(context, &regions));
    let networks = start.networks;
    let (halves, doubt, tint) = (None, None, [1.0; CHANNELS]);
    Ok(LightEstimate { log_light, halves, doubt, setup, networks, region_terms, tint })
}

/// Light and diffuse albedo under explicit transport, from the light of [`light`] and the textures of
/// `start`.
pub(super) fn light_and_albedo(
    runner: &mut StageRunner,
    context: &SolveContext,
    start: State,
    light_estimate: LightEstimate,
) -> Result<Lighting, SolveError> {
    let t = &context.config.transport;
    let transport = context.transport(light_estimate.setup);
    runner.lap("rays at the light's distance");
    let mut state = State { networks: light_estimate.networks, ..start };
    state.resize(transport.size());
    let (texels, _) = state.diffuse.as_chunks_mut();
    texels.iter_mut().for_each(|texel: &mut [f32; CHANNELS]| {
        texel.iter_mut().zip(light_estimate.tint).for_each(|(albedo, tint)| *albedo /= tint);
    });
    let samples = context.pictures().samples(&context.space, transport.size());
    if t.recolour {
        let light: Vec<f32> = light_estimate.log_light.iter().map(|light| light.exp()).collect();
        recolour(
            context,
            transport,
            &samples,
            &light,
            light_estimate.region_terms.as_ref(),
            &mut state,
        );
    }
    let mut stage =
        Transported::new(context.config, transport, &samples, &state, light_estimate.log_light);
    runner.stage(&mut stage, &mut state)?;
    let light = stage.light();
    let LightEstimate { region_terms, setup, doubt, .. } = light_estimate;
    let mut lighting = Lighting::new(context, &samples, state, region_terms, setup, light);
    lighting.doubt = doubt;
    Ok(lighting)
}

/// Light, diffuse albedo and specular layer on the transport's texture.
pub struct Transported<'a> {
    config: &'a TransportConfig,
    transport: &'a Transport,
    samples: &'a Samples,
    /// Of the networks.
    shape: Vec<usize>,
    /// The samples with what the diffuse layer leaves as their target.
    rest: Samples,
    directions: Planes,
    /// Logarithm of the light, R, G, B per cell.
    log_light: Vec<f32>,
    /// How near the light is, in the transport's unit; one value.
    nearness: Vec<f32>,
    name: &'static str,
    iterations: usize,
    frozen_steps: usize,
    by_light: Adam,
    by_nearness: Adam,
    by_diffuse: Adam,
    by_specular: Adam,
    by_networks: Adam,
}

impl<'a> Transported<'a> {
    /// Light, nearness and specular layer alone, from an even light.
    pub fn probe(
        config: &'a Config,
        transport: &'a Transport,
        samples: &'a Samples,
        state: &State,
    ) -> Self {
        let log_light = vec![0.0; CHANNELS * transport.cells()];
        let iterations = config.transport.probe;
        let stage = Self::new(config, transport, samples, state, log_light);
        Self { name: "light", iterations, frozen_steps: iterations, ..stage }
    }

    /// All together, from a logarithm of the light. The samples' taps and the state's textures are of
    /// the transport's size.
    pub fn new(
        config: &'a Config,
        transport: &'a Transport,
        samples: &'a Samples,
        state: &State,
        log_light: Vec<f32>,
    ) -> Self {
        let (t, adam) = (&config.transport, &config.adam);
        Self {
            config: t,
            transport,
            samples,
            shape: state.networks.shape.clone(),
            rest: samples.clone(),
            directions: DirectionScale::from(&config.networks).directions(samples, None),
            nearness: vec![0.0],
            name: "transport",
            iterations: t.iterations,
            frozen_steps: t.albedo_frozen_steps,
            by_light: Adam::new(adam, t.light_rate, log_light.len()),
            by_nearness: Adam::new(adam, t.nearness_rate, 1),
            by_diffuse: Adam::new(adam, t.diffuse_rate, state.diffuse.len()),
            by_specular: Adam::new(adam, t.specular_rate, state.specular.len()),
            by_networks: Adam::new(adam, t.network_rate, state.networks.parameters.len()),
            log_light,
        }
    }

    /// The light, R, G, B per cell.
    pub fn light(&self) -> Vec<f32> {
        self.log_light.iter().map(|log| log.exp()).collect()
    }

    /// Weight and softness of the light's colours.
    fn light_colour(&self) -> [f32; 2] {
        [self.config.light_colour, self.config.light_colour_softness]
    }

    #[cfg(test)]
    pub(super) fn set_nearness(&mut self, nearness: f32) {
        self.nearness[0] = nearness;
    }

    /// Loss and its gradients.
    pub(super) fn gradient(&mut self, state: &State, backend: &dyn Backend) -> Gradient {
        let light = self.light();
        let (shading, gain) = self.transport.shading_nearer(&light, self.nearness[0]);
        let layer: Vec<f32> = state.diffuse.iter().zip(&shading).map(|(a, s)| a * s).collect();
        let samples = self.samples;
        let sampled = samples.taps.sample::<CHANNELS>(&layer);
        self.rest.target = Planes::from_fn::<CHANNELS>(samples.len(), |i| {
            let (target, layer): ([f32; 3], [f32; 3]) =
                (samples.target.sample(i, 0), sampled.sample(i, 0));
            std::array::from_fn(|c| target[c] - layer[c])
        });
        // Black under the networks' diffuse term, so that they explain the highlights alone.
        let specular = samples.taps.sample::<1>(&state.specular);
        let albedo: Planes =
            Planes::from_fn::<ALBEDOS>(samples.len(), |i| [0.0, 0.0, 0.0, specular.get(0, i)]);
        let joint = backend.joint(&state.networks, &self.rest, &self.directions, &albedo);
        // The gradient by that black albedo is weight x sign x S_d with S_d > 0: its sign is the
        // residual's.
        let scale = 1.0 / (CHANNELS * samples.len()) as f32;
        let by_layer = Planes::from_fn(samples.len(), |i| {
            let weight = scale * samples.weight.get(0, i);
            let slope: [f32; CHANNELS] = joint.albedo.sample(i, 0);
            slope.map(|slope| if slope == 0.0 { 0.0 } else { weight.copysign(slope) })
        });
        let by_layer = samples.taps.gather::<CHANNELS>(&by_layer, 0);
        let product = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).collect();
        let mut by_diffuse: Vec<f32> = product(&by_layer, &shading);
        let mut by_shading: Vec<f32> = product(&by_layer, &state.diffuse);
        let grey = self.grey(&shading, &mut by_shading);
        let smooth = prior(&state.diffuse, state.size, self.config.prior, &mut by_diffuse);
        let by_light = self.transport.adjoint_nearer(&by_shading, self.nearness[0]);
        let along = |gain: Vec<f32>| -> f64 {
            gain.iter().zip(&by_shading).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
        };
        let mut by_log: Vec<f32> = product(&by_light, &light);
        let [weight, softness] = self.light_colour();
        let colour = light_colour(&self.log_light, weight, softness, &mut by_log);
        Gradient {
            loss: joint.loss + grey + smooth + colour,
            light: by_log,
            nearness: gain.map_or(0.0, along) as f32,
            diffuse: by_diffuse,
            specular: samples.taps.gather::<1>(&joint.albedo, 3),
            networks: joint.networks,
        }
    }

    /// Penalties on coloured shading: of its mean, and of every texel's. Without them a tint could
    /// move between light and albedo at no cost.
    fn grey(&self, shading: &[f32], gradient: &mut [f32]) -> f64 {
        let (texels, _) = shading.as_chunks::<CHANNELS>();
        let count = texels.len() as f64;
        let sums: Vec<[f64; CHANNELS]> = texels
            .par_chunks(1 << 12)
            .map(|part| std::array::from_fn(|c| part.iter().map(|texel| f64::from(texel[c])).sum()))
            .collect();
        let means: [f64; CHANNELS] =
            std::array::from_fn(|c| sums.iter().map(|sum| sum[c]).sum::<f64>() / count);
        let mean = means.iter().sum::<f64>() / CHANNELS as f64;
        let off = means.map(|m| m / mean - 1.0);
        let (weight, texel_weight) =
            (f64::from(self.config.grey_mean), f64::from(self.config.grey_texel));
        let pull = off.iter().zip(means).map(|(off, m)| off * m).sum::<f64>() / mean;
        let by_mean =
            off.map(|off| (2.0 * weight * (off - pull / CHANNELS as f64) / (mean * count)) as f32);
        let scale = (texel_weight / (CHANNELS as f64 * count)) as f32;
        let parts: Vec<f64> = gradient
            .par_chunks_mut(CHANNELS << 12)
            .zip(texels.par_chunks(1 << 12))
            .map(|(gradient, texels)| {
                let mut sum = 0.0;
                for (gradient, texel) in gradient.chunks_exact_mut(CHANNELS).zip(texels) {
                    let grey = texel.iter().sum::<f32>() / CHANNELS as f32;
                    let signs = texel.map(|s| if s == grey { 0.0 } else { (s - grey).signum() });
                    let mean_sign = signs.iter().sum::<f32>() / CHANNELS as f32;
                    // What no light reaches has no colour.
                    let inverse = if grey > 0.0 { 1.0 / grey } else { 0.0 };
                    for c in 0..CHANNELS {
                        sum += f64::from((texel[c] - grey).abs() * inverse);
                        // The divisor counts as given.
                        gradient[c] += by_mean[c] + scale * (signs[c] - mean_sign) * inverse;
                    }
                }
                sum
            })
            .collect();
        weight * off.iter().map(|off| off * off).sum::<f64>()
            + texel_weight * parts.iter().sum::<f64>() / (CHANNELS as f64 * count)
    }
}

/// Gradients of the loss.
pub(super) struct Gradient {
    pub loss: f64,
    /// By the light's logarithm.
    pub light: Vec<f32>,
    pub nearness: f32,
    pub diffuse: Vec<f32>,
    pub specular: Vec<f32>,
    pub networks: Vec<f32>,
}

impl Stage for Transported<'_> {
    fn name(&self) -> String {
        self.name.to_owned()
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn step(&mut self, state: &mut State, backend: &dyn Backend, decay: f32) -> f64 {
        let gradient = self.gradient(state, backend);
        let free = f32::NEG_INFINITY;
        self.by_light.step(&mut self.log_light, &gradient.light, decay, free);
        self.by_nearness.step(&mut self.nearness, &[gradient.nearness], decay, 0.0);
        self.nearness[0] = self.nearness[0].min(self.transport.nearest());
        if self.by_light.steps() > self.frozen_steps {
            self.by_diffuse.step(&mut state.diffuse, &gradient.diffuse, decay, 0.0);
        }
        self.by_specular.step(&mut state.specular, &gradient.specular, decay, 0.0);
        self.by_networks.step(&mut state.networks.parameters, &gradient.networks, decay, free);
        gradient.loss
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Transported(TransportedJob {
            samples: self.samples,
            directions: &self.directions,
            shape: &self.shape,
            transport: self.transport,
            prior: self.config.prior,
            grey_mean: self.config.grey_mean,
            grey_texel: self.config.grey_texel,
            light_colour: self.light_colour(),
        }))
    }

    fn variables<'b>(&'b mut self, state: &'b mut State) -> Vec<Variable<'b>> {
        let free = f32::NEG_INFINITY;
        let nearness = Variable::new(&mut self.nearness, &mut self.by_nearness, 0.0);
        let diffuse = Variable::new(&mut state.diffuse, &mut self.by_diffuse, 0.0);
        let networks = &mut state.networks.parameters;
        vec![
            Variable::new(&mut self.log_light, &mut self.by_light, free),
            Variable { maximum: self.transport.nearest(), ..nearness },
            Variable { frozen_steps: self.frozen_steps, ..diffuse },
            Variable::new(&mut state.specular, &mut self.by_specular, 0.0),
            Variable::new(networks, &mut self.by_networks, free),
        ]
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory {
            optimisers: vec![
                &mut self.by_light,
                &mut self.by_nearness,
                &mut self.by_diffuse,
                &mut self.by_specular,
                &mut self.by_networks,
            ],
            own: vec![&mut self.log_light, &mut self.nearness],
        }
    }
}
