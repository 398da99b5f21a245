//! The specular albedo of the maps. Within a region of the face pictures tell next to nothing of it,
//! so that it is pooled; and only up to a factor, so that the skin's comes from its index of refraction.

use capture::gbuffer::Atlas;

use crate::config::NormalisationConfig;
use crate::model::blur::Blur;

/// `specular` on the chart of `atlas`, pooled over the regions or, without any, over the configured
/// distance; texels that are not `seen` have no say.
pub(super) fn pooled(
    config: &NormalisationConfig,
    atlas: &Atlas,
    regions: Option<&[u8]>,
    seen: &[bool],
    specular: &[f32],
) -> Vec<f32> {
    if let Some(regions) = regions {
        let means = region_means(regions, seen, specular);
        return regions.iter().map(|region| means[*region as usize].0).collect();
    }
    let blur = Blur::new(atlas.size, 1, config.specular_pooling / texel_length(atlas));
    let part = |value: &dyn Fn(usize) -> f32| -> Vec<f32> {
        let values: Vec<f32> =
            (0..seen.len()).map(|at| if seen[at] { value(at) } else { 0.0 }).collect();
        blur.apply(&values)
    };
    let (sums, weights) = (part(&|at| specular[at]), part(&|_| 1.0));
    let near = |at: usize| if weights[at] > 0.0 { sums[at] / weights[at] } else { specular[at] };
    (0..seen.len()).map(near).collect()
}

/// The mean of the region that most seen texels belong to.
pub(super) fn of_largest_region(regions: Option<&[u8]>, seen: &[bool], specular: &[f32]) -> f32 {
    let one = vec![0; if regions.is_none() { seen.len() } else { 0 }];
    let means = region_means(regions.unwrap_or(&one), seen, specular);
    means.iter().fold((0.0, 0), |best, next| if next.1 > best.1 { *next } else { best }).0
}

/// The mean and the number of seen texels of every region.
fn region_means(regions: &[u8], seen: &[bool], specular: &[f32]) -> Vec<(f32, usize)> {
    let mut sums = vec![(0.0f64, 0usize); 256];
    for ((region, value), _) in regions.iter().zip(specular).zip(seen).filter(|(_, seen)| **seen) {
        let sum = &mut sums[*region as usize];
        *sum = (sum.0 + f64::from(*value), sum.1 + 1);
    }
    sums.iter().map(|(sum, count)| ((sum / (*count).max(1) as f64) as f32, *count)).collect()
}

/// The median length of a texel on the surface, metres.
fn texel_length(atlas: &Atlas) -> f32 {
    let inside =
        |at: &usize| !at.is_multiple_of(atlas.size) && atlas.inside[*at] && atlas.inside[*at - 1];
    let length = |at: usize| atlas.positions[at].distance(atlas.positions[at - 1]);
    let mut lengths: Vec<f32> = (0..atlas.inside.len()).filter(inside).map(length).collect();
    lengths.sort_by(f32::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0).max(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use capture::View;
    use capture::gbuffer::GBuffer;
    use capture::projection::Projection;
    use formats::picture::GrayImage;

    use super::*;
    use crate::semantic::region_map;
    use crate::testing;

    const SIZE: usize = 32;

    fn pool(labelled: bool, specular: impl Fn(usize) -> f32) -> (Vec<f32>, Vec<bool>, f32) {
        let mesh = testing::dome(16);
        let label = |view: View| {
            let (width, height) = (view.camera.width, view.camera.height);
            // The left two thirds are one region, the rest another.
            let data = (0..width * height).map(|at| 1 + u8::from(3 * (at % width) > 2 * width));
            let labels = labelled.then(|| GrayImage { width, height, data: data.collect() });
            View { labels, ..view }
        };
        let views: Vec<View> = testing::rig(1, 48)
            .iter()
            .map(|camera| label(testing::view(&mesh, camera, |_| (glam::Vec3::ONE, 0))))
            .collect();
        let gbuffers = GBuffer::of_views(&mesh, &views);
        let projections = Projection::of_views(&views, &gbuffers);
        let atlas = Atlas::new(&mesh, SIZE);
        let seen = capture::projection::per_texel(&atlas, &projections, |_| true);
        let specular: Vec<f32> = (0..SIZE * SIZE).map(specular).collect();
        let config = crate::Config::default().normalisation;
        let config = NormalisationConfig { specular_pooling: 0.2, ..config };
        let regions = region_map(&atlas, &projections);
        let regions = labelled.then_some(regions.as_slice());
        let pooled = pooled(&config, &atlas, regions, &seen, &specular);
        let largest = of_largest_region(regions, &seen, &specular);
        (pooled, seen, largest)
    }

    #[test]
    fn labelled_regions_become_even_and_keep_their_means() {
        let (pooled, seen, largest) = pool(true, |at| 0.02 + 0.01 * (at % 2) as f32);
        let mut values: Vec<f32> =
            pooled.iter().zip(&seen).filter(|(_, seen)| **seen).map(|(value, _)| *value).collect();
        values.sort_by(f32::total_cmp);
        values.dedup();
        assert_eq!(values.len(), 2, "{values:?}");
        assert!(values.iter().all(|value| (value - 0.025).abs() < 2e-3), "{values:?}");
        assert!(values.contains(&largest));
    }

    #[test]
    fn without_labels_noise_goes_and_coarse_differences_stay() {
        let noise =
            |at: usize| if (at / SIZE + at % SIZE).is_multiple_of(2) { 0.01 } else { -0.01 };
        let ramp = |at: usize| 0.01 + 0.02 * (at % SIZE) as f32 / SIZE as f32;
        let (pooled, seen, _) = pool(false, |at| ramp(at) + noise(at));
        let inner = |at: &usize| {
            seen[*at] && (8..24).contains(&(at % SIZE)) && (8..24).contains(&(at / SIZE))
        };
        let texels: Vec<usize> = (0..SIZE * SIZE).filter(inner).collect();
        assert!(texels.len() > 100);
        for at in texels {
            assert!((pooled[at] - ramp(at)).abs() < 3e-3, "{at}: {} not {}", pooled[at], ramp(at));
        }
    }
}
