//! Parts of what labels call skin.

use glam::Vec3;

use super::chart::Chart;
use super::parts::parts;

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
    /// Whether every texel of a chart of side `size` is in it, if it is skin by its label.
    pub fn map(&self, size: usize) -> Vec<bool> {
        let at = |i: usize| (2 * i + 1) * self.side / (2 * size);
        (0..size * size).map(|i| self.inside[at(i / size) * self.side + at(i % size)]).collect()
    }
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
