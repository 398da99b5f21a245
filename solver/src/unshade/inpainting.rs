//! Inpainting of hair, brows and lips where pictures have little weight, with the mean of the region nearby, before the
//! last fit of the albedo. Their joint albedo is from a coarser texture, which mixes regions. Skin is smooth, and keeps
//! its texels.

use crate::model::blur::Blur;
use crate::transport::CHANNELS;

/// Weight of the pictures from which on a texel does not change.
const ENOUGH: f32 = 1.0 / 3.0;
/// Least weight of a texel in the mean, which decides only if no texel nearby has pictures.
const LEAST: f32 = 1e-6;

/// Blends every texel of `albedo` (R, G, B on a square texture) outside of `skin` with the mean of its region nearby.
/// The share of the mean falls from 1 to 0 with the weight of the pictures (0 to 1); its square is the weight in the
/// mean. `reach` is the standard deviation of the neighbourhood, texels. Without named skin nothing changes.
pub(super) fn inpaint_from_region(
    albedo: &mut [f32],
    regions: &[u8],
    skin: &[u8],
    picture_weights: &[f32],
    reach: f32,
) {
    if skin.is_empty() {
        return;
    }
    let mut present = [false; 256];
    regions.iter().for_each(|region| present[usize::from(*region)] = true);
    let others = (0..=u8::MAX).filter(|r| present[usize::from(*r)] && !skin.contains(r));
    let blur = Blur::new(regions.len().isqrt(), CHANNELS + 1, reach);
    for region in others {
        let within = |at: usize| regions[at] == region;
        let weighted = |at: usize| {
            let weight =
                if within(at) { LEAST + picture_weights[at] * picture_weights[at] } else { 0.0 };
            let texel = &albedo[CHANNELS * at..];
            [weight * texel[0], weight * texel[1], weight * texel[2], weight]
        };
        let sums = blur.apply(&(0..regions.len()).flat_map(weighted).collect::<Vec<_>>());
        let texels = albedo.as_chunks_mut::<CHANNELS>().0;
        let means = sums.as_chunks::<{ CHANNELS + 1 }>().0;
        for (at, (albedo, [r, g, b, weight])) in texels.iter_mut().zip(means).enumerate() {
            let share = (1.0 - picture_weights[at] / ENOUGH).max(0.0);
            if within(at) && share > 0.0 {
                for (albedo, sum) in albedo.iter_mut().zip([r, g, b]) {
                    *albedo += share * (sum / weight - *albedo);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 32;
    const SKIN: u8 = 1;
    const HAIR: u8 = 2;

    /// The first row after inpainting, with hair on its right half. One column of eight has another colour and this
    /// weight of the pictures, all others 1.
    fn inpainted(weight: f32, skin: &[u8]) -> Vec<f32> {
        let column = |i: usize| i % SIZE;
        let of = |i: usize| (column(i) < SIZE / 2, column(i) % 8 == 4);
        let regions: Vec<u8> =
            (0..SIZE * SIZE).map(|i| if of(i).0 { SKIN } else { HAIR }).collect();
        let weights: Vec<f32> =
            (0..SIZE * SIZE).map(|i| if of(i).1 { weight } else { 1.0 }).collect();
        let colour = |i: usize| match of(i) {
            (_, true) => 0.9,
            (true, _) => 0.5,
            (false, _) => 0.1,
        };
        let mut diffuse: Vec<f32> = (0..SIZE * SIZE).flat_map(|i| [colour(i); CHANNELS]).collect();
        inpaint_from_region(&mut diffuse, &regions, skin, &weights, 4.0);
        diffuse.chunks_exact(CHANNELS).take(SIZE).map(|texel| texel[0]).collect()
    }

    #[test]
    fn unseen_hair_gets_the_colour_of_hair_nearby() {
        let row = inpainted(0.0, &[SKIN]);
        assert!((row[20] - 0.1).abs() < 1e-4, "{row:?}");
        assert_eq!(row[17], 0.1, "texels with pictures stay");
        assert_eq!([row[2], row[4]], [0.5, 0.9], "skin stays");
    }

    #[test]
    fn texels_with_pictures_stay() {
        let [little, enough] = [0.1, 0.4].map(|weight| inpainted(weight, &[SKIN])[20]);
        assert!(little > 0.1 && little < 0.5, "{little}");
        assert_eq!(enough, 0.9);
    }

    #[test]
    fn without_named_skin_nothing_changes() {
        assert_eq!(inpainted(0.0, &[]), inpainted(1.0, &[SKIN]));
    }
}
