//! Light and diffuse albedo with the highlights that the light itself makes.
use rayon::prelude::*;

use super::adam::Adam;
use super::stage::{Memory, Stage, State};
use crate::backend::Backend;
use crate::config::{Config, TransportConfig};
use crate::model::planes::Planes;
use crate::model::prior::prior;
use crate::model::samples::Samples;
use crate::transport::{CHANNELS, Reflection, Transport};

pub fn env(name: &str, default: f32) -> f32 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

pub struct Glossy<'a> {
    config: &'a TransportConfig,
    transport: &'a Transport,
    samples: &'a Samples,
    reflection: Reflection,
    pub log_light: Vec<f32>,
    by_light: Adam,
    by_diffuse: Adam,
    peak: f32,
    strength: f32,
    pub nearness: Vec<f32>,
    by_nearness: Adam,
    iterations: usize,
    hold: usize,
}

impl<'a> Glossy<'a> {
    pub fn new(
        config: &'a Config,
        transport: &'a Transport,
        samples: &'a Samples,
        state: &State,
        light: &[f32],
        gloss: &[f32],
        nearness: f32,
        probe: bool,
    ) -> Option<Self> {
        let (t, adam) = (&config.transport, &config.adam);
        let gloss = samples.taps.sample::<1>(gloss);
        let peak = transport.peak(light);
        let reflection = transport.reflection(samples, &gloss, peak, nearness)?;
        let iterations = if probe { env("UN_PROBE", 150.0) } else { env("UN_ITER", 300.0) } as usize;
        Some(Self {
            config: t,
            transport,
            samples,
            reflection,
            log_light: light.iter().map(|l| l.ln()).collect(),
            by_light: Adam::new(adam, env("UN_LR", 0.05), light.len()),
            by_diffuse: Adam::new(adam, env("UN_DR", t.diffuse_rate), state.diffuse.len()),
            peak,
            strength: 1.0,
            nearness: vec![if probe { nearness / transport.near() } else { 0.0 }],
            by_nearness: Adam::new(adam, t.nearness_rate, 1),
            iterations,
            hold: if probe { iterations } else { 0 },
        })
    }

    pub fn light(&self) -> Vec<f32> {
        self.log_light.iter().map(|log| log.exp()).collect()
    }

    pub fn residual(&self, state: &State) -> (Planes, Planes, Planes) {
        let light = self.light();
        let shading = self.transport.shading(&light);
        let layer: Vec<f32> = state.diffuse.iter().zip(&shading).map(|(a, s)| a * s).collect();
        let sampled = self.samples.taps.sample::<CHANNELS>(&layer);
        let gloss = self.reflection.product(&light);
        let target = Planes::from_fn::<CHANNELS>(self.samples.len(), |i| self.samples.target.sample(i, 0));
        let spec = Planes::from_fn::<CHANNELS>(self.samples.len(), |i| gloss[i].map(|g| g * self.strength));
        (target, sampled, spec)
    }
}

impl Stage for Glossy<'_> {
    fn name(&self) -> String {
        "glossy".to_owned()
    }
    fn iterations(&self) -> usize {
        self.iterations
    }
    fn step(&mut self, state: &mut State, _: &dyn Backend, share: f32) -> f64 {
        let light = self.light();
        if env("UN_PEAK", 0.0) > 0.0 {
            self.strength = self.peak / self.transport.peak(&light);
        }
        let mut shading = self.transport.shading(&light);
        let gain = self.transport.gain(&light);
        if let Some(gain) = &gain {
            shading.iter_mut().zip(gain).for_each(|(s, gain)| *s += self.nearness[0] * gain);
        }
        let layer: Vec<f32> = state.diffuse.iter().zip(&shading).map(|(a, s)| a * s).collect();
        let samples = self.samples;
        let sampled = samples.taps.sample::<CHANNELS>(&layer);
        let gloss = self.reflection.product(&light);
        let scale = 1.0 / (CHANNELS * samples.len()) as f32;
        let by: Vec<([f32; CHANNELS], f32)> = (0..samples.len())
            .into_par_iter()
            .map(|i| {
                let (target, layer): ([f32; 3], [f32; 3]) =
                    (samples.target.sample(i, 0), sampled.sample(i, 0));
                let weight = scale * samples.weight.get(0, i);
                let mut loss = 0.0;
                let by = std::array::from_fn(|c| {
                    let residual = layer[c] + self.strength * gloss[i][c] - target[c];
                    loss += weight * residual.abs();
                    if residual == 0.0 { 0.0 } else { weight * residual.signum() }
                });
                (by, loss)
            })
            .collect();
        let loss: f64 = by.iter().map(|(_, l)| f64::from(*l)).sum();
        let by_sample: Vec<[f32; CHANNELS]> = by.into_iter().map(|(by, _)| by).collect();
        let planes = Planes::from_fn(samples.len(), |i| by_sample[i]);
        let by_layer = samples.taps.gather::<CHANNELS>(&planes, 0);
        let product = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).collect();
        let mut by_diffuse: Vec<f32> = product(&by_layer, &shading);
        let mut by_shading: Vec<f32> = product(&by_layer, &state.diffuse);
        let (m, t) = if self.hold > 0 { (env("UN_GM1", 0.0), env("UN_GT1", 0.0)) } else { (env("UN_GM", 0.0), env("UN_GT", 0.0)) };
        let grey = super::transported::grey([m, t], &shading, &mut by_shading);
        let smooth = prior(&state.diffuse, state.size, self.config.prior, &mut by_diffuse);
        let mut by_light: Vec<f32> = self.transport.adjoint(&by_shading);
        if let Some(adjoint) = self.transport.gain_adjoint(&by_shading) {
            by_light.iter_mut().zip(adjoint).for_each(|(g, gain)| *g += self.nearness[0] * gain);
        }
        if let Some(gain) = &gain {
            let by: f64 = gain.iter().zip(&by_shading).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum();
            self.by_nearness.step(&mut self.nearness, &[by as f32], share, 0.0);
            self.nearness[0] = self.nearness[0].min(Transport::nearest());
        }
        let more = self.reflection.adjoint(&by_sample);
        by_light.iter_mut().zip(more).zip(&light).for_each(|((g, m), l)| *g = (*g + self.strength * m) * l);
        self.by_light.step(&mut self.log_light, &by_light, share, f32::NEG_INFINITY);
        if self.by_light.steps() > self.hold {
        self.by_diffuse.step(&mut state.diffuse, &by_diffuse, share, 0.0);
        }
        loss + smooth + grey
    }
    fn memory(&mut self) -> Memory<'_> {
        Memory { optimisers: vec![&mut self.by_light, &mut self.by_diffuse], own: vec![&mut self.log_light] }
    }
}
