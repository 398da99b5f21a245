//! Hair, brows and lips that pictures hardly show begin the last albedo with the mean of their region around: theirs so
//! far is from a coarser texture, on which regions mix. Skin is smooth, and its own texel knows more than its
//! neighbourhood.

use crate::model::blur::Blur;
use crate::transport::CHANNELS;

/// Texels with this weight of the pictures begin as they came.
const ENOUGH: f32 = 1.0 / 3.0;
/// Weight of a texel without pictures: where nothing far around has any, all weigh alike.
const LEAST: f32 = 1e-6;

/// Mixes every texel of `albedo` (R, G, B on a square texture) whose region is not of `skin` with the mean of that
/// region around it, the more the less the weight of the `pictures` (0 to 1), whose square is the weight in the mean.
/// `reach` is the standard deviation of the neighbourhood, texels. Without named skin nothing changes.
pub(super) fn inpaint_from_region(
    albedo: &mut [f32],
    regions: &[u8],
    skin: &[u8],
    pictures: &[f32],
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
        let weighed = |at: usize| {
            let weight = if within(at) { LEAST + pictures[at] * pictures[at] } else { 0.0 };
            let texel = &albedo[CHANNELS * at..];
            [weight * texel[0], weight * texel[1], weight * texel[2], weight]
        };
        let sums = blur.apply(&(0..regions.len()).flat_map(weighed).collect::<Vec<_>>());
        let texels = albedo.as_chunks_mut::<CHANNELS>().0;
        let around = sums.as_chunks::<{ CHANNELS + 1 }>().0;
        for (at, (albedo, [r, g, b, weight])) in texels.iter_mut().zip(around).enumerate() {
            let mixed = (1.0 - pictures[at] / ENOUGH).max(0.0);
            if within(at) && mixed > 0.0 {
                for (albedo, sum) in albedo.iter_mut().zip([r, g, b]) {
                    *albedo += mixed * (sum / weight - *albedo);
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

    /// The first row, hair on its right half: decided, and of one colour, but in one column of eight.
    fn mixed(decided: f32, skin: &[u8]) -> Vec<f32> {
        let column = |i: usize| i % SIZE;
        let of = |i: usize| (column(i) < SIZE / 2, column(i) % 8 == 4);
        let regions: Vec<u8> =
            (0..SIZE * SIZE).map(|i| if of(i).0 { SKIN } else { HAIR }).collect();
        let decided: Vec<f32> =
            (0..SIZE * SIZE).map(|i| if of(i).1 { decided } else { 1.0 }).collect();
        let colour = |i: usize| match of(i) {
            (_, true) => 0.9,
            (true, _) => 0.5,
            (false, _) => 0.1,
        };
        let mut diffuse: Vec<f32> = (0..SIZE * SIZE).flat_map(|i| [colour(i); CHANNELS]).collect();
        inpaint_from_region(&mut diffuse, &regions, skin, &decided, 4.0);
        diffuse.chunks_exact(CHANNELS).take(SIZE).map(|texel| texel[0]).collect()
    }

    #[test]
    fn unseen_hair_begins_as_the_hair_around() {
        let row = mixed(0.0, &[SKIN]);
        assert!((row[20] - 0.1).abs() < 1e-4, "{row:?}");
        assert_eq!(row[17], 0.1, "what pictures show stays");
        assert_eq!([row[2], row[4]], [0.5, 0.9], "skin stays");
    }

    #[test]
    fn texels_with_pictures_stay() {
        let [little, enough] = [0.1, 0.4].map(|decided| mixed(decided, &[SKIN])[20]);
        assert!(little > 0.1 && little < 0.5, "{little}");
        assert_eq!(enough, 0.9);
    }

    #[test]
    fn without_named_skin_nothing_changes() {
        assert_eq!(mixed(0.0, &[]), mixed(1.0, &[SKIN]));
    }
}
