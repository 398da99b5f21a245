//! Regions that the pictures show, beside what labels say.

use std::collections::HashSet;

use capture::Capture;
use capture::gbuffer::Atlas;
use capture::projection::Projection;
use formats::picture::Picture;

use super::chart::Chart;
use super::colours::ColourRegions;
use super::explanation::Explanation;
use super::hair::hair_in_skin;
use super::part_of_skin::{PartOfSkin, other_colours};
use super::region_map;
use crate::Config;

/// Regions by colour in place of labels, and parts of what is called skin that are none.
#[derive(Clone, Debug, Default)]
pub struct FoundRegions {
    colours: Option<ColourRegions>,
    /// The regions that are skin.
    pub skin: Vec<u8>,
    /// Those of hair that was called skin.
    pub hair_in_skin: Vec<u8>,
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
            return Self { skin, ..Self::default() };
        }
        let chart = Chart::new(&capture.mesh, projections, &config.transport, regions);
        let colours =
            by_colour.then(|| ColourRegions::new(&capture.mesh, &chart, config)).flatten();
        let side = regions.texture_size;
        let (labels, skin) = match &colours {
            Some(colours) => (colours.map(side), vec![colours.largest()]),
            None => (region_map(&Atlas::new(&capture.mesh, side), projections), skin),
        };
        let mut it = Self { colours, skin, ..Self::default() };
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
        let by_colour = self.colours.is_none() && config.colour_regions.count > 0;
        // Under a lamp, no sky of cells explains the face, and shadows would be colours.
        if by_colour && explanation.lamps().is_none() {
            let other = other_colours(&explanation, chart, config, &labels, &self.skin);
            for (part, label) in other.into_iter().zip(&mut free) {
                part.name(&mut labels, chart.side, &self.skin, label);
                self.parts.push((part, label));
            }
            if !self.parts.is_empty() {
                // The skin that is left is explained better.
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

    /// The region of every texel: by these, by labels otherwise; `None` if the face is one region.
    pub fn map(&self, atlas: &Atlas, projections: &[Projection]) -> Option<Vec<u8>> {
        let mut regions = match &self.colours {
            Some(colours) => colours.map(atlas.size),
            None => region_map(atlas, projections),
        };
        for (part, label) in &self.parts {
            part.name(&mut regions, atlas.size, &self.skin, *label);
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

#[cfg(test)]
mod tests {
    use capture::View;
    use capture::gbuffer::GBuffer;
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
        let found = FoundRegions::new(&capture, &projections, &Config::default(), true, vec![1]);
        let regions = found.map(&Atlas::new(&capture.mesh, 64), &projections).unwrap();
        let mut albedo = vec![1.0; 3 * regions.len()];
        found.paint_parts(&regions, &mut albedo);
        (regions, albedo)
    }

    #[test]
    fn hair_that_a_label_calls_skin_is_a_region_of_its_own_and_lips_stay() {
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
