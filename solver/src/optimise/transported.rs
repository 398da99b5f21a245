//! Diffuse albedo under explicit transport: the light and the albedo are solved for together, the
//! networks explain the specular layer alone.

use rayon::prelude::*;

use super::adam::Adam;
use super::normalise::percentile;
use super::run::Run;
use super::solve::WarmUpPictures;
use super::stage::{Diffuse, Stage, State, layers};
use crate::backend::{ALBEDOS, Backend};
use crate::capture::Mesh;
use crate::config::{Config, TransportConfig};
use crate::error::SolveError;
use crate::model::deviation::Deviation;
use crate::model::normals::DirectionScale;
use crate::model::planes::Planes;
use crate::model::prior::prior;
use crate::model::samples::{SampleSpace, Samples};
use crate::model::texture::resample;
use crate::transport::{CHANNELS, Transport};

/// Rec.709.
const LUMINANCE: [f32; CHANNELS] = [0.2126, 0.7152, 0.0722];

/// What explicit transport found, on its own texture.
pub(super) struct Lit {
    state: State,
    /// S_d, R, G, B per texel.
    shading: Vec<f32>,
}

/// The diffuse albedo of the maps, and the factor that makes it a reflectance.
pub(super) struct Physical {
    pub diffuse: Vec<f32>,
    pub scale: f32,
}

/// Light and diffuse albedo under explicit transport, from the `start` of the warm-up with the
/// networks that it trained.
pub(super) fn light_and_albedo(
    run: &mut Run,
    config: &Config,
    mesh: &Mesh,
    space: &SampleSpace,
    pictures: &WarmUpPictures,
    start: State,
) -> Result<Lit, SolveError> {
    let transport = Transport::new(mesh, &config.transport, config.seed);
    run.lap("rays");
    let mut state = start;
    state.resize(transport.size());
    let samples = pictures.samples(space, transport.size());
    let mut stage = Transported::new(config, &transport, &samples, &state);
    run.stage(&mut stage, &mut state)?;
    let shading = transport.shading(&stage.light());
    Ok(Lit { state, shading })
}

/// The albedo of [`light_and_albedo`] on the final texture and the full pictures, under the same
/// light. `state` has the normals.
pub(super) fn refined(
    run: &mut Run,
    config: &Config,
    samples: &Samples,
    deviation: &Deviation,
    state: &State,
    mut lit: Lit,
) -> Result<Physical, SolveError> {
    let shading = resample(&lit.shading, lit.state.size, CHANNELS, state.size);
    let shading = samples.taps.sample::<CHANNELS>(&shading);
    lit.state.resize(state.size);
    lit.state.deviation.clone_from(&state.deviation);
    let specular = layers(samples, deviation, &lit.state, run.backend);
    let planes = Planes::from_fn(samples.len(), |i| {
        let [r, g, b] = shading.sample(i, 0);
        [r, g, b, specular.get(1, i)]
    });
    let luminance = |i| {
        let shading: [f32; CHANNELS] = shading.sample(i, 0);
        shading.iter().zip(LUMINANCE).map(|(s, weight)| s * weight).sum()
    };
    let t = &config.transport;
    let scale = percentile((0..samples.len()).map(luminance).collect(), t.percentile);
    let name = "albedo".to_owned();
    let mut stage = Diffuse::under(config, samples, planes, name, t.refinement, t.refinement_prior);
    run.stage(&mut stage, &mut lit.state)?;
    Ok(Physical { diffuse: lit.state.diffuse, scale })
}

/// Light, diffuse albedo and specular layer on the transport's texture.
pub struct Transported<'a> {
    config: &'a TransportConfig,
    transport: &'a Transport,
    samples: &'a Samples,
    /// The samples with what the diffuse layer leaves as their target.
    rest: Samples,
    directions: Planes,
    /// Logarithm of the light, R, G, B per cell.
    log_light: Vec<f32>,
    step: usize,
    by_light: Adam,
    by_diffuse: Adam,
    by_specular: Adam,
    by_networks: Adam,
}

impl<'a> Transported<'a> {
    /// The samples' taps and the state's textures are of the transport's size.
    pub fn new(
        config: &'a Config,
        transport: &'a Transport,
        samples: &'a Samples,
        state: &State,
    ) -> Self {
        let (t, adam) = (&config.transport, &config.adam);
        let cells = CHANNELS * transport.cells();
        Self {
            config: t,
            transport,
            samples,
            rest: samples.clone(),
            directions: DirectionScale::from(&config.networks).directions(samples, None),
            log_light: vec![0.0; cells],
            step: 0,
            by_light: Adam::new(adam, t.light_rate, cells),
            by_diffuse: Adam::new(adam, t.diffuse_rate, state.diffuse.len()),
            by_specular: Adam::new(adam, t.specular_rate, state.specular.len()),
            by_networks: Adam::new(adam, t.network_rate, state.networks.parameters.len()),
        }
    }

    /// The light, R, G, B per cell.
    pub fn light(&self) -> Vec<f32> {
        self.log_light.iter().map(|log| log.exp()).collect()
    }

    #[cfg(test)]
    pub(super) fn set_log_light(&mut self, log_light: &[f32]) {
        self.log_light.copy_from_slice(log_light);
    }

    /// Loss and its gradients.
    pub(super) fn gradient(&mut self, state: &State, backend: &dyn Backend) -> Gradient {
        let light = self.light();
        let shading = self.transport.shading(&light);
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
        let by_light: Vec<f32> = product(&self.transport.adjoint(&by_shading), &light);
        Gradient {
            loss: joint.loss + grey + smooth,
            light: by_light,
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
    pub diffuse: Vec<f32>,
    pub specular: Vec<f32>,
    pub networks: Vec<f32>,
}

impl Stage for Transported<'_> {
    fn name(&self) -> String {
        "transport".to_owned()
    }

    fn iterations(&self) -> usize {
        self.config.iterations
    }

    fn step(&mut self, state: &mut State, backend: &dyn Backend, share: f32) -> f64 {
        let gradient = self.gradient(state, backend);
        let free = f32::NEG_INFINITY;
        self.by_light.step(&mut self.log_light, &gradient.light, share, free);
        if self.step >= self.config.hold {
            self.by_diffuse.step(&mut state.diffuse, &gradient.diffuse, share, 0.0);
        }
        self.by_specular.step(&mut state.specular, &gradient.specular, share, 0.0);
        self.by_networks.step(&mut state.networks.parameters, &gradient.networks, share, free);
        self.step += 1;
        gradient.loss
    }
}
