//! Regions of a face without labels: texels of similar reflectance.
//!
//! The colours of the pictures are divided by the shading of a light that is fitted with one reflectance for each
//! region; regions and light are fitted alternately. Two regions must have an edge between them: where colours change
//! slowly, the light changes, and the two are one region.

use capture::Mesh;
use formats::picture::Picture;
use glam::Vec3;

use super::cell_light::CellLight;
use super::chart::{Chart, dark, largest, log, luminance, means};
use super::clusters::{clusters, lloyd};
use super::explanation::{Explanation, residuals};
use super::lamps::Lamps;
use super::merging::merged;
use super::settings::ColourSettings;
use super::settings::Settings;

/// The regions of a chart and their colours.
#[derive(Clone, Debug)]
pub struct ColourRegions {
    /// Side of the chart, texels.
    side: usize,
    /// The region of every texel.
    regions: Vec<u8>,
    /// Linear RGB of every region, in the unit of the pictures.
    colours: Vec<Vec3>,
}

impl ColourRegions {
    /// Under a light of cells, or of one lamp where that leaves less. `None` if the pictures are mostly black.
    ///
    /// The cells' light and regions are found in turn, from two starts: the pictures' colours, and these divided by the
    /// shading of all cells on one reflectance, since between lamps of two colours skin in the pictures has two as
    /// well.
    pub(super) fn new(mesh: &Mesh, chart: &Chart, config: &Settings) -> Option<Self> {
        let whole = vec![1; chart.side * chart.side];
        let one = Explanation::new(mesh, chart, config, &whole, &[1])?;
        let under = match one.lamps() {
            Some((lamps, lit)) => Under::lamp(mesh, chart, config, lamps, lit)?,
            None => Under::cells(chart, &config.colour_regions, &one.before.albedo)?,
        };
        Some(Self {
            side: chart.side,
            regions: chart.filled(&under.regions, &under.known),
            colours: under.means,
        })
    }

    /// Every texel in the colour of its region, on a square map of `size` texels.
    pub fn albedo(&self, size: usize) -> Picture {
        let colour = |region: u8| self.colours[region as usize].to_array();
        let data = self.map(size).into_iter().flat_map(colour).collect();
        Picture { width: size, height: size, channels: 3, data }
    }

    /// The region with most texels.
    pub fn largest(&self) -> u8 {
        largest(&self.regions)
    }

    /// The region of every texel of a chart of side `size`.
    pub fn map(&self, size: usize) -> Vec<u8> {
        let at = |i: usize| (2 * i + 1) * self.side / (2 * size);
        (0..size * size).map(|i| self.regions[at(i / size) * self.side + at(i % size)]).collect()
    }
}

/// The regions of the visible texels under a light of cells, and the colours divided by its shading. The first regions
/// are clusters of `start`, linear RGB in any unit.
pub(super) fn by_cells(
    chart: &Chart,
    config: &ColourSettings,
    start: &[Vec3],
) -> Option<(Vec<u8>, Vec<Vec3>)> {
    let ColourSettings { count, luminance_weights, .. } = *config;
    let mut light = CellLight::new(chart, config);
    let mut albedo = start.to_vec();
    let mut regions = clusters(&features(start, luminance_weights[0], config.dark)?, count);
    for _ in 0..config.rounds {
        albedo = light.albedo(&regions);
        regions = lloyd(&features(&albedo, luminance_weights[1], config.dark)?, regions, count);
    }
    let relit = |parts: &[u8]| Some(light.albedo(parts));
    let regions = merged(config, &chart.seen, &albedo, &regions, relit);
    Some((regions, light.divided))
}

/// The regions of the visible texels under one light.
struct Under {
    regions: Vec<u8>,
    means: Vec<Vec3>,
    /// Whether a texel is lit.
    known: Vec<bool>,
}

impl Under {
    /// Fits from two starts, the pictures' colours and these under one reflectance; returns the fit with the smaller sum of
    /// [`residuals`].
    fn cells(chart: &Chart, config: &ColourSettings, under_one: &[Vec3]) -> Option<Self> {
        let from = |start: &[Vec3]| {
            let (regions, albedo) = by_cells(chart, config, start)?;
            let means = means(&albedo, &regions, config.dark);
            let left: f32 = residuals(&albedo, &means, &regions).iter().sum();
            Some((left, Self { known: vec![true; regions.len()], regions, means }))
        };
        let found = [from(&chart.colours), from(under_one)].into_iter().flatten();
        Some(found.min_by(|a, b| a.0.total_cmp(&b.0))?.1)
    }

    /// Fits the lamp to all lit texels first, then to their largest region alone. Texels that it does not light have no
    /// influence.
    fn lamp(
        mesh: &Mesh,
        chart: &Chart,
        all_config: &Settings,
        first: &Lamps,
        known: &[bool],
    ) -> Option<Self> {
        let Settings { colour_regions: config, hair_in_skin, .. } = all_config;
        let ColourSettings { count, luminance_weights, .. } = *config;
        let lit: Vec<usize> = (0..known.len()).filter(|at| known[*at]).collect();
        let seen: Vec<usize> = lit.iter().map(|at| chart.seen[*at]).collect();
        let mut counted = known.to_vec();
        let mut found = (vec![], vec![]);
        for round in 0..2 {
            let of_largest = match round {
                0 => None,
                _ => Lamps::new(mesh, chart, hair_in_skin, &counted),
            };
            let lamps = of_largest.as_ref().unwrap_or(first);
            let all = lamps.albedo(chart, &counted, &vec![false; known.len()]);
            let albedo: Vec<Vec3> = lit.iter().map(|at| all[*at]).collect();
            let start = clusters(&features(&albedo, luminance_weights[1], config.dark)?, count);
            let regions = merged(config, &seen, &albedo, &start, |_| None);
            let largest = largest(&regions);
            counted.fill(false);
            lit.iter().zip(&regions).for_each(|(at, region)| counted[*at] = *region == largest);
            found = (albedo, regions);
        }
        let (albedo, of_lit) = found;
        let mut regions = vec![0; known.len()];
        lit.iter().zip(&of_lit).for_each(|(at, region)| regions[*at] = *region);
        // In the unit of the pictures, for a shading of mean 1, as under the cells.
        // Texels without light in a channel carry no information on that channel.
        let finite = |shading: f32| if shading.is_finite() { shading } else { 0.0 };
        let shading = |(at, albedo): (&usize, &Vec3)| (chart.colours[*at] / *albedo).map(finite);
        let shading = lit.iter().zip(&albedo).map(shading);
        let unit = shading.sum::<Vec3>() / lit.len() as f32;
        let means = means(&albedo, &of_lit, config.dark).into_iter().map(|mean| mean * unit);
        Some(Self { regions, means: means.collect(), known: known.to_vec() })
    }
}

/// Points whose distances measure the differences of colours.
fn features(colours: &[Vec3], weight: f32, relative: f32) -> Option<Vec<Vec3>> {
    let dark = dark(colours, relative)?;
    let feature = |colour: &Vec3| {
        let log = log(*colour, dark);
        Vec3::new(log.x - log.y, log.z - log.y, weight * (luminance(colour) + dark).ln())
    };
    Some(colours.iter().map(feature).collect())
}

#[cfg(test)]
mod tests {
    use capture::View;
    use capture::gbuffer::GBuffer;
    use capture::projection::Projection;

    use super::super::lamps::testing::lamp;
    use super::*;
    use crate::testing;

    const SKIN: Vec3 = Vec3::new(0.5, 0.3, 0.2);
    const HAIR: Vec3 = Vec3::new(0.08, 0.06, 0.05);

    /// A dome in light from one side, four times as bright there as on the other.
    fn found(albedo: impl Fn(Vec3) -> Vec3) -> Option<ColourRegions> {
        found_in(albedo, |p| Vec3::splat(0.625 + 0.375 * p.y))
    }

    fn found_in(
        albedo: impl Fn(Vec3) -> Vec3,
        shading: impl Fn(Vec3) -> Vec3,
    ) -> Option<ColourRegions> {
        let mesh = testing::dome(24);
        let colour = |p: Vec3| (albedo(p) * shading(p), 0);
        let views: Vec<View> =
            testing::rig(3, 96).iter().map(|c| testing::view(&mesh, c, colour)).collect();
        let gbuffers = GBuffer::of_views(&mesh, &views);
        let projections = Projection::of_views(&views, &gbuffers);
        let config = Settings::default();
        let chart = Chart::new(&mesh, &projections, &config.transport, &config.colour_regions);
        ColourRegions::new(&mesh, &chart, &config)
    }

    /// The texels of the chart's disc, with where they lie from its centre.
    fn inside() -> impl Iterator<Item = (usize, f32, f32)> {
        let from_centre = |at: usize| (at as f32 + 0.5) / 64.0 - 0.5;
        (0..64 * 64)
            .map(move |at| (at, from_centre(at % 64), from_centre(at / 64)))
            .filter(|(_, x, y)| x.hypot(*y) < 0.3)
    }

    #[test]
    fn shading_does_not_split_regions() {
        let regions = found(|_| SKIN).unwrap().map(64);
        let first = regions[64 * 32 + 32];
        assert!(inside().all(|(at, ..)| regions[at] == first));
    }

    #[test]
    fn hair_and_skin_are_two_regions_in_shade_and_in_light() {
        let found = found(|p| if p.x > 0.3 { HAIR } else { SKIN }).unwrap();
        let (regions, albedo) = (found.map(64), found.albedo(64));
        let edge = 0.4 * 0.3_f32.asin() / 0.2_f32.acos();
        let clear: Vec<_> = inside().filter(|(_, x, _)| (x - edge).abs() > 0.06).collect();
        let of = |hair: bool| clear.iter().filter(move |(_, x, _)| (*x > edge) == hair);
        let region = |hair: bool| regions[of(hair).next().unwrap().0];
        assert_ne!(region(true), region(false));
        assert_eq!(found.largest(), region(false));
        for hair in [true, false] {
            let wrong = of(hair).filter(|(at, ..)| regions[*at] != region(hair)).count();
            assert!(50 * wrong < of(hair).count(), "{wrong} of {}", of(hair).count());
        }
        let colour = |hair: bool| Vec3::from_slice(&albedo.data[3 * of(hair).next().unwrap().0..]);
        let ratio = colour(true) / colour(false) / (HAIR / SKIN);
        assert!((ratio - 1.0).abs().max_element() < 0.3, "{ratio}");
    }

    #[test]
    fn the_dark_side_under_a_lamp_is_not_a_region() {
        let lit = |p: Vec3| Vec3::splat(lamp(p));
        let found = found_in(|p| if p.y > 0.4 { HAIR } else { SKIN }, lit).unwrap();
        let regions = found.map(64);
        let at = |x: usize, y: usize| regions[64 * y + x];
        // The chart's rows go down; its centre is the dome's top.
        let (lit, dark) = (at(40, 32), at(17, 34));
        assert_eq!(lit, dark);
        assert_eq!(found.largest(), lit);
        assert!(at(38, 18) != lit || at(38, 46) != lit);
        let colour = |region: u8| found.colours[usize::from(region)];
        let hair = if at(38, 18) == lit { at(38, 46) } else { at(38, 18) };
        let ratio = colour(hair) / colour(lit) / (HAIR / SKIN);
        assert!((ratio - 1.0).abs().max_element() < 0.3, "{ratio}");
    }

    #[test]
    fn lamps_of_two_colours_split_no_region_and_hide_no_hair() {
        let [warm, cool] = [Vec3::new(1.0, 0.42, 0.16), Vec3::new(0.22, 0.48, 1.0)];
        let lit = |p: Vec3| warm * p.x.max(0.0) + cool * (-p.x).max(0.0) + 0.02;
        let regions = found_in(|p| if p.y > 0.4 { HAIR } else { SKIN }, lit).unwrap().map(64);
        let at = |x: usize, y: usize| regions[64 * y + x];
        // The chart's rows go down; its centre is the dome's top. Warm at the right, cool at the left.
        let skin = at(42, 32);
        assert_eq!(at(22, 32), skin);
        let row_of_hair = if at(38, 14) == skin { 50 } else { 14 };
        let parted = |x: &usize| at(*x, row_of_hair) != skin && at(*x, 64 - row_of_hair) == skin;
        assert!([26, 38].iter().all(parted));
    }

    #[test]
    fn black_pictures_have_no_regions() {
        assert!(found(|_| Vec3::ZERO).is_none());
    }
}
