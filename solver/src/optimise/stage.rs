//! The stages of the optimisation. Each owns its optimisers and what stays fixed while it runs;
//! another update of the state is another stage.

use serde::{Deserialize, Serialize};

use super::adam::{Adam, Part};
use crate::backend::resident::{Job, ReliefJob, Variable};
use crate::backend::{ALBEDOS, Backend, TexturedRelief};
use crate::config::Config;
use crate::model::bend::BentTextures;
use crate::model::bend_gradient::BendGradient;
use crate::model::deviation::{Deviation, Gradients, Seen};
use crate::model::halving::Texel;
use crate::model::layer::Layer;
use crate::model::networks::Networks;
use crate::model::normals::DirectionScale;
use crate::model::planes::Planes;
use crate::model::prior::prior;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, part, resample};
use crate::region::Place;
use crate::region::Region;

/// Everything that is being solved for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// The shading networks.
    pub networks: Networks,
    /// Side of the textures, texels.
    pub size: usize,
    /// R, G, B per texel; its scale is that of 1 / S_d.
    pub diffuse: Vec<f32>,
    /// One value per texel; its scale is that of 1 / S_s.
    pub specular: Vec<f32>,
    /// Deviation from the mesh normal, before tanh; x, y, z per texel.
    pub deviation: Vec<f32>,
}

impl State {
    /// Brings the textures to another size.
    pub fn resize(&mut self, size: usize) {
        if size == self.size {
            return;
        }
        self.diffuse = resample(&self.diffuse, self.size, 3, size);
        self.specular = resample(&self.specular, self.size, 1, size);
        self.deviation = resample(&self.deviation, self.size, 3, size);
        self.size = size;
    }

    /// Diffuse and specular albedo at every sample.
    pub fn albedo(&self, samples: &Samples) -> Planes {
        samples.taps.sample_vectors(&self.albedo_texture())
    }

    /// Diffuse and specular albedo, texel by texel.
    fn albedo_texture(&self) -> Vec<f32> {
        interleave::<ALBEDOS>(&[(&self.diffuse, 3), (&self.specular, 1)])
    }
}

/// One stage: a number of full-batch steps on some part of the state.
pub trait Stage {
    /// For progress and record.
    fn name(&self) -> String;
    /// How many steps.
    fn iterations(&self) -> usize;
    /// One step, by `share` of the learning rates; the loss before it.
    fn step(&mut self, state: &mut State, backend: &dyn Backend, share: f32) -> f64;
    /// For checkpoints: with the state, all that is needed to go on with the same bits.
    fn memory(&mut self) -> Memory<'_>;
    /// For a device that may take the stage in; nothing if there is no program for it.
    fn job(&self) -> Option<Job<'_>> {
        None
    }
    /// What moves, in the order that the job says.
    fn variables<'a>(&'a mut self, _state: &'a mut State) -> Vec<Variable<'a>> {
        vec![]
    }
}

/// What a stage keeps from step to step besides the state, in a fixed order.
#[derive(Serialize)]
pub struct Memory<'a> {
    /// Its optimisers.
    pub optimisers: Vec<&'a mut Adam>,
    /// Parameters of its own.
    pub own: Vec<&'a mut Vec<f32>>,
}

impl<'a> Memory<'a> {
    /// Of a stage without parameters of its own.
    pub fn new(optimisers: Vec<&'a mut Adam>) -> Self {
        Self { optimisers, own: vec![] }
    }
}

/// Networks and albedos together (section 4.3.1).
pub struct WarmUp<'a> {
    config: &'a Config,
    samples: &'a Samples,
    directions: Planes,
    /// Of the networks.
    shape: Vec<usize>,
    networks: Adam,
    diffuse: Adam,
    specular: Adam,
}

impl<'a> WarmUp<'a> {
    /// A warm-up on samples whose taps are of the state's size.
    pub fn new(config: &'a Config, samples: &'a Samples, state: &State) -> Self {
        let (w, adam) = (&config.warm_up, &config.adam);
        Self {
            config,
            samples,
            directions: DirectionScale::from(&config.networks).directions(samples, None),
            shape: state.networks.shape.clone(),
            networks: Adam::new(adam, w.network_rate, state.networks.parameters.len()),
            diffuse: Adam::new(adam, w.diffuse_rate, state.diffuse.len()),
            specular: Adam::new(adam, w.specular_rate, state.specular.len()),
        }
    }

    /// Loss and its gradient.
    pub(super) fn gradient(&self, state: &State, backend: &dyn Backend) -> WarmUpGradient {
        let albedo = state.albedo_texture();
        let joint =
            backend.joint_textures(&state.networks, self.samples, &self.directions, &albedo);
        let mut diffuse = part::<ALBEDOS, 3>(&joint.albedo, 0);
        let specular = part::<ALBEDOS, 1>(&joint.albedo, 3);
        let prior = prior(&state.diffuse, state.size, self.config.warm_up.prior, &mut diffuse);
        WarmUpGradient { loss: joint.loss + prior, networks: joint.networks, diffuse, specular }
    }
}

/// Gradients of the warm-up's loss.
pub(super) struct WarmUpGradient {
    pub loss: f64,
    pub networks: Vec<f32>,
    pub diffuse: Vec<f32>,
    pub specular: Vec<f32>,
}

impl Stage for WarmUp<'_> {
    fn name(&self) -> String {
        "warm-up".to_owned()
    }

    fn iterations(&self) -> usize {
        self.config.warm_up.iterations
    }

    fn step(&mut self, state: &mut State, backend: &dyn Backend, share: f32) -> f64 {
        let WarmUpGradient { loss, networks, diffuse, specular } = self.gradient(state, backend);
        let gradients = [networks, diffuse, specular];
        self.variables(state).iter_mut().zip(&gradients).for_each(|(v, g)| v.step(g, share));
        loss
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory::new(vec![&mut self.networks, &mut self.diffuse, &mut self.specular])
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Joint {
            samples: self.samples,
            directions: &self.directions,
            shape: &self.shape,
            prior: self.config.warm_up.prior,
        })
    }

    fn variables<'a>(&'a mut self, state: &'a mut State) -> Vec<Variable<'a>> {
        let (free, least) = (f32::NEG_INFINITY, least_albedo(self.config));
        vec![
            Variable::new(&mut state.networks.parameters, &mut self.networks, free),
            Variable::new(&mut state.diffuse, &mut self.diffuse, least),
            Variable::new(&mut state.specular, &mut self.specular, least),
        ]
    }
}

/// Specular albedo and deviation, with frozen networks and diffuse albedo (section 4.3.2).
pub struct Relief<'a> {
    config: &'a Config,
    samples: &'a Samples,
    deviation: &'a Deviation,
    name: String,
    networks: Networks,
    light: Planes,
    albedo: Planes,
    /// Texels that samples see, and those on which these depend.
    sampled: Region,
    reach: Vec<Region>,
    /// Of a step, kept for the next one's. What the region leaves out stays zero.
    by_texel: BendGradient,
    /// The deviation d and the specular albedo, and how many steps led to them.
    seen: (usize, Seen),
    by_deviation: Adam,
    by_specular: Adam,
}

impl<'a> Relief<'a> {
    /// The stage of one round; L(p) and the diffuse albedo are evaluated once.
    pub fn new(
        config: &'a Config,
        samples: &'a Samples,
        deviation: &'a Deviation,
        state: &State,
        backend: &dyn Backend,
        round: usize,
    ) -> Self {
        let (f, adam) = (&config.fine_tuning, &config.adam);
        let sampled = samples.taps.region();
        Self {
            config,
            samples,
            deviation,
            reach: deviation.reach(&sampled),
            sampled,
            by_texel: BendGradient::new(deviation.blur()),
            seen: (0, Seen::default()),
            name: format!("normals and specular {round}"),
            networks: state.networks.clone(),
            light: backend.light(&state.networks, &samples.position),
            albedo: state.albedo(samples),
            by_deviation: Adam::new(adam, f.deviation_rate, state.deviation.len()),
            by_specular: Adam::new(adam, f.specular_rate, state.specular.len()),
        }
    }

    /// Loss; its gradients by the texels are kept.
    fn differentiate(&mut self, state: &State, backend: &dyn Backend) -> f64 {
        let Self { deviation, sampled, by_texel, seen: (_, seen), reach, .. } = self;
        let base = &deviation.base(seen, reach);
        let relief = TexturedRelief {
            networks: &state.networks,
            samples: self.samples,
            light: &self.light,
            albedo: &self.albedo,
            textures: BentTextures { deviation, texels: &seen.texels, base, region: sampled },
        };
        backend.bend_textures(&relief, by_texel)
    }

    /// Loss, and its gradients by deviation and specular albedo.
    pub(super) fn gradient(&mut self, state: &State, backend: &dyn Backend) -> ReliefGradient {
        self.seen.1 = self.deviation.seen(&state.deviation, &state.specular, &self.reach);
        let loss = self.differentiate(state, backend);
        let (deviation, size) = (self.deviation, state.size);
        let [mut by_band, mut specular] = [3, 1].map(|channels| vec![0.0; channels * size * size]);
        let rows = by_band.chunks_mut(3 * size).zip(specular.chunks_mut(size)).collect();
        let write = |place: &Place, found: Gradients, _: &mut [Texel], (a, b): &mut Rows| {
            a[place.within(3)].copy_from_slice(found.by_band);
            b[place.within(1)].copy_from_slice(found.by_specular);
        };
        deviation.adjoint(&self.by_texel, &self.reach, &mut self.seen.1, rows, write);
        ReliefGradient { loss, deviation: deviation.band_adjoint(by_band), specular }
    }
}

/// Of both textures.
type Rows<'a> = (&'a mut [f32], &'a mut [f32]);

/// Gradients of the loss.
pub(super) struct ReliefGradient {
    pub loss: f64,
    pub deviation: Vec<f32>,
    pub specular: Vec<f32>,
}

/// The same of the textures with what moves them.
type Moved<'a> = (Part<'a>, Part<'a>);

impl Stage for Relief<'_> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn iterations(&self) -> usize {
        self.config.fine_tuning.iterations
    }

    fn step(&mut self, state: &mut State, backend: &dyn Backend, share: f32) -> f64 {
        let (least, size) = (least_albedo(self.config), state.size);
        if self.deviation.banded() {
            let ReliefGradient { loss, deviation, specular } = self.gradient(state, backend);
            let gradients = [deviation, specular];
            self.variables(state).iter_mut().zip(&gradients).for_each(|(v, g)| v.step(g, share));
            return loss;
        }
        // Without gradients of whole textures between the blur and the step.
        let done = self.by_deviation.steps();
        if self.seen.1.texels.is_empty() || self.seen.0 != done {
            // The last step was not taken here.
            self.seen.1 = self.deviation.seen(&state.deviation, &state.specular, &self.reach);
        }
        let loss = self.differentiate(state, backend);
        self.seen.0 = done + 1;
        let Self { deviation, by_deviation, by_specular, seen: (_, seen), .. } = self;
        let free = f32::NEG_INFINITY;
        let rows = by_deviation.rows(&mut state.deviation, 3 * size, share, free);
        let rows = rows.zip(by_specular.rows(&mut state.specular, size, share, least));
        let rows = rows.collect();
        let write = |place: &Place, found: Gradients, texels: &mut [Texel], (a, b): &mut Moved| {
            let (three, one) = (place.within(3), place.within(1));
            a.step(three.clone(), found.by_band);
            b.step(one.clone(), found.by_specular);
            deviation.put(texels, &a.parameters[three], &b.parameters[one]);
        };
        deviation.adjoint(&self.by_texel, &self.reach, seen, rows, write);
        loss
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory::new(vec![&mut self.by_deviation, &mut self.by_specular])
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Relief(ReliefJob {
            samples: self.samples,
            deviation: self.deviation,
            networks: &self.networks,
            light: &self.light,
            albedo: &self.albedo,
        }))
    }

    fn variables<'a>(&'a mut self, state: &'a mut State) -> Vec<Variable<'a>> {
        let least = least_albedo(self.config);
        vec![
            Variable::new(&mut state.deviation, &mut self.by_deviation, f32::NEG_INFINITY),
            Variable::new(&mut state.specular, &mut self.by_specular, least),
        ]
    }
}

/// Diffuse albedo alone, with frozen shading (section 4.3.2).
pub struct Diffuse<'a> {
    config: &'a Config,
    samples: &'a Samples,
    name: String,
    iterations: usize,
    prior: f32,
    layer: Layer,
    by_diffuse: Adam,
}

impl<'a> Diffuse<'a> {
    /// The stage of one round; no network is evaluated after this.
    pub fn new(
        config: &'a Config,
        samples: &'a Samples,
        deviation: &Deviation,
        state: &State,
        backend: &dyn Backend,
        round: usize,
    ) -> Self {
        let layers = layers(samples, deviation, state, backend);
        let shading = Planes::from_fn(samples.len(), |i| {
            let [diffuse, specular] = layers.sample(i, 0);
            [diffuse, diffuse, diffuse, specular]
        });
        let (iterations, prior) = (config.fine_tuning.iterations, config.fine_tuning.prior);
        Self::under(config, samples, &shading, format!("diffuse {round}"), iterations, prior)
    }

    /// Under known shading: S_d of every channel, and the specular layer.
    pub fn under(
        config: &'a Config,
        samples: &'a Samples,
        shading: &Planes,
        name: String,
        iterations: usize,
        prior: f32,
    ) -> Self {
        let count = 3 * samples.taps.size() * samples.taps.size();
        let by_diffuse = Adam::new(&config.adam, config.fine_tuning.diffuse_rate, count);
        Self {
            config,
            samples,
            name,
            iterations,
            prior,
            layer: Layer::new(samples, shading),
            by_diffuse,
        }
    }

    /// Loss and its gradient by the diffuse albedo.
    pub(super) fn gradient(&self, state: &State) -> (f64, Vec<f32>) {
        let (loss, mut by_diffuse) = self.layer.gradient(self.samples, &state.diffuse);
        let prior = prior(&state.diffuse, state.size, self.prior, &mut by_diffuse);
        (loss + prior, by_diffuse)
    }
}

impl Stage for Diffuse<'_> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn step(&mut self, state: &mut State, _backend: &dyn Backend, share: f32) -> f64 {
        let (loss, by_diffuse) = self.gradient(state);
        self.by_diffuse.step(&mut state.diffuse, &by_diffuse, share, least_albedo(self.config));
        loss
    }

    fn memory(&mut self) -> Memory<'_> {
        Memory::new(vec![&mut self.by_diffuse])
    }

    fn job(&self) -> Option<Job<'_>> {
        let samples = self.samples;
        let known = Planes::from_fn(samples.len(), |i| {
            let [factor, target] = self.layer.known(i);
            let [r, g, b] = (target - factor.w).truncate().to_array();
            [r, g, b, target.w, factor.x, factor.y, factor.z]
        });
        Some(Job::Layer { taps: &samples.taps, known, prior: self.prior })
    }

    fn variables<'a>(&'a mut self, state: &'a mut State) -> Vec<Variable<'a>> {
        let least = least_albedo(self.config);
        vec![Variable::new(&mut state.diffuse, &mut self.by_diffuse, least)]
    }
}

/// The diffuse shading S_d and the specular layer F A_s S_s at every sample.
pub fn layers(
    samples: &Samples,
    deviation: &Deviation,
    state: &State,
    backend: &dyn Backend,
) -> Planes {
    let region = &samples.taps.region();
    let reach = deviation.reach(region);
    let seen = deviation.seen(&state.deviation, &state.specular, &reach);
    let base = &deviation.base(&seen, &reach);
    let textures = BentTextures { deviation, texels: &seen.texels, base, region };
    let bent = textures.sample(&samples.taps);
    let directions = deviation.scale.directions(samples, Some(&bent));
    let light = backend.light(&state.networks, &samples.position);
    let shading = backend.shade(&state.networks, &light, &directions);
    Planes::from_fn(samples.len(), |i| {
        let [diffuse, specular] = shading.sample(i, 0);
        [diffuse, samples.fresnel.get(0, i) * bent.get(6, i) * specular]
    })
}

pub(super) fn least_albedo(config: &Config) -> f32 {
    if config.rendering.positive_albedo { 0.0 } else { f32::NEG_INFINITY }
}
