//! The data that the light is fitted to.

use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// The data of the light fit: pictures averaged over 2 x 2 pixels on the transport's texture, with the region and
/// the first albedo of every texel.
pub(super) struct FirstColours<'a> {
    pub samples: &'a Samples,
    pub regions: &'a [u8],
    /// The labels that are skin by their names.
    pub labelled_skin: &'a [u8],
    /// The regions that are skin.
    pub skin: &'a [u8],
    /// R, G, B per texel.
    pub albedo: &'a [f32],
}

impl FirstColours<'_> {
    /// The samples of skin alone, if the capture names it: the rest has but the mean colours of the pictures.
    pub fn of_skin(&self) -> Samples {
        let mut samples = self.samples.clone();
        if !self.labelled_skin.is_empty() {
            let is_skin =
                |i: usize| self.labelled_skin.contains(&self.regions[samples.taps.nearest(i)]);
            let weight = |i: usize| if is_skin(i) { samples.weight.get(0, i) } else { 0.0 };
            samples.weight = Planes::from_fn(samples.len(), |i| [weight(i)]);
        }
        samples
    }
}
