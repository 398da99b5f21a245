//! The inputs of a solve's steps. All of it follows from the capture and the configuration, so
//! that none of it is in a checkpoint; it is made when a step first asks for it.

use std::cell::OnceCell;

use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::Projection;
use capture::{Capture, View};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::clock::Extent;
use super::stage::State;
use crate::backend::Backend;
use crate::config::{Config, TransportConfig, ViewWeightConfig, texture_size};
use crate::model::deviation::Deviation;
use crate::model::networks::Networks;
use crate::model::samples::{SampleSpace, Samples};
use crate::semantic::{self, found::FoundRegions};
use crate::transport::{Beside, CHANNELS, LUMINANCE, Sky, Transport};

/// Capture, configuration, backend, and what steps share that follows from them.
pub(super) struct SolveContext<'a> {
    pub backend: &'a dyn Backend,
    pub capture: &'a Capture,
    pub config: &'a Config,
    pub space: SampleSpace,
    /// Factor on the pictures, so that no rate or weight depends on their exposure.
    pub gain: f32,
    /// G-buffers of the training views, in full resolution.
    pub gbuffers: Vec<GBuffer>,
    /// Their samples.
    pub pixels: usize,
    /// Side of the fine-tuned textures.
    pub size: usize,
    pictures: OnceCell<WarmUpPictures>,
    far_transport: OnceCell<Transport>,
    transport: OnceCell<Transport>,
    coarse: OnceCell<Samples>,
    fine: OnceCell<Fine>,
    found_regions: OnceCell<FoundRegions>,
}

/// Where the light is, and what bounces: what a transport is cast for.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct TransportSetup {
    /// Inverse distance of the light, per metre.
    pub nearness: f32,
    /// Reflectance, 0 to 1, that light bounces off: that of most of the face.
    pub bounce_albedo: f32,
}

/// The full pictures with the final textures.
pub(super) struct Fine {
    pub samples: Samples,
    pub deviation: Deviation,
}

impl<'a> SolveContext<'a> {
    /// How much there is to solve.
    pub fn extent(&self) -> Extent {
        Extent { views: self.capture.train.len(), pixels: self.pixels, texture_size: self.size }
    }

    pub fn new(backend: &'a dyn Backend, capture: &'a Capture, config: &'a Config) -> Self {
        let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
        let pixels = gbuffers.iter().map(GBuffer::len).sum();
        let gain = gain(capture, &gbuffers, config.rendering.exposure);
        Self {
            backend,
            capture,
            config,
            space: SampleSpace::new(&capture.mesh, config).exposed(gain),
            gain,
            gbuffers,
            pixels,
            size: texture_size(config.fine_tuning.texture_size, capture),
            pictures: OnceCell::new(),
            far_transport: OnceCell::new(),
            transport: OnceCell::new(),
            coarse: OnceCell::new(),
            fine: OnceCell::new(),
            found_regions: OnceCell::new(),
        }
    }

    /// The training pictures as the warm-up takes them.
    pub fn pictures(&self) -> &WarmUpPictures {
        self.pictures.get_or_init(|| WarmUpPictures::new(self.capture, &self.gbuffers, self.config))
    }

    /// The samples of the warm-up.
    pub fn coarse(&self) -> &Samples {
        let size = self.config.warm_up.texture_size;
        self.coarse.get_or_init(|| self.pictures().samples(&self.space, size))
    }

    /// Samples and deviation of the fine-tuning.
    pub fn fine(&self) -> &Fine {
        self.fine.get_or_init(|| Fine {
            samples: self.samples(self.size),
            deviation: Deviation::new(self.config, self.size),
        })
    }

    /// The full pictures, for textures of side `size`.
    pub fn samples(&self, size: usize) -> Samples {
        let weights = &self.config.view_weights;
        self.space.training(&self.capture.train, &self.gbuffers, weights, size)
    }

    /// The labels that are skin, as far as the capture names them.
    pub fn skin(&self) -> Vec<u8> {
        let labelled = several_labels(&self.capture.train, &self.gbuffers);
        if !labelled || !self.config.initialisation.semantic {
            return vec![];
        }
        self.capture.labels_named(&self.config.initialisation.skin_labels)
    }

    /// The regions that are skin: labels, or the largest region by colour; none if labels have no names.
    pub fn skin_regions(&self) -> Vec<u8> {
        self.found_regions().skin.clone()
    }

    /// The regions that are hair which labels, or colours, call skin.
    pub fn hair_in_skin(&self) -> &[u8] {
        &self.found_regions().hair_in_skin
    }

    /// Gives back the memory of [`SolveContext::coarse`].
    pub fn drop_coarse(&mut self) {
        self.coarse.take();
    }

    /// From a light at infinity, and what changes as it comes nearer, if that is asked.
    pub fn far_transport(&self) -> &Transport {
        let t = &self.config.transport;
        let far = TransportSetup { nearness: 0.0, bounce_albedo: t.bounce_albedo };
        let beside = if t.nearness_rate > 0.0 { Beside::Nearness } else { Beside::Open };
        self.far_transport.get_or_init(|| self.cast(far, beside))
    }

    /// From a light that stands so; the same at every call.
    pub fn transport(&self, setup: TransportSetup) -> &Transport {
        self.transport.get_or_init(|| self.cast(setup, Beside::Open))
    }

    fn cast(&self, setup: TransportSetup, beside: Beside) -> Transport {
        let TransportSetup { nearness, bounce_albedo } = setup;
        let t = TransportConfig { bounce_albedo, ..self.config.transport.clone() };
        let sky = Sky::even(t.rows).at(nearness);
        Transport::new(&self.capture.mesh, &sky, &t, self.config.seed, beside)
    }

    /// Gives back the memory of [`SolveContext::far_transport`].
    pub fn drop_far(&mut self) {
        self.far_transport.take();
    }

    /// Gives back the memory of [`SolveContext::pictures`] and [`SolveContext::transport`].
    pub fn drop_pictures(&mut self) {
        self.pictures.take();
        self.transport.take();
    }

    /// What the pictures show of regions, if the configuration asks for it.
    fn found_regions(&self) -> &FoundRegions {
        self.found_regions.get_or_init(|| {
            let views = &self.capture.train;
            let projections = Projection::of_views(views, &self.gbuffers);
            let labelled = several_labels(views, &self.gbuffers);
            FoundRegions::new(self.capture, &projections, self.config, labelled, self.skin())
        })
    }

    /// The region of every texel, by labels or else by colour; `None` if the face is one region.
    pub fn regions(&self, atlas: &Atlas, projections: &[Projection]) -> Option<Vec<u8>> {
        self.found_regions().map(atlas, projections)
    }

    /// [`Self::regions`] of a texture of side `size`.
    pub fn regions_on(&self, size: usize) -> Option<Vec<u8>> {
        let projections = Projection::of_views(&self.capture.train, &self.gbuffers);
        self.regions(&Atlas::new(&self.capture.mesh, size), &projections)
    }

    /// The initial textures.
    pub fn initial_state(&self) -> State {
        let config = self.config;
        let size = config.warm_up.texture_size;
        let unlabelled: Vec<View>;
        let views = if config.initialisation.semantic {
            &self.capture.train
        } else {
            let strip = |view: &View| View { labels: None, ..view.clone() };
            unlabelled = self.capture.train.iter().map(strip).collect();
            &unlabelled
        };
        let mesh = &self.capture.mesh;
        let found = config.initialisation.semantic.then(|| self.found_regions());
        let diffuse = match found.and_then(|found| found.albedo(size)) {
            Some(albedo) => albedo,
            None => semantic::initial_diffuse_albedo(
                mesh,
                views,
                &self.gbuffers,
                &config.view_weights,
                size,
                &self.skin(),
            ),
        };
        let mut diffuse = diffuse.data;
        if let Some((found, regions)) = found.zip(self.regions_on(size)) {
            found.paint_parts(&regions, &mut diffuse);
        }
        diffuse.iter_mut().for_each(|value| *value *= self.gain);
        let grey: Vec<f32> =
            diffuse.chunks_exact(3).map(|rgb| rgb.iter().sum::<f32>() / 3.0).collect();
        let brightest = grey.iter().fold(f32::MIN_POSITIVE, |m, g| m.max(*g));
        let scale = config.initialisation.specular_maximum / brightest;
        State {
            networks: Networks::new(&config.networks, config.seed),
            size,
            specular: grey.iter().map(|grey| grey * scale).collect(),
            deviation: vec![0.0; diffuse.len()],
            diffuse,
        }
    }
}

/// Whether labels part the face, where pictures show it: one label for everything says no more than none.
fn several_labels(views: &[View], gbuffers: &[GBuffer]) -> bool {
    let of_view = |(view, gbuffer): (&View, &GBuffer)| -> Vec<u8> {
        gbuffer.pixels.iter().map(|pixel| view.label(*pixel as usize)).collect()
    };
    let labels = views.iter().zip(gbuffers).flat_map(of_view);
    let mut seen = labels.filter(|label| *label != 0);
    let first = seen.next();
    seen.any(|label| Some(label) != first)
}

/// Factor that brings the mean luminance of the training pictures, where they show the mesh, to `wanted`; 1 if
/// that is 0, or if they are black.
fn gain(capture: &Capture, gbuffers: &[GBuffer], wanted: f32) -> f32 {
    let luminance = |view: &View, pixel: usize| -> f64 {
        let colour = &view.image.data[CHANNELS * pixel..][..CHANNELS];
        colour.iter().zip(LUMINANCE).map(|(value, weight)| f64::from(value * weight)).sum()
    };
    let views = capture.train.iter().zip(gbuffers);
    let of_view = |(view, gbuffer): (&View, &GBuffer)| -> f64 {
        gbuffer.pixels.iter().map(|pixel| luminance(view, *pixel as usize)).sum()
    };
    let count: usize = gbuffers.iter().map(GBuffer::len).sum();
    let mean = (views.map(of_view).sum::<f64>() / count.max(1) as f64) as f32;
    if wanted > 0.0 && mean > 0.0 { wanted / mean } else { 1.0 }
}

/// The training pictures as the warm-up takes them.
pub(super) struct WarmUpPictures {
    views: Vec<View>,
    gbuffers: Vec<GBuffer>,
    weights: ViewWeightConfig,
}

impl WarmUpPictures {
    fn new(capture: &Capture, gbuffers: &[GBuffer], config: &Config) -> Self {
        let mut weights = config.view_weights.clone();
        if !config.warm_up.half_resolution {
            return Self { views: capture.train.clone(), gbuffers: gbuffers.to_vec(), weights };
        }
        weights.depth_blur *= 0.5;
        let views: Vec<View> = capture.train.par_iter().map(View::half).collect();
        let gbuffers = GBuffer::of_views(&capture.mesh, &views);
        Self { views, gbuffers, weights }
    }

    /// The usable pixels, for textures of side `size`.
    pub fn samples(&self, space: &SampleSpace, size: usize) -> Samples {
        space.training(&self.views, &self.gbuffers, &self.weights, size)
    }
}
