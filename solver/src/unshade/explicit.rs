//! The explicit model of the pictures: diffuse shading and highlights by the light of their illumination.
//!
//! A pixel is A_d S_d + A_s H l. H is the reflection of two GGX lobes over the visible cells, and the same light l
//! causes shading and highlights. The position of a highlight constrains the direction of its lamp, its colour the
//! lamp's colour.

use std::borrow::Cow;

use super::grey::grey_prior;
use super::illuminations::{Illuminations, PartOfSamples, by_parts};
use super::regression::Regression;
use crate::config::{LightConfig, ModelErrorConfig, UnshadeConfig};
use crate::model::planes::Planes;
use crate::model::prior::albedo_prior;
use crate::model::samples::Samples;
use crate::transport::{CHANNELS, GREEN, Reflection, SpecularTerm, Transport, light_colour};

/// Least error of the model, radiance.
const LEAST_ERROR: f32 = 1e-5;

/// The share of a region's samples that highlights may exceed: those in shadows that the mesh does not have.
const DARKEST: f32 = 0.1;

/// The model on the transport's texture.
pub(super) struct ExplicitModel<'a> {
    pub(super) config: &'a LightConfig,
    prior_weight: f32,
    has_grey_prior: bool,
    pub(super) transport: &'a Transport,
    illuminations: &'a Illuminations,
    pub(super) samples: Samples,
    split: Vec<PartOfSamples>,
    /// One for each part of `split`.
    parts: Vec<ModelPart>,
}

/// The samples of one illumination.
struct ModelPart {
    illumination: usize,
    samples: Samples,
    reflection: Reflection,
    /// See [`Transport::rows_of`].
    rows: Vec<bool>,
}

/// The diffuse shading of one illumination.
struct Shading {
    /// R, G, B per texel.
    values: Vec<f32>,
    by_nearness: Option<Vec<f32>>,
}

/// Loss and gradients of an [`ExplicitModel`].
pub(super) struct Gradient {
    pub loss: f64,
    /// Gradient with respect to log radiance, see [`Illuminations`].
    pub by_log_light: Vec<f32>,
    /// Gradient with respect to relative nearness; 0 if the transport has no derivative with respect to it.
    pub by_relative_nearness: f32,
    /// Gradient with respect to the albedo.
    pub by_albedo: Vec<f32>,
}

impl<'a> ExplicitModel<'a> {
    /// Highlights are scaled by the [peak](Illuminations::peak) of `light`, R, G, B per cell of every group, so that
    /// `terms` ([`SpecularTerm`] per texel) are reflectances under this light; the light of the highlights has this
    /// nearness. The samples' taps and the terms have the transport's size.
    pub fn new(
        config: &'a UnshadeConfig,
        transport: &'a Transport,
        illuminations: &'a Illuminations,
        samples: &Samples,
        terms: &[f32],
        light: &[f32],
        nearness_per_metre: f32,
    ) -> Self {
        let samples = samples.thinned(config.light.samples);
        let peak = illuminations.peak(transport, light);
        let split = illuminations.parts(&samples);
        let part = |part: &PartOfSamples| {
            let samples = part.samples(&samples).into_owned();
            let specular = samples.taps.sample::<{ SpecularTerm::ROWS }>(terms);
            let reflection =
                transport.reflection(&config.skin, &samples, &specular, peak, nearness_per_metre);
            let rows = transport.rows_of(&samples);
            ModelPart { illumination: part.illumination, samples, reflection, rows }
        };
        let parts = split.iter().map(part).collect();
        Self {
            config: &config.light,
            prior_weight: config.joint.prior,
            has_grey_prior: false,
            transport,
            illuminations,
            samples,
            split,
            parts,
        }
    }

    /// Enables or disables the prior on grey shading.
    #[must_use]
    pub(super) fn with_grey_prior(self, has_grey_prior: bool) -> Self {
        Self { has_grey_prior, ..self }
    }

    /// The light of a part.
    fn light<'b>(&self, light: &'b [f32], part: &ModelPart, nearness: f32) -> Cow<'b, [f32]> {
        self.illuminations.light(light, part.illumination, nearness)
    }

    /// The shading of every part; without `all_rows`, only where its samples read it.
    fn shadings(&self, light: &[f32], relative_nearness: f32, all_rows: bool) -> Vec<Shading> {
        let shading = |part: &ModelPart| {
            let light = self.light(light, part, relative_nearness);
            let (values, by_nearness) = match all_rows {
                true => self.transport.shading_nearer(&light, relative_nearness),
                false => self.transport.shading_of_rows(&light, relative_nearness, &part.rows),
            };
            Shading { values, by_nearness }
        };
        self.parts.iter().map(shading).collect()
    }

    /// Colours of all samples, computed part by part.
    fn by_parts(&self, colours: impl Fn(usize, &ModelPart) -> Planes) -> Planes {
        let colours = |at: usize, _: &PartOfSamples| colours(at, &self.parts[at]);
        by_parts::<CHANNELS>(&self.split, self.samples.len(), colours)
    }

    /// The predicted highlights of all samples.
    fn highlights(&self, light: &[f32], relative_nearness: f32) -> Planes {
        self.by_parts(|_, part| {
            let light = self.light(light, part, relative_nearness);
            let radiance = part.reflection.radiance(&light);
            Planes::from_fn(radiance.len(), |i| radiance[i])
        })
    }

    /// The factor on each channel that gives the light the colour of its highlights, at the same
    /// [peak](Illuminations::peak); the albedo is to be divided by it.
    pub(super) fn tint(
        &self,
        light: &[f32],
        relative_nearness: f32,
        albedo: &[f32],
    ) -> [f32; CHANNELS] {
        let weight = &self.samples.weight;
        let tint = self.regression(light, relative_nearness, albedo, weight, None).tint();
        let tinted: Vec<f32> = light.iter().zip(tint.iter().cycle()).map(|(l, t)| l * t).collect();
        let [before, after] =
            [light, &tinted].map(|light| self.illuminations.peak(self.transport, light));
        if before == 0.0 { [1.0; CHANNELS] } else { tint.map(|t| t * before / after) }
    }

    /// The regression of the pictures without the diffuse layer on the highlights. `weight` has the weights of the
    /// model's samples. With `errors` they are divided by the variance of the model, so that the few strong highlights
    /// do not dominate.
    pub(super) fn regression(
        &self,
        light: &[f32],
        relative_nearness: f32,
        albedo: &[f32],
        weight: &Planes,
        errors: Option<&ModelErrorConfig>,
    ) -> Regression {
        let samples = &self.samples;
        let shadings = self.shadings(light, relative_nearness, true);
        let layer = self.by_parts(|at, part| {
            part.samples.taps.sample::<CHANNELS>(&product(albedo, &shadings[at].values))
        });
        let observed =
            |i: usize| std::array::from_fn(|c| samples.target.get(c, i) - layer.get(c, i));
        let predicted = self.highlights(light, relative_nearness);
        // Diffuse radiance of one illumination does not depend on the view; else it is that of its shading.
        let basis = (self.parts.len() > 1).then(|| {
            self.by_parts(|at, part| part.samples.taps.sample::<CHANNELS>(&shadings[at].values))
        });
        let rows = |i: usize| [predicted.sample(i, 0), [0.0; CHANNELS]];
        let Some(errors) = errors else {
            return Regression::new(samples, weight, basis.as_ref(), rows, observed);
        };
        let mean =
            |shading: &Shading| shading.values.iter().sum::<f32>() / shading.values.len() as f32;
        let mean = shadings.iter().map(mean).sum::<f32>() / shadings.len() as f32;
        let albedo = samples.taps.sample::<CHANNELS>(albedo);
        let weight = Planes::from_fn(samples.len(), |i| {
            let diffuse = errors.shadow * mean * albedo.get(GREEN, i);
            let error = diffuse.hypot(errors.highlights * predicted.get(GREEN, i));
            [weight.get(0, i) / error.max(LEAST_ERROR).powi(2)]
        });
        Regression::new(samples, &weight, basis.as_ref(), rows, observed)
    }

    /// The factors on the highlights of each region at which they alone explain its [`DARKEST`] samples. `weight` has
    /// the weights of the model's samples, `regions` the region of every texel.
    pub(super) fn highlight_limits(
        &self,
        light: &[f32],
        relative_nearness: f32,
        weight: &Planes,
        regions: &[u8],
    ) -> [f32; 256] {
        let predicted = self.highlights(light, relative_nearness);
        let mut limits: Vec<Vec<(f32, f32)>> = vec![vec![]; 256];
        for i in 0..self.samples.len() {
            let highlight: [f32; CHANNELS] = predicted.sample(i, 0);
            let region = usize::from(regions[self.samples.taps.nearest(i)]);
            let limit = (0..CHANNELS).map(|c| self.samples.target.get(c, i) / highlight[c]);
            let limit = limit.fold(f32::INFINITY, f32::min);
            limits[region].push((limit, weight.get(0, i)));
        }
        std::array::from_fn(|region| {
            let limits = &mut limits[region];
            limits.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut left = DARKEST * limits.iter().map(|(_, weight)| weight).sum::<f32>();
            let above = limits.iter().find(|(_, weight)| {
                left -= weight;
                left < 0.0
            });
            above.map_or(f32::INFINITY, |(limit, _)| limit.max(0.0))
        })
    }

    /// The loss and its gradients.
    pub(super) fn gradient(
        &self,
        log_light: &[f32],
        relative_nearness: f32,
        albedo: &[f32],
    ) -> Gradient {
        let light = exp(log_light);
        let shadings = self.shadings(&light, relative_nearness, self.has_grey_prior);
        let scale = 1.0 / (CHANNELS * self.samples.len()) as f32;
        let mut loss = 0.0;
        let mut by_albedo = vec![0.0; albedo.len()];
        let mut by_shadings = vec![];
        let mut by_lights_of_highlights = vec![];
        for (part, shading) in self.parts.iter().zip(&shadings) {
            let samples = &part.samples;
            let layer = samples.taps.sample::<CHANNELS>(&product(albedo, &shading.values));
            let residual = |i: usize, highlight: [f32; CHANNELS]| {
                let weight = scale * samples.weight.get(0, i);
                let mut loss = 0.0;
                let by = std::array::from_fn(|c| {
                    let residual = layer.get(c, i) + highlight[c] - samples.target.get(c, i);
                    loss += f64::from(weight * residual.abs());
                    if residual == 0.0 { 0.0 } else { weight.copysign(residual) }
                });
                (by, (by, loss))
            };
            let light = self.light(&light, part, relative_nearness);
            let (by_light, by_sample) = part.reflection.exchange(&light, residual);
            let by_layer = Planes::from_fn(samples.len(), |i| by_sample[i].0);
            let by_layer = samples.taps.gather::<CHANNELS>(&by_layer, 0);
            let texels = by_albedo.iter_mut().zip(by_layer.iter().zip(&shading.values));
            texels.for_each(|(sum, (by, shading))| *sum += by * shading);
            by_shadings.push(product(&by_layer, albedo));
            by_lights_of_highlights.push(by_light);
            loss += by_sample.iter().map(|(_, loss)| loss).sum::<f64>();
        }
        let grey = if self.has_grey_prior { grey_of_all(&shadings, &mut by_shadings) } else { 0.0 };
        let size = self.transport.size();
        let smoothness = albedo_prior(albedo, size, self.prior_weight, &mut by_albedo);
        let mut by_log_light = vec![0.0; log_light.len()];
        let mut by_relative_nearness = 0.0;
        let highlights = by_lights_of_highlights.iter().zip(&by_shadings);
        for ((part, shading), (by_highlights, by_shading)) in
            self.parts.iter().zip(&shadings).zip(highlights)
        {
            let mut by_light = self.transport.adjoint_nearer(by_shading, relative_nearness);
            by_light.iter_mut().zip(by_highlights).for_each(|(sum, by)| *sum += by);
            let (lights, at) = (self.illuminations, part.illumination);
            lights.add_adjoint(&by_light, at, relative_nearness, &mut by_log_light);
            let of_shading = shading.by_nearness.as_deref().map(|slopes| dot(slopes, by_shading));
            let of_light =
                lights.light_by_nearness(&light, at).map(|slopes| dot(&slopes, &by_light));
            by_relative_nearness += of_shading.unwrap_or(0.0) + of_light.unwrap_or(0.0);
        }
        by_log_light.iter_mut().zip(&light).for_each(|(by, light)| *by *= light);
        let colour = self.light_colour(log_light, &mut by_log_light);
        Gradient {
            loss: loss + smoothness + colour + grey,
            by_log_light,
            by_relative_nearness: by_relative_nearness as f32,
            by_albedo,
        }
    }

    /// The penalty on colour differences between the cells of every group, whose mean counts.
    fn light_colour(&self, log_light: &[f32], gradient: &mut [f32]) -> f64 {
        let LightConfig { colour, colour_softness, .. } = *self.config;
        let groups = self.illuminations.groups();
        let each = log_light.len() / groups;
        let groups_of = log_light.chunks_exact(each).zip(gradient.chunks_exact_mut(each));
        let weight = colour / groups as f32;
        groups_of.map(|(log, by)| light_colour(log, weight, colour_softness, by)).sum()
    }
}

fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}

/// The products of the values of two textures.
fn product(a: &[f32], b: &[f32]) -> Vec<f32> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

/// The prior on grey shading of all illuminations together, whose gradient is added: one tint is ambiguous.
fn grey_of_all(shadings: &[Shading], by_shadings: &mut [Vec<f32>]) -> f64 {
    if let ([shading], [by]) = (shadings, &mut *by_shadings) {
        return grey_prior(&shading.values, by);
    }
    let all: Vec<f32> = shadings.iter().flat_map(|shading| &shading.values).copied().collect();
    let mut by_all = vec![0.0; all.len()];
    let penalty = grey_prior(&all, &mut by_all);
    let sums = by_shadings.iter_mut().flatten().zip(&by_all);
    sums.for_each(|(sum, by)| *sum += by);
    penalty
}

/// The exponentials of a light's logarithm.
pub(super) fn exp(log_light: &[f32]) -> Vec<f32> {
    log_light.iter().map(|log| log.exp()).collect()
}
