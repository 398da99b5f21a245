//! Results of explicit transport: light, shading, albedo, and the specular floor.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::context::{SolveContext, TransportSetup};
use super::region_terms::RegionTerms;
use super::specular_floor::{specular_floor, without_specular_floor};
use super::stage::{State, layers};
use crate::backend::Backend;
use crate::model::deviation::Deviation;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, resample};
use crate::solution::RecoveredLight;
use crate::transport::{CHANNELS, luminances};

/// The light that explicit transport found, with shading and albedo under it, on its own texture.
#[derive(Serialize, Deserialize)]
pub(super) struct Lighting {
    pub state: State,
    /// S_d, R, G, B per texel.
    shading: Vec<f32>,
    /// How it changes with the normal, 9 values per texel; see [`crate::transport::Transport::shading_by_normal`].
    shading_by_normal: Vec<f32>,
    /// S_d of full light on a surface that faces it.
    pub peak: f32,
    /// See [`specular_floor`], R, G, B per texel; empty if it is switched off.
    pub specular_floor: Vec<f32>,
    /// The specular albedo that the specular floor goes by; empty if it is switched off.
    pub skin_specular: Vec<f32>,
    /// Specular region_terms by region.
    pub region_terms: Option<RegionTerms>,
    /// By what the pictures are brighter than those of a light with this peak.
    pub exposure: f32,
    /// Whether the light has been solved for with its highlights.
    pub explained: bool,
    /// See [`super::light_estimate::LightEstimate::doubt`].
    pub doubt: Option<f32>,
    /// See [`crate::config::TransportConfig::even_contrast`].
    even_contrast: f32,
    pub setup: TransportSetup,
    /// The light for the record.
    pub light: RecoveredLight,
}

/// 1 of a light without contrast, a half of one that has `half_even`, 0 of lamps in the dark.
pub(super) fn evenness(contrast: f32, half_even: f32) -> f32 {
    1.0 / (1.0 + (contrast / half_even).powi(2))
}

impl Lighting {
    /// Lighting by a light of `radiance`, with the textures of `state`; `region_terms` are [`Lighting::region_terms`].
    pub fn new(
        context: &SolveContext,
        samples: &Samples,
        state: State,
        region_terms: Option<RegionTerms>,
        setup: TransportSetup,
        radiance: Vec<f32>,
    ) -> Self {
        let (config, transport) = (context.config, context.transport(setup));
        let regions = region_terms.as_ref().and_then(|_| context.regions_on(state.size));
        let skin_specular = match (&region_terms, regions) {
            (Some(region_terms), Some(regions)) => region_terms.texture(&regions),
            _ => vec![],
        };
        let exposure = region_terms.as_ref().map_or(1.0, |all| all.exposure(&config.reflectance));
        let specular_floor = match skin_specular.is_empty() {
            true => vec![],
            false => specular_floor(
                config,
                transport,
                samples,
                &state,
                context.backend,
                &radiance,
                &skin_specular,
            ),
        };
        let distance = (setup.nearness > 0.0).then(|| setup.nearness.recip());
        Self {
            state,
            shading: transport.shading(&radiance),
            shading_by_normal: transport.shading_by_normal(&radiance).unwrap_or_default(),
            peak: transport.peak(&radiance),
            specular_floor,
            skin_specular,
            region_terms,
            exposure,
            explained: false,
            doubt: None,
            even_contrast: config.transport.even_contrast,
            setup,
            light: RecoveredLight { rows: config.transport.rows, distance, radiance },
        }
    }

    /// Replaces what regions mirror; `regions` are those of its own texture.
    pub fn take_terms(&mut self, terms: RegionTerms, regions: &[u8]) {
        self.skin_specular = terms.texture(regions);
        self.region_terms = Some(terms);
    }

    /// How much shading and the networks' highlights say of relief: the squared contrast of the light, and
    /// next to nothing where it is even.
    pub fn evidence_of_normals(&self) -> f32 {
        self.light.contrast().powi(2) * (1.0 - self.evenness())
    }

    /// Share of the specular floor that is taken out of the pictures: all of it by a light whose highlights are
    /// explained; by another, little of it where the light has contrast, because there the networks see the
    /// highlights themselves, and the prediction errs more.
    fn share(&self) -> f32 {
        if self.explained { 1.0 } else { self.evenness() }
    }

    /// 1 of a light that is the same from everywhere, 0 of lamps in the dark.
    pub fn evenness(&self) -> f32 {
        evenness(self.light.contrast(), self.even_contrast)
    }

    /// The pictures less their share of what all views share of the highlights.
    pub fn without_specular_floor(&self, samples: &Samples) -> Planes {
        if self.specular_floor.is_empty() {
            return samples.target.clone();
        }
        let share = self.share();
        let specular_floor: Vec<f32> =
            self.specular_floor.iter().map(|specular_floor| share * specular_floor).collect();
        without_specular_floor(samples, &specular_floor, self.state.size)
    }

    /// The highlights on the textures and under the normals of `state`, if the specular floor is known.
    pub fn highlights(&self, state: &State) -> Option<Highlights> {
        if self.specular_floor.is_empty() {
            return None;
        }
        let specular_floor =
            resample(&luminances(&self.specular_floor), self.state.size, 1, state.size);
        let mut own = self.state.clone();
        own.resize(state.size);
        own.deviation.clone_from(&state.deviation);
        Some(Highlights { own, specular_floor })
    }

    /// S_d at every sample, and how it changes with the normal ([`SHADING_ROWS`] rows).
    pub fn sampled(&self, samples: &Samples) -> Planes {
        let size = samples.taps.size();
        let shading = resample(&self.shading, self.state.size, CHANNELS, size);
        let shading_by_normal =
            resample(&self.shading_by_normal, self.state.size, 3 * CHANNELS, size);
        let parts: [(&[f32], usize); 2] =
            [(&shading, CHANNELS), (&shading_by_normal, 3 * CHANNELS)];
        samples.taps.sample::<SHADING_ROWS>(&interleave::<SHADING_ROWS>(&parts))
    }
}

/// The specular layer with what all views share of it.
pub(super) struct Highlights {
    own: State,
    specular_floor: Vec<f32>,
}

impl Highlights {
    /// One radiance per sample.
    pub fn at(&self, samples: &Samples, deviation: &Deviation, backend: &dyn Backend) -> Planes {
        let layers = layers(samples, deviation, &self.own, backend);
        let specular_floor = samples.taps.sample::<1>(&self.specular_floor);
        Planes::from_fn(samples.len(), |i| [layers.get(1, i) + specular_floor.get(0, i)])
    }
}

/// Rows of [`Lighting::sampled`]: S_d (3), its changes with the normal (9).
pub(super) const SHADING_ROWS: usize = 4 * CHANNELS;

/// S_d with the normal bent from `normal` to `bent`, both unit.
pub(super) fn bent_shading(
    lighting: &[f32; SHADING_ROWS],
    normal: Vec3,
    bent: Vec3,
) -> [f32; CHANNELS] {
    std::array::from_fn(|c| {
        let slope = Vec3::from_slice(&lighting[CHANNELS + 3 * c..]);
        (lighting[c] + slope.dot(bent - normal)).max(0.0)
    })
}
