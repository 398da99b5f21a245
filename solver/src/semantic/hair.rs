//! Hair in labelled skin: a beard.
//!
//! Skin that is dark under a light of few unknowns is in shadow or covered by hair. A light of free cells separates the
//! two: it fits shadows, but hair only where no bare skin has the same normal. Shadows are also redder, since their
//! light has been reflected by skin, while hair absorbs all colours. A flash cannot be fitted by a sky of cells; there
//! the light is one lamp.

use glam::Vec3;

use super::chart::{Chart, luminance};
use super::explanation::{Explanation, sum};
use super::part_of_skin::{PartOfSkin, large_parts};
use super::settings::HairSettings;
use crate::model::blur::Blur;

/// Largest number of growth steps; hair converges earlier.
const GROWTH: usize = 8;

/// The hair in the skin of a chart; `None` without hair.
pub(super) fn hair_in_skin(
    explanation: &Explanation,
    chart: &Chart,
    config: &HairSettings,
) -> Option<PartOfSkin> {
    let Explanation { is_skin, .. } = explanation;
    let count = is_skin.iter().filter(|skin| **skin).count();
    let albedo = explanation.smooth_albedo(config.lobe_width);
    let darkness = darkness(chart, config, &albedo, is_skin, is_skin)?;
    let mut best = (f32::INFINITY, None);
    for depth in config.depths {
        let dark: Vec<bool> = darkness.iter().map(|darkness| *darkness > depth).collect();
        for inside in large_parts(chart, is_skin, &dark, config.least_share * count as f32) {
            let Some((after, ratio)) = explanation.with_plausible_part(&inside, config.most_left)
            else {
                continue;
            };
            let left = sum(&after.residuals, is_skin);
            if ratio.z > config.least_blue * ratio.x && left < best.0 {
                best = (left, Some(inside));
            }
        }
    }
    let (inside, ratio) = grown(explanation, chart, config, best.1?)?;
    Some(PartOfSkin { side: chart.side, inside: explanation.filled(&inside), ratio })
}

/// Grows hair by the connected texels whose luminance is closer to hair than to bare skin, and returns its ratio to
/// skin. Before, the light was darkened to fit all of the hair that is not in the part.
fn grown(
    explanation: &Explanation,
    chart: &Chart,
    config: &HairSettings,
    mut inside: Vec<bool>,
) -> Option<(Vec<bool>, Vec3)> {
    let is_skin = &explanation.is_skin;
    let (mut after, mut ratio) = explanation.with_part(&inside);
    for _ in 0..GROWTH {
        let bare: Vec<bool> =
            is_skin.iter().zip(&inside).map(|(skin, hair)| *skin && !hair).collect();
        let darkness = darkness(chart, config, &after.albedo, is_skin, &bare)?;
        let half_way = -0.5 * luminance(&ratio).ln();
        let dark: Vec<bool> = darkness.iter().map(|darkness| *darkness > half_way).collect();
        let mut wider = vec![false; inside.len()];
        for part in large_parts(chart, is_skin, &dark, 1.0) {
            if part.iter().zip(&inside).any(|(part, hair)| *part && *hair) {
                wider.iter_mut().zip(part).for_each(|(wider, part)| *wider |= part);
            }
        }
        if wider == inside || !wider.contains(&true) {
            break;
        }
        (after, ratio) = explanation.with_part(&wider);
        inside = wider;
    }
    Some((inside, ratio))
}

/// The difference of the median log luminance of `bare` skin to that of every visible texel, blurred within the skin;
/// negative infinity outside of the skin.
fn darkness(
    chart: &Chart,
    config: &HairSettings,
    albedo: &[Vec3],
    is_skin: &[bool],
    bare: &[bool],
) -> Option<Vec<f32>> {
    let log = |albedo: &Vec3| luminance(albedo).max(f32::MIN_POSITIVE).ln();
    let mut sums = vec![0.0; 2 * chart.side * chart.side];
    let skin = chart.seen.iter().zip(albedo).zip(is_skin).filter(|(_, skin)| **skin);
    skin.for_each(|((at, albedo), _)| sums[2 * at..][..2].copy_from_slice(&[log(albedo), 1.0]));
    let bare = albedo.iter().zip(bare).filter(|(_, bare)| **bare);
    let mut logs: Vec<f32> = bare.map(|(albedo, _)| log(albedo)).collect();
    logs.sort_by(f32::total_cmp);
    let median = logs.get(logs.len() / 2)?;
    let smooth = Blur::new(chart.side, 2, config.blur).apply(&sums);
    let below = |(at, skin): (&usize, &bool)| match skin {
        true => median - smooth[2 * at] / smooth[2 * at + 1],
        false => f32::NEG_INFINITY,
    };
    Some(chart.seen.iter().zip(is_skin).map(below).collect())
}

#[cfg(test)]
mod tests {
    use capture::View;
    use capture::gbuffer::GBuffer;
    use capture::projection::Projection;

    use super::super::lamps::testing::lamp;
    use super::super::settings::Settings;
    use super::*;
    use crate::testing;

    const SKIN: Vec3 = Vec3::new(0.5, 0.3, 0.2);

    /// Hair in the skin of a dome in light from one side, with the albedo of skin times `share`.
    fn found(share: impl Fn(Vec3) -> Vec3) -> Option<PartOfSkin> {
        found_in(share, |p| 0.625 + 0.375 * p.y)
    }

    fn found_in(share: impl Fn(Vec3) -> Vec3, shading: impl Fn(Vec3) -> f32) -> Option<PartOfSkin> {
        explained(share, shading, |explanation, chart, config| {
            hair_in_skin(explanation, chart, &config.hair_in_skin)
        })
    }

    fn explained<T>(
        share: impl Fn(Vec3) -> Vec3,
        shading: impl Fn(Vec3) -> f32,
        of: impl Fn(&Explanation, &Chart, &Settings) -> Option<T>,
    ) -> Option<T> {
        let mesh = testing::dome(24);
        let colour = |p: Vec3| (share(p) * SKIN * shading(p), 1);
        let views: Vec<View> =
            testing::rig(3, 96).iter().map(|c| testing::view(&mesh, c, colour)).collect();
        let projections = Projection::of_views(&views, &GBuffer::of_views(&mesh, &views));
        let config = Settings::default();
        let regions = &config.colour_regions;
        let chart = Chart::new(&mesh, &projections, &config.transport, regions);
        let labels = vec![1; chart.side * chart.side];
        of(&Explanation::new(&mesh, &chart, &config, &labels, &[1])?, &chart, &config)
    }

    fn is_patch(p: Vec3) -> bool {
        (p.x - 0.3).hypot(p.y) < 0.25
    }

    #[test]
    fn a_patch_that_no_light_fits_is_hair_with_its_own_colour() {
        let hair = found(|p| Vec3::splat(if is_patch(p) { 0.4 } else { 1.0 })).unwrap();
        assert!((hair.ratio - 0.4).abs().max_element() < 0.08, "{}", hair.ratio);
        let inside = hair.map(64);
        let share = inside.iter().filter(|hair| **hair).count() as f32 / inside.len() as f32;
        // The patch covers 0.019 of the chart.
        assert!((0.013..0.025).contains(&share), "{share}");
    }

    #[test]
    fn a_part_of_a_patch_grows_to_all_of_it_and_no_further() {
        let share = |p: Vec3| Vec3::splat(if is_patch(p) { 0.4 } else { 1.0 });
        let [core, grown, ratio] = explained(
            share,
            |p| 0.625 + 0.375 * p.y,
            |explanation, chart, config| {
                let albedo = explanation.smooth_albedo(config.hair_in_skin.lobe_width);
                let skin = &explanation.is_skin;
                let darkness = darkness(chart, &config.hair_in_skin, &albedo, skin, skin)?;
                let core: Vec<bool> = darkness.iter().map(|darkness| *darkness > 0.85).collect();
                let count =
                    |inside: &[bool]| inside.iter().filter(|inside| **inside).count() as f32;
                let (inside, ratio) =
                    grown(explanation, chart, &config.hair_in_skin, core.clone())?;
                Some([count(&core), count(&inside), ratio.x])
            },
        )
        .unwrap();
        // Of 128² texels the patch covers .019.
        let patch = 0.019 * 128.0 * 128.0;
        assert!(core > 0.0 && core < 0.7 * patch, "{core}");
        assert!((0.8..1.25).contains(&(grown / patch)), "{grown}");
        assert!((ratio - 0.4).abs() < 0.08, "{ratio}");
    }

    #[test]
    fn neither_a_shadow_nor_a_red_shadow_is_hair() {
        assert!(found(|p| Vec3::splat(1.0 - 0.6 * (p.x + 0.2).clamp(0.0, 1.0))).is_none());
        let red = Vec3::new(0.5, 0.35, 0.25);
        assert!(found(|p| if is_patch(p) { red } else { Vec3::ONE }).is_none());
    }

    #[test]
    fn hair_is_found_in_the_light_of_a_lamp_and_not_where_it_does_not_shine() {
        let hair = found_in(|p| Vec3::splat(if is_patch(p) { 0.4 } else { 1.0 }), lamp).unwrap();
        assert!((hair.ratio - 0.4).abs().max_element() < 0.08, "{}", hair.ratio);
        assert!(found_in(|_| Vec3::ONE, lamp).is_none());
        let behind = |p: Vec3| (p.x + 0.7).hypot(p.y + 0.2) < 0.2;
        assert!(found_in(|p| Vec3::splat(if behind(p) { 0.4 } else { 1.0 }), lamp).is_none());
    }
}
