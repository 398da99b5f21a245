//! Regions that the pictures show, beside what labels say.

use capture::Capture;
use capture::gbuffer::Atlas;
use capture::projection::Projection;
use formats::picture::Picture;

use super::chart::Chart;
use super::colours::ColourRegions;
use super::hair::HairInSkin;
use super::region_map;
use crate::Config;

/// Regions by colour in place of labels, and hair inside of what is called skin.
#[derive(Clone, Debug, Default)]
pub struct FoundRegions {
    colours: Option<ColourRegions>,
    /// With the labels that are skin, and one that nothing else has.
    hair: Option<(HairInSkin, Vec<u8>, u8)>,
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
        let hair = split.then(|| HairInSkin::new(&capture.mesh, &chart, config, &labels, &skin));
        let free = (1..=u8::MAX).rev().find(|label| {
            let views = capture.train.iter().filter_map(|view| view.labels.as_ref());
            !labels.contains(label) && !views.flat_map(|l| &l.data).any(|other| other == label)
        });
        Self { colours, hair: hair.flatten().zip(free).map(|(hair, free)| (hair, skin, free)) }
    }

    /// The region of every texel: by these, by labels otherwise; `None` if the face is one region.
    pub fn map(&self, atlas: &Atlas, projections: &[Projection]) -> Option<Vec<u8>> {
        let mut regions = match &self.colours {
            Some(colours) => colours.map(atlas.size),
            None => region_map(atlas, projections),
        };
        if let Some((hair, skin, label)) = &self.hair {
            let hair = regions.iter_mut().zip(hair.map(atlas.size)).filter(|(_, hair)| *hair);
            hair.filter(|(region, _)| skin.contains(region))
                .for_each(|(region, _)| *region = *label);
        }
        let one = self.colours.is_none() && regions.iter().all(|region| *region == 0);
        (!one).then_some(regions)
    }

    /// First colours without labels, on a map of side `size`.
    pub fn albedo(&self, size: usize) -> Option<Picture> {
        self.colours.as_ref().map(|colours| colours.albedo(size))
    }

    /// Gives hair inside of skin its colour, in an `albedo` of these `regions` where it still has skin's.
    pub fn paint_hair(&self, regions: &[u8], albedo: &mut [f32]) {
        let Some((hair, _, label)) = &self.hair else { return };
        let texels =
            albedo.chunks_exact_mut(3).zip(regions).filter(|(_, region)| **region == *label);
        texels.for_each(|(texel, _)| {
            texel.iter_mut().zip(hair.ratio.to_array()).for_each(|(value, ratio)| *value *= ratio);
        });
    }
}
