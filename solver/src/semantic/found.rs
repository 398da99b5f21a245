//! Regions that the pictures show, beside what labels say.

use std::collections::HashSet;

use capture::Capture;
use capture::gbuffer::Atlas;
use capture::projection::Projection;
use formats::picture::Picture;

use super::chart::Chart;
use super::colours::{ColourRegions, other_colours_in_skin};
use super::explanation::Explanation;
use super::hair::hair_in_skin;
use super::part_of_skin::PartOfSkin;
use super::region_map;
use crate::Config;

/// Regions by colour in place of labels, and parts of what is called skin that are none.
#[derive(Clone, Debug, Default)]
pub struct FoundRegions {
    colours: Option<ColourRegions>,
    /// The labels that are skin.
    skin: Vec<u8>,
    /// Each with a label that nothing else has.
    parts: Vec<(PartOfSkin, u8)>,
}

impl FoundRegions {
    /// What the configuration asks for. `projections` are of the training views, the labels `skin` are skin;
    /// regions take the place of labels unless there are several (`labelled`).
    pub fn new(
        capture: &Capture,
        projections: &[Projection],
        config: &Config,
        labelled: bool,
        skin: Vec<u8>,
    ) -> Self {
        let regions = &config.colour_regions;
        let by_colour = regions.count > 0 && !labelled;
        let split = config.hair_in_skin.enabled && (by_colour || !skin.is_empty());
        if !by_colour && !split {
            return Self::default();
        }
        let chart = Chart::new(&capture.mesh, projections, &config.transport, regions);
        let colours =
            by_colour.then(|| ColourRegions::new(&capture.mesh, &chart, config)).flatten();
        let side = regions.texture_size;
        let (labels, skin) = match &colours {
            Some(colours) => (colours.map(side), vec![colours.largest()]),
            None => (region_map(&Atlas::new(&capture.mesh, side), projections), skin),
        };
        let mut it = Self { colours, skin, parts: vec![] };
        if split {
            it.split(capture, &chart, config, labels);
        }
        it
    }

    /// Finds the parts of the skin of `labels`.
    fn split(&mut self, capture: &Capture, chart: &Chart, config: &Config, mut labels: Vec<u8>) {
        let views = capture.train.iter().filter_map(|view| view.labels.as_ref());
        let mut used: HashSet<u8> = views.flat_map(|labels| labels.data.iter().copied()).collect();
        used.extend(&labels);
        let free: Vec<u8> = (1..=u8::MAX).rev().filter(|label| !used.contains(label)).collect();
        let mut free = free.into_iter();
        let explain =
            |labels: &[u8]| Explanation::new(&capture.mesh, chart, config, labels, &self.skin);
        let Some(mut explanation) = explain(&labels) else { return };
        if self.colours.is_none()
            && config.colour_regions.count > 0
            && explanation.lamps().is_none()
        {
            let other = other_colours_in_skin(chart, config, &labels, &self.skin);
            for (part, label) in other.into_iter().zip(&mut free) {
                let inside = labels.iter_mut().zip(&part.inside).filter(|(_, inside)| **inside);
                inside.filter(|(l, _)| self.skin.contains(l)).for_each(|(l, _)| *l = label);
                self.parts.push((part, label));
            }
            if !self.parts.is_empty() {
                let Some(without) = explain(&labels) else { return };
                explanation = without;
            }
        }
        let hair = hair_in_skin(&explanation, chart, &config.hair_in_skin);
        self.parts.extend(hair.into_iter().zip(free));
    }

    /// The region of every texel: by these, by labels otherwise; `None` if the face is one region.
    pub fn map(&self, atlas: &Atlas, projections: &[Projection]) -> Option<Vec<u8>> {
        let mut regions = match &self.colours {
            Some(colours) => colours.map(atlas.size),
            None => region_map(atlas, projections),
        };
        for (part, label) in &self.parts {
            let inside = regions.iter_mut().zip(part.map(atlas.size)).filter(|(_, inside)| *inside);
            inside
                .filter(|(region, _)| self.skin.contains(region))
                .for_each(|(region, _)| *region = *label);
        }
        let one = self.colours.is_none() && regions.iter().all(|region| *region == 0);
        (!one).then_some(regions)
    }

    /// First colours without labels, on a map of side `size`.
    pub fn albedo(&self, size: usize) -> Option<Picture> {
        self.colours.as_ref().map(|colours| colours.albedo(size))
    }

    /// Gives parts of skin their colours, in an `albedo` of these `regions` where they still have skin's.
    pub fn paint_parts(&self, regions: &[u8], albedo: &mut [f32]) {
        for (texel, region) in albedo.chunks_exact_mut(3).zip(regions) {
            if let Some((part, _)) = self.parts.iter().find(|(_, label)| label == region) {
                let ratio = part.ratio.to_array();
                texel.iter_mut().zip(ratio).for_each(|(value, ratio)| *value *= ratio);
            }
        }
    }
}
