//! Light, distance and diffuse albedo with the highlights that the light itself makes on skin.
//!
//! The networks explain highlights by whatever fits, from any light. Skin's reflectance is known, and so the
//! model here is A_d S_d + A_s H l: H is two GGX lobes over the cells that a sample sees, and the same light l
//! makes shading and highlights. Where a highlight stands says where its lamp is, what colour it has says
//! what colour the lamp has, and what glows at the sides of a face is no light from behind.

use super::adam::Adam;
use super::context::SolveContext;
use super::error::SolveError;
use super::lighting::Lighting;
use super::regression::Regression;
use super::stage::{Memory, Stage, State};
use super::stage_runner::StageRunner;
use crate::backend::Backend;
use crate::backend::resident::{HighlightsJob, Job, Variable};
use crate::config::{Config, ModelErrorConfig, TransportConfig};
use crate::model::planes::Planes;
use crate::model::prior::prior;
use crate::model::samples::Samples;
use crate::transport::{CHANNELS, Reflection, SpecularTerm, Transport, light_colour};

/// The channel that the weights of samples go by.
const GREEN: usize = 1;
/// Radiance that a model errs by at least.
const LEAST_ERROR: f32 = 1e-5;

/// Light and diffuse albedo again, as [`super::distance`].
pub(super) fn highlights(
    runner: &mut StageRunner,
    context: &SolveContext,
    lighting: &mut Lighting,
) -> Result<usize, SolveError> {
    let t = &context.config.transport;
    if lighting.skin_specular.is_empty() {
        return Ok(t.highlights);
    }
    let transport = context.transport(lighting.setup);
    let samples = context.pictures().samples(&context.space, transport.size());
    let mut state = lighting.state.clone();
    let log_light: Vec<f32> = lighting.light.radiance.iter().map(|light| light.ln()).collect();
    let skin_specular = std::mem::take(&mut lighting.skin_specular);
    let found = Found {
        log_light: &log_light,
        nearness: lighting.setup.nearness,
        skin_specular: &skin_specular,
    };
    let stage = Highlights::new(context.config, transport, &samples, &state, found);
    let Some(mut stage) = stage else { return Ok(t.highlights) };
    runner.stage(&mut stage, &mut state)?;
    let light = stage.light();
    let region_terms = lighting.region_terms.take();
    let (setup, doubt) = (lighting.setup, lighting.doubt);
    *lighting = Lighting::new(context, &samples, state, region_terms, setup, light);
    (lighting.explained, lighting.doubt) = (true, doubt);
    Ok(0)
}

/// A light that is known, and skin's specular terms.
#[derive(Clone, Copy)]
pub struct Found<'a> {
    /// Logarithm of the light, R, G, B per cell.
    pub log_light: &'a [f32],
    /// Per metre.
    pub nearness: f32,
    /// Of [`SpecularTerm`], on the transport's texture.
    pub skin_specular: &'a [f32],
}

/// Light and diffuse albedo on the transport's texture.
pub struct Highlights<'a> {
    config: &'a TransportConfig,
    transport: &'a Transport,
    samples: Samples,
    reflection: Reflection,
    /// Logarithm of the light, R, G, B per cell.
    pub(super) log_light: Vec<f32>,
    /// How near the light is, in the transport's unit; one value, which only moves if the transport says
    /// what that changes.
    pub(super) nearness: Vec<f32>,
    iterations: usize,
    albedo_held: bool,
    by_light: Adam,
    by_nearness: Adam,
    by_diffuse: Adam,
}

/// Gradients of the loss.
pub(super) struct Gradient {
    pub loss: f64,
    /// By the light's logarithm.
    pub light: Vec<f32>,
    pub nearness: Option<f32>,
    pub diffuse: Vec<f32>,
}

impl<'a> Highlights<'a> {
    /// From what is known of the light. The samples' taps and the textures are of the transport's size. `None`
    /// unless the transport holds what is open.
    pub fn new(
        config: &'a Config,
        transport: &'a Transport,
        samples: &Samples,
        state: &State,
        found: Found,
    ) -> Option<Self> {
        let (t, adam) = (&config.transport, &config.adam);
        let samples = samples.thinned(t.highlight_samples);
        let specular = samples.taps.sample::<{ SpecularTerm::ROWS }>(found.skin_specular);
        let light: Vec<f32> = found.log_light.iter().map(|log| log.exp()).collect();
        let peak = transport.peak(&light);
        let reflection =
            transport.reflection(&config.skin, &samples, &specular, peak, found.nearness)?;
        Some(Self {
            config: t,
            transport,
            samples,
            reflection,
            log_light: found.log_light.to_vec(),
            nearness: vec![found.nearness / transport.near()],
            iterations: t.highlights,
            albedo_held: false,
            by_light: Adam::new(adam, t.light_rate, light.len()),
            by_nearness: Adam::new(adam, t.nearness_rate, 1),
            by_diffuse: Adam::new(adam, t.diffuse_rate, state.diffuse.len()),
        })
    }

    /// For light and nearness alone, the light at another rate.
    pub(super) fn of_light_alone(self, rate: f32) -> Self {
        let by_light = Adam::new(self.by_light.config(), rate, self.log_light.len());
        Self { by_light, albedo_held: true, ..self }
    }

    /// Steps done.
    pub(super) fn steps(&self) -> usize {
        self.by_light.steps()
    }

    /// Weight and softness of the light's colours.
    fn light_colour(&self) -> [f32; 2] {
        [self.config.light_colour, self.config.light_colour_softness]
    }

    /// The light, R, G, B per cell.
    pub(super) fn light(&self) -> Vec<f32> {
        self.log_light.iter().map(|log| log.exp()).collect()
    }

    /// Gives the light the colour of its highlights, at the same [peak](Transport::peak), and says by what
    /// it was multiplied; the albedo of `state`, with which the light was found, is to be divided by it.
    pub(super) fn take_tint(&mut self, state: &State) -> [f32; CHANNELS] {
        let light = self.light();
        let tint = self.regression(state, &self.samples.weight, None).tint(self.config);
        let tinted: Vec<f32> = light.iter().zip(tint.iter().cycle()).map(|(l, t)| l * t).collect();
        let [before, after] = [&light, &tinted].map(|light| self.transport.peak(light));
        if before == 0.0 {
            return [1.0; CHANNELS];
        }
        let tint = tint.map(|t| t * before / after);
        self.log_light.iter_mut().zip(tint.iter().cycle()).for_each(|(l, t)| *l += t.ln());
        tint
    }

    /// Of what the samples show besides the diffuse layer, on the highlights. With `errors` a sample weighs by how
    /// far these may be off there: a strong highlight counts for no more than a weak one, of which there are many.
    pub(super) fn regression(
        &self,
        state: &State,
        weight: &Planes,
        errors: Option<&ModelErrorConfig>,
    ) -> Regression {
        let light = self.light();
        let (shading, _) = self.transport.shading_nearer(&light, self.nearness[0]);
        let layer = self.layer(state, &shading);
        let shown =
            |i: usize| std::array::from_fn(|c| self.samples.target.get(c, i) - layer.get(c, i));
        let predicted = self.reflection.radiance(&light);
        let rows = |i: usize| [predicted[i], [0.0; CHANNELS]];
        let Some(errors) = errors.filter(|errors| errors.shadow > 0.0) else {
            return Regression::new(&self.samples, weight, rows, shown);
        };
        let mean = shading.iter().sum::<f32>() / shading.len() as f32;
        let albedo = self.samples.taps.sample::<CHANNELS>(&state.diffuse);
        let weight = Planes::from_fn(self.samples.len(), |i| {
            let diffuse = errors.shadow * mean * albedo.get(GREEN, i);
            let error = diffuse.hypot(errors.highlights * predicted[i][GREEN]);
            [weight.get(0, i) / error.max(LEAST_ERROR).powi(2)]
        });
        Regression::new(&self.samples, &weight, rows, shown)
    }

    /// The diffuse layer of every sample.
    fn layer(&self, state: &State, shading: &[f32]) -> Planes {
        let layer: Vec<f32> = state.diffuse.iter().zip(shading).map(|(a, s)| a * s).collect();
        self.samples.taps.sample::<CHANNELS>(&layer)
    }

    /// Loss and its gradients.
    pub(super) fn gradient(&self, state: &State) -> Gradient {
        let (light, samples) = (self.light(), &self.samples);
        let (shading, gain) = self.transport.shading_nearer(&light, self.nearness[0]);
        let product = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).collect();
        let sampled = self.layer(state, &shading);
        let scale = 1.0 / (CHANNELS * samples.len()) as f32;
        let residual = |i: usize, highlight: [f32; CHANNELS]| {
            let weight = scale * samples.weight.get(0, i);
            let mut loss = 0.0;
            let by = std::array::from_fn(|c| {
                let residual = sampled.get(c, i) + highlight[c] - samples.target.get(c, i);
                loss += f64::from(weight * residual.abs());
                if residual == 0.0 { 0.0 } else { weight.copysign(residual) }
            });
            (by, (by, loss))
        };
        let (more, by_sample) = self.reflection.exchange(&light, residual);
        let by_layer = Planes::from_fn(samples.len(), |i| by_sample[i].0);
        let by_layer = samples.taps.gather::<CHANNELS>(&by_layer, 0);
        let mut diffuse: Vec<f32> = product(&by_layer, &shading);
        let by_shading: Vec<f32> = product(&by_layer, &state.diffuse);
        let smooth = prior(&state.diffuse, state.size, self.config.prior, &mut diffuse);
        let mut by_light = self.transport.adjoint_nearer(&by_shading, self.nearness[0]);
        by_light.iter_mut().zip(more).zip(&light).for_each(|((g, m), l)| *g = (*g + m) * l);
        let [weight, softness] = self.light_colour();
        let colour = light_colour(&self.log_light, weight, softness, &mut by_light);
        let along = |gain: Vec<f32>| {
            let products = gain.iter().zip(&by_shading).map(|(a, b)| f64::from(*a) * f64::from(*b));
            products.sum::<f64>() as f32
        };
        Gradient {
            loss: by_sample.iter().map(|(_, loss)| loss).sum::<f64>() + smooth + colour,
            light: by_light,
            nearness: gain.map(along),
            diffuse,
        }
    }
}

impl Stage for Highlights<'_> {
    fn name(&self) -> String {
        "highlights".to_owned()
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn step(&mut self, state: &mut State, _: &dyn Backend, decay: f32) -> f64 {
        let gradient = self.gradient(state);
        self.by_light.step(&mut self.log_light, &gradient.light, decay, f32::NEG_INFINITY);
        if let Some(by_nearness) = gradient.nearness {
            self.by_nearness.step(&mut self.nearness, &[by_nearness], decay, 0.0);
            self.nearness[0] = self.nearness[0].min(self.transport.nearest());
        }
        if !self.albedo_held {
            self.by_diffuse.step(&mut state.diffuse, &gradient.diffuse, decay, 0.0);
        }
        gradient.loss
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Highlights(HighlightsJob {
            samples: &self.samples,
            transport: self.transport,
            reflection: &self.reflection,
            prior: self.config.prior,
            light_colour: self.light_colour(),
        }))
    }

    fn variables<'b>(&'b mut self, state: &'b mut State) -> Vec<Variable<'b>> {
        let nearness = Variable::new(&mut self.nearness, &mut self.by_nearness, 0.0);
        let diffuse = Variable::new(&mut state.diffuse, &mut self.by_diffuse, 0.0);
        vec![
            Variable::new(&mut self.log_light, &mut self.by_light, f32::NEG_INFINITY),
            Variable { maximum: self.transport.nearest(), ..nearness },
            diffuse,
        ]
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory {
            optimisers: vec![&mut self.by_light, &mut self.by_nearness, &mut self.by_diffuse],
            own: vec![&mut self.log_light, &mut self.nearness],
        }
    }
}
