//! The data of the light fits.

use super::illuminations::Illuminations;
use super::known::Known;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::semantic::regions::FaceRegions;

/// The halved pictures on the transport's texture, with the region and the region's colour of every texel.
pub(super) struct LightFitData<'a> {
    pub known: Known<'a>,
    pub illuminations: &'a Illuminations,
    pub samples: &'a Samples,
    pub face: &'a FaceRegions,
    /// The region of every texel.
    pub regions: &'a [u8],
    /// The mean colour of the texel's region times [`Scene::picture_scale`](crate::scene::Scene::picture_scale), R, G,
    /// B per texel: radiance, which the light fits hold as the albedo.
    pub region_colours: &'a [f32],
}

impl LightFitData<'_> {
    /// All samples in the same order, with weight 0 outside of skin if the capture names it: other regions have only
    /// the mean colours of the pictures.
    pub fn samples_of_skin(&self) -> Samples {
        let mut samples = self.samples.clone();
        let skin = &self.face.labelled_skin;
        if !skin.is_empty() {
            let is_skin = |i: usize| skin.contains(&self.regions[samples.taps.nearest(i)]);
            let weight = |i: usize| if is_skin(i) { samples.weight.get(0, i) } else { 0.0 };
            samples.weight = Planes::from_fn(samples.len(), |i| [weight(i)]);
        }
        samples
    }
}
