//! Where pictures say little of hair, brows or lips, the last albedo begins with what they say of them around there:
//! the colour with which a texel came so far is of a coarser texture, on which regions mix. Skin's is smooth, and knows
//! more than its surroundings.

use crate::model::blur::Blur;
use crate::transport::CHANNELS;

/// Texels that pictures decide as far as this begin as they came.
const ENOUGH: f32 = 1.0 / 3.0;

/// Of the weight of a texel that pictures say nothing of: where they say nothing far around, all weigh alike.
const LEAST: f32 = 1e-6;

/// Mixes every texel of `diffuse` (R, G, B on a square texture) whose region is not of `skin` with the mean of that
/// region around it, the more the less pictures have `decided` it (0 to 1); it weighs by the square of that. `reach` is
/// the standard deviation of the weights, texels. With 0, or if no region is named as skin, nothing changes.
pub(super) fn from_surroundings(
    diffuse: &mut [f32],
    regions: &[u8],
    skin: &[u8],
    decided: &[f32],
    reach: f32,
) {
    if reach == 0.0 || skin.is_empty() {
        return;
    }
    let mut present = [false; 256];
    regions.iter().for_each(|region| present[usize::from(*region)] = true);
    let others = (0..=u8::MAX).filter(|r| present[usize::from(*r)] && !skin.contains(r));
    let blur = Blur::new(regions.len().isqrt(), CHANNELS + 1, reach);
    for region in others {
        let within = |at: usize| regions[at] == region;
        let weighed = |at: usize| {
            let weight = if within(at) { LEAST + decided[at] * decided[at] } else { 0.0 };
            let albedo = &diffuse[CHANNELS * at..];
            [weight * albedo[0], weight * albedo[1], weight * albedo[2], weight]
        };
        let sums = blur.apply(&(0..regions.len()).flat_map(weighed).collect::<Vec<_>>());
        let texels = diffuse.as_chunks_mut::<CHANNELS>().0;
        let around = sums.as_chunks::<{ CHANNELS + 1 }>().0;
        for (at, (albedo, [r, g, b, weight])) in texels.iter_mut().zip(around).enumerate() {
            let mixed = (1.0 - decided[at] / ENOUGH).max(0.0);
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
        from_surroundings(&mut diffuse, &regions, skin, &decided, 4.0);
        diffuse.chunks_exact(CHANNELS).take(SIZE).map(|texel| texel[0]).collect()
    }

    #[test]
    fn hair_that_pictures_do_not_show_begins_as_the_hair_around() {
        let row = mixed(0.0, &[SKIN]);
        assert!((row[20] - 0.1).abs() < 1e-4, "{row:?}");
        assert_eq!(row[17], 0.1, "what pictures show stays");
        assert_eq!([row[2], row[4]], [0.5, 0.9], "skin stays");
    }

    #[test]
    fn the_more_pictures_decide_the_more_it_stays() {
        let [little, enough] = [0.1, 0.4].map(|decided| mixed(decided, &[SKIN])[20]);
        assert!(little > 0.1 && little < 0.5, "{little}");
        assert_eq!(enough, 0.9);
    }

    #[test]
    fn without_a_name_for_skin_everything_begins_as_it_came() {
        assert_eq!(mixed(0.0, &[]), mixed(1.0, &[SKIN]));
    }
}
