//! Parts of what labels call skin.

use glam::Vec3;

use super::chart::{Chart, largest, means};
use super::colours::by_cells;
use super::parts::parts;
use crate::Config;

/// A part of the skin of a chart that is none.
#[derive(Clone, Debug)]
pub struct PartOfSkin {
    /// Side of the chart, texels.
    pub(super) side: usize,
    /// Whether a texel is in it, if it is skin by its label.
    pub(super) inside: Vec<bool>,
    /// Its reflectance over that of skin: linear R, G, B.
    pub ratio: Vec3,
}

impl PartOfSkin {
    /// Of the `regions` of a chart of side `size`, those that are `skin` in this part become `label`.
    pub(super) fn name(&self, regions: &mut [u8], size: usize, skin: &[u8], label: u8) {
        let inside = regions.iter_mut().zip(self.map(size)).filter(|(_, inside)| *inside);
        inside.filter(|(region, _)| skin.contains(region)).for_each(|(region, _)| *region = label);
    }

    /// Whether every texel of a chart of side `size` is in it, if it is skin by its label.
    pub(super) fn map(&self, size: usize) -> Vec<bool> {
        let at = |i: usize| (2 * i + 1) * self.side / (2 * size);
        (0..size * size).map(|i| self.inside[at(i / size) * self.side + at(i % size)]).collect()
    }
}

/// The parts of the `skin` of the chart's `labels` that are of another colour than most of it, one for each colour.
pub(super) fn other_colours(
    chart: &Chart,
    config: &Config,
    labels: &[u8],
    skin: &[u8],
) -> Vec<PartOfSkin> {
    let Some((regions, albedo)) = by_cells(chart, &config.colour_regions) else { return vec![] };
    let is_skin: Vec<bool> = chart.seen.iter().map(|at| skin.contains(&labels[*at])).collect();
    let in_skin = regions.iter().zip(&is_skin).filter(|(_, skin)| **skin);
    let of_skin: Vec<u8> = in_skin.map(|(region, _)| *region).collect();
    let (most, least) = (largest(&of_skin), config.hair_in_skin.least_share * of_skin.len() as f32);
    let part = |region: u8| {
        let of: Vec<bool> = regions.iter().map(|other| *other == region).collect();
        let large = large_parts(chart, &is_skin, &of, least);
        if large.is_empty() {
            return None;
        }
        let inside: Vec<bool> = (0..of.len()).map(|at| large.iter().any(|part| part[at])).collect();
        // By what is called skin alone: what has a label of its own may be of another colour still.
        let kind = |at: usize| match (inside[at], is_skin[at] && regions[at] == most) {
            (true, _) => 2,
            (_, true) => 1,
            _ => 0,
        };
        let kinds: Vec<u8> = (0..inside.len()).map(kind).collect();
        let means = means(&albedo, &kinds, config.colour_regions.dark);
        let inside = chart.filled(&inside, &vec![true; inside.len()]);
        Some(PartOfSkin { side: chart.side, inside, ratio: means[2] / means[1] })
    };
    let others = (0..config.colour_regions.count as u8).filter(|region| *region != most);
    others.filter_map(part).collect()
}

/// The connected parts of what is skin and `of` something, of at least `least` texels: which of the texels seen
/// are in each.
pub(super) fn large_parts(
    chart: &Chart,
    is_skin: &[bool],
    of: &[bool],
    least: f32,
) -> Vec<Vec<bool>> {
    let mut map = vec![None; chart.side * chart.side];
    for ((at, skin), of) in chart.seen.iter().zip(is_skin).zip(of) {
        map[*at] = skin.then_some(u8::from(*of));
    }
    let part = parts(&map, chart.side);
    let mut sizes = vec![0_usize; part.len()];
    part.iter().zip(&map).filter(|(_, of)| **of == Some(1)).for_each(|(part, _)| sizes[*part] += 1);
    let large = (0..sizes.len()).filter(|part| sizes[*part] > 0 && sizes[*part] as f32 >= least);
    large.map(|large| chart.seen.iter().map(|at| part[*at] == large).collect()).collect()
}
