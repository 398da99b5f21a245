//! Regions of the face: by labels, or by colour without labels, and hair in labelled skin.

use std::collections::HashSet;

use capture::Capture;
use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::Projection;
use formats::picture::Picture;

use super::chart::Chart;
use super::colours::ColourRegions;
use super::explanation::Explanation;
use super::hair::hair_in_skin;
use super::part_of_skin::{PartOfSkin, other_colours};
use super::settings::Settings;
use super::{initial_diffuse_albedo, region_map};
use crate::config::{UnshadeConfig, ViewWeightConfig};
use crate::scene::Scene;

/// The regions of a face. `labelled_skin` restricts the light fits and shares one initial colour; `skin` shares one
/// specular term, keeps its albedo in the recolouring and the inpainting, and is split into `parts`; without named skin
/// the shared specular term is that of the largest region.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaceRegions {
    colours: Option<ColourRegions>,
    /// The labels with names of skin; empty without such names.
    pub labelled_skin: Vec<u8>,
    /// `labelled_skin`, or the largest region by colour without labels; empty if labels have no names of skin.
    pub skin: Vec<u8>,
    /// The regions of hair in labelled skin.
    pub hair_in_skin: Vec<u8>,
    /// Parts of labelled skin that are not skin, each with its own new label.
    parts: Vec<(PartOfSkin, u8)>,
}

impl FaceRegions {
    /// Regions by labels if there are several, else by colour.
    pub fn new(scene: &Scene, config: &UnshadeConfig) -> Self {
        let labelled = several_labels(scene);
        let skin = match labelled {
            true => scene.capture.labels_named(&config.regions.skin_labels),
            false => vec![],
        };
        Self::find(scene.capture, &scene.projections(), config, labelled, skin)
    }

    /// Finds the regions by labels if there are several (`labelled`), else by colour. `projections` are of the training
    /// views, `skin` the labels of skin.
    fn find(
        capture: &Capture,
        projections: &[Projection],
        config: &UnshadeConfig,
        labelled: bool,
        skin: Vec<u8>,
    ) -> Self {
        let settings = &Settings::new(config);
        let labelled_skin = skin.clone();
        let split = config.regions.hair_in_skin && (!labelled || !skin.is_empty());
        if labelled && !split {
            return Self { labelled_skin, skin, ..Self::default() };
        }
        let regions = &settings.colour_regions;
        let chart = Chart::new(&capture.mesh, projections, &settings.transport, regions);
        let colours =
            (!labelled).then(|| ColourRegions::new(&capture.mesh, &chart, settings)).flatten();
        let side = regions.texture_size;
        let (labels, skin) = match &colours {
            Some(colours) => (colours.map(side), vec![colours.largest()]),
            None => (region_map(&Atlas::new(&capture.mesh, side), projections), skin),
        };
        let mut found = Self { colours, labelled_skin, skin, ..Self::default() };
        if split {
            found.split(capture, &chart, settings, labels);
        }
        found
    }

    /// Finds the parts of skin that are not skin, with skin as in `labels`.
    fn split(&mut self, capture: &Capture, chart: &Chart, config: &Settings, mut labels: Vec<u8>) {
        let views = capture.train.iter().filter_map(|view| view.labels.as_ref());
        let mut used: HashSet<u8> = views.flat_map(|labels| labels.data.iter().copied()).collect();
        used.extend(&labels);
        let free: Vec<u8> = (1..=u8::MAX).rev().filter(|label| !used.contains(label)).collect();
        let mut free = free.into_iter();
        let explain =
            |labels: &[u8]| Explanation::new(&capture.mesh, chart, config, labels, &self.skin);
        let Some(mut explanation) = explain(&labels) else { return };
        // The sky of cells does not fit a face under a lamp: shadows would be segmented as colours.
        if self.colours.is_none() && explanation.lamps().is_none() {
            let other = other_colours(&explanation, chart, config, &labels, &self.skin);
            for (part, label) in other.into_iter().zip(&mut free) {
                part.name(&mut labels, chart.side, &self.skin, label);
                self.parts.push((part, label));
            }
            if !self.parts.is_empty() {
                // The remaining skin has a lower residual.
                let Some(without) = explain(&labels) else { return };
                explanation = without;
            }
        }
        let hair = hair_in_skin(&explanation, chart, &config.hair_in_skin);
        for (part, label) in hair.into_iter().zip(free) {
            self.hair_in_skin.push(label);
            self.parts.push((part, label));
        }
    }

    /// The region of every texel of a texture of side `size`; 0 everywhere if the face is one region.
    pub fn region_map(&self, scene: &Scene, size: usize) -> Vec<u8> {
        self.map(&Atlas::new(&scene.capture.mesh, size), &scene.projections())
    }

    fn map(&self, atlas: &Atlas, projections: &[Projection]) -> Vec<u8> {
        let mut regions = match &self.colours {
            Some(colours) => colours.map(atlas.size),
            None => region_map(atlas, projections),
        };
        for (part, label) in &self.parts {
            part.name(&mut regions, atlas.size, &self.skin, *label);
        }
        regions
    }

    /// The mean colour of the region of every texel, for the [`Self::region_map`] of a square texture: linear R, G, B
    /// in the unit of the scene's pictures, times [`Scene::picture_scale`]. All labelled skin has the colour of the
    /// largest of its regions.
    pub fn mean_colours(&self, scene: &Scene, regions: &[u8]) -> Vec<f32> {
        let size = regions.len().isqrt();
        let by_labels = || -> Picture {
            let (capture, weights) = (scene.capture, &ViewWeightConfig::default());
            let (views, skin) = (&capture.train, &self.labelled_skin);
            initial_diffuse_albedo(&capture.mesh, views, &scene.gbuffers, weights, size, skin)
        };
        let colours = self.colours.as_ref();
        let mut texels = colours.map_or_else(by_labels, |colours| colours.albedo(size)).data;
        self.paint_parts(regions, &mut texels);
        texels.iter_mut().for_each(|value| *value *= scene.picture_scale);
        texels
    }

    /// Multiplies the parts of skin, which still have the colour of skin, by their ratios to it.
    fn paint_parts(&self, regions: &[u8], colours: &mut [f32]) {
        for (texel, region) in colours.chunks_exact_mut(3).zip(regions) {
            if let Some((part, _)) = self.parts.iter().find(|(_, label)| label == region) {
                let ratio = part.ratio.to_array();
                texel.iter_mut().zip(ratio).for_each(|(value, ratio)| *value *= ratio);
            }
        }
    }
}

/// Whether the visible face has more than one label. A single label carries no information.
fn several_labels(scene: &Scene) -> bool {
    let of_view = |(view, gbuffer): (&capture::View, &GBuffer)| -> Vec<u8> {
        gbuffer.pixels.iter().map(|pixel| view.label(*pixel as usize)).collect()
    };
    let labels = scene.capture.train.iter().zip(&scene.gbuffers).flat_map(of_view);
    let mut seen = labels.filter(|label| *label != 0);
    let first = seen.next();
    seen.any(|label| Some(label) != first)
}

#[cfg(test)]
mod tests {
    use capture::View;
    use glam::Vec3;

    use super::*;
    use crate::testing;

    const SKIN: Vec3 = Vec3::new(0.5, 0.3, 0.2);
    const HAIR: Vec3 = Vec3::new(0.08, 0.06, 0.05);
    const LIPS: Vec3 = Vec3::new(0.4, 0.15, 0.12);

    /// A dome in light from one side, with hair from x = 0.3 on and lips below x = -0.5.
    fn colour(p: Vec3) -> Vec3 {
        match p.x {
            x if x > 0.3 => HAIR,
            x if x < -0.5 => LIPS,
            _ => SKIN,
        }
    }

    /// Regions of a chart of 64 texels a side and its albedo of 1 with parts painted, where labels say so.
    fn found(label: impl Fn(Vec3) -> u8) -> (Vec<u8>, Vec<f32>) {
        let folder = tempfile::tempdir().unwrap();
        let mesh = testing::dome(24);
        let shade = |p: Vec3| (colour(p) * (0.625 + 0.375 * p.y), label(p));
        let views: Vec<View> =
            testing::rig(4, 96).iter().map(|c| testing::view(&mesh, c, shade)).collect();
        testing::write_capture(folder.path(), &mesh, &views, 1);
        let capture = Capture::open(folder.path()).unwrap();
        let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
        let projections = Projection::of_views(&capture.train, &gbuffers);
        let config = UnshadeConfig::default();
        let found = FaceRegions::find(&capture, &projections, &config, true, vec![1]);
        let regions = found.map(&Atlas::new(&capture.mesh, 64), &projections);
        let mut albedo = vec![1.0; 3 * regions.len()];
        found.paint_parts(&regions, &mut albedo);
        (regions, albedo)
    }

    #[test]
    fn hair_that_a_label_calls_skin_becomes_a_region_and_lips_stay() {
        let (regions, albedo) = found(|p| if p.x < -0.5 { 2 } else { 1 });
        let at = |x: usize| 64 * 32 + x;
        // The chart's columns go along x.
        let (lips, skin, hair) = (at(18), at(32), at(47));
        assert_eq!([regions[lips], regions[skin]], [2, 1]);
        assert!(![1, 2].contains(&regions[hair]));
        assert_eq!(albedo[3 * skin..][..3], [1.0; 3]);
        let ratio = Vec3::from_slice(&albedo[3 * hair..]) / (HAIR / SKIN);
        assert!((ratio - 1.0).abs().max_element() < 0.4, "{ratio}");
    }

    #[test]
    fn labels_that_are_right_stay_as_they_are() {
        let (regions, albedo) = found(|p| match p.x {
            x if x > 0.3 => 3,
            x if x < -0.5 => 2,
            _ => 1,
        });
        assert!(regions.iter().all(|region| (1..=3).contains(region)));
        assert!(albedo.iter().all(|value| *value == 1.0));
    }
}
