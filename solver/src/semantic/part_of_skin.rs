//! Parts of labelled skin that are not skin.

use glam::Vec3;

use super::chart::{Chart, largest, means};
use super::colours::by_cells;
use super::explanation::Explanation;
use super::parts::parts;
use super::settings::Settings;

/// A part of labelled skin that is not skin, on a chart.
#[derive(Clone, Debug)]
pub struct PartOfSkin {
    /// Side of the chart, texels.
    pub(super) side: usize,
    /// Whether a texel is in the part, if its label is skin.
    pub(super) inside: Vec<bool>,
    /// The reflectance over that of skin, linear R, G, B.
    pub ratio: Vec3,
}

impl PartOfSkin {
    /// Sets `label` in the `regions` of a chart of side `size` wherever this part has a label of `skin`.
    pub(super) fn name(&self, regions: &mut [u8], size: usize, skin: &[u8], label: u8) {
        let inside = regions.iter_mut().zip(self.map(size)).filter(|(_, inside)| *inside);
        inside.filter(|(region, _)| skin.contains(region)).for_each(|(region, _)| *region = label);
    }

    /// Whether each texel of a chart of side `size` is in the part, if its label is skin.
    pub(super) fn map(&self, size: usize) -> Vec<bool> {
        let at = |i: usize| (2 * i + 1) * self.side / (2 * size);
        (0..size * size).map(|i| self.inside[at(i / size) * self.side + at(i % size)]).collect()
    }
}

/// The parts of `skin` in `labels` with another colour than most of the skin, one for each colour. Lights of several
/// colours cause several colours of skin as well, so a part must have a large residual under the fitted light.
pub(super) fn other_colours(
    explanation: &Explanation,
    chart: &Chart,
    config: &Settings,
    labels: &[u8],
    skin: &[u8],
) -> Vec<PartOfSkin> {
    // Candidates are from the pictures' colours; each is tested against a coloured light below.
    let Some((regions, albedo)) = by_cells(chart, &config.colour_regions, &chart.colours) else {
        return vec![];
    };
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
        explanation.with_plausible_part(&inside, config.hair_in_skin.most_left)?;
        // Only labelled skin is compared: other labels may have any colour.
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

/// The connected parts of skin within a set `of` texels, of at least `least` texels; each says which visible texels are
/// in it.
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

#[cfg(test)]
mod tests {
    use capture::View;
    use capture::gbuffer::GBuffer;
    use capture::projection::Projection;

    use super::*;
    use crate::testing;

    const SKIN: Vec3 = Vec3::new(0.5, 0.3, 0.2);

    /// The parts of a dome with the label of skin and this `colour`; `asked`: tested against the light.
    fn found(colour: impl Fn(Vec3) -> Vec3, asked: bool) -> Vec<PartOfSkin> {
        let mesh = testing::dome(24);
        let pictured = |p: Vec3| (colour(p), 1);
        let views: Vec<View> =
            testing::rig(3, 96).iter().map(|c| testing::view(&mesh, c, pictured)).collect();
        let projections = Projection::of_views(&views, &GBuffer::of_views(&mesh, &views));
        let mut config = Settings::default();
        if !asked {
            config.hair_in_skin.most_left = [f32::INFINITY; 2];
        }
        let chart = Chart::new(&mesh, &projections, &config.transport, &config.colour_regions);
        let labels = vec![1; chart.side * chart.side];
        let explanation = Explanation::new(&mesh, &chart, &config, &labels, &[1]).unwrap();
        other_colours(&explanation, &chart, &config, &labels, &[1])
    }

    #[test]
    fn a_patch_of_another_colour_is_a_part() {
        let hair = |p: Vec3| (p.x - 0.3).hypot(p.y) < 0.25;
        let share = |p: Vec3| if hair(p) { Vec3::new(0.3, 0.35, 0.45) } else { Vec3::ONE };
        let parts = found(|p| share(p) * SKIN * (0.625 + 0.375 * p.y), true);
        assert_eq!(parts.len(), 1);
        assert!((parts[0].ratio - share(Vec3::X * 0.3)).abs().max_element() < 0.08);
    }

    #[test]
    fn lights_of_two_colours_make_no_part() {
        let [warm, cool] = [Vec3::new(1.0, 0.42, 0.16), Vec3::new(0.22, 0.48, 1.0)];
        let lit = |p: Vec3| SKIN * (warm * p.x.max(0.0) + cool * (-p.x).max(0.0) + 0.02);
        assert!(!found(lit, false).is_empty(), "their edge would be one of colours");
        assert!(found(lit, true).is_empty());
    }
}
