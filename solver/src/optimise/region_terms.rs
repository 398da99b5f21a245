//! How much regions of a face mirror, and how sharply, by their highlights: what varies in one place from view to
//! view is hardly diffuse, so the slope of what is shown on what is predicted there is a factor of the reflectance,
//! and that on the derivative by the roughness a step of it.

use serde::{Deserialize, Serialize};

use super::context::SolveContext;
use super::regression::{Fit, Regression};
use crate::config::ReflectanceConfig;
use crate::transport::{CHANNELS, SpecularTerm};

/// The specular term by region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct RegionTerms {
    /// By the id of the region.
    regions: Vec<SpecularTerm>,
    /// That is expected of skin.
    expected: SpecularTerm,
    /// The regions that are skin and have one term; if none is named, the largest alone.
    skin: Vec<u8>,
}

impl RegionTerms {
    /// That of skin, everywhere; `regions` are those of a texture.
    pub fn expected(context: &SolveContext, regions: &[u8]) -> Self {
        let reflectance = context.gain * context.config.normalisation.specular_skin;
        let mut skin = context.skin_regions();
        if skin.is_empty() {
            let mut counts = [0usize; 256];
            regions.iter().for_each(|region| counts[usize::from(*region)] += 1);
            let largest = (0..=u8::MAX).max_by_key(|region| counts[usize::from(*region)]);
            skin.extend(largest);
        }
        let expected = SpecularTerm::usual(reflectance);
        Self { regions: vec![expected; 256], expected, skin }
    }

    /// That of a region.
    pub fn of(&self, region: u8) -> SpecularTerm {
        self.regions[usize::from(region)]
    }

    /// As a texture of these regions, of [`SpecularTerm::channels`].
    pub fn texture(&self, regions: &[u8]) -> Vec<f32> {
        regions.iter().flat_map(|region| self.of(*region).channels()).collect()
    }

    fn of_skin(&self) -> SpecularTerm {
        self.of(self.skin[0])
    }

    /// By what pictures are brighter than their peak says, as far as skin's highlights tell it: they differ from
    /// the expected ones by the product of that and of skin's reflectance over the expected, and both have a
    /// prior. The most probable.
    pub fn exposure(&self, config: &ReflectanceConfig) -> f32 {
        if config.exposure_deviation == 0.0 {
            return 1.0;
        }
        let shown = self.of_skin().reflectance / self.expected.reflectance;
        let misfit = |log: &f32| {
            let of_skin = (shown / log.exp() - 1.0) / config.skin_deviation;
            (log / config.exposure_deviation).powi(2) + of_skin.powi(2)
        };
        let logs = (-100..=100).map(|hundredths: i32| 0.01 * hundredths as f32);
        let least = logs.min_by(|a, b| misfit(a).total_cmp(&misfit(b)));
        least.map_or(1.0, f32::exp)
    }

    /// Multiplies all reflectances.
    pub fn scale(&mut self, factor: f32) {
        self.regions.iter_mut().for_each(|term| term.reflectance *= factor);
    }

    /// Takes in what highlights say that were predicted with these terms, on a texture of the `regions`. Both what
    /// is expected and what is said weigh by their variances; a region that says nothing mirrors like skin.
    /// Under an even light (`evenness` up to 1) highlights vary at grazing angles alone, where normals and
    /// visibility err most, and say little.
    pub fn update(
        &mut self,
        config: &ReflectanceConfig,
        evenness: f32,
        regression: &Regression,
        regions: &[u8],
    ) {
        let doubt = doubt(evenness);
        self.revise(regression, regions, |said, prior, is_skin| {
            // Skin, which has the stronger prior, is believed less under an even light; elsewhere more, since the light
            // was found by its highlights.
            let (error, floor, deviation) = match is_skin {
                true => (config.model_error * doubt * doubt, 0.0, config.skin_deviation),
                false => {
                    (config.region_error * doubt, config.region_floor, config.region_deviation)
                }
            };
            let reflectance = said.reflectance(prior, error, floor, deviation);
            SpecularTerm { reflectance, ..said.now }
        });
    }

    /// Takes in the roughness that highlights show, likewise.
    pub fn update_roughness(
        &mut self,
        config: &ReflectanceConfig,
        evenness: f32,
        regression: &Regression,
        regions: &[u8],
    ) {
        let error = config.roughness_error * doubt(evenness);
        self.revise(regression, regions, |said, prior, _| {
            let roughness = said.roughness(prior, error, config.roughness_deviation);
            SpecularTerm { roughness, ..said.now }
        });
    }

    /// Every term by what is said of it and its prior: for skin, which is one (`true`), what is expected; for any
    /// other region skin's new term.
    fn revise(
        &mut self,
        regression: &Regression,
        regions: &[u8],
        revised: impl Fn(Said, SpecularTerm, bool) -> SpecularTerm,
    ) {
        let said = |now: SpecularTerm, within: &dyn Fn(u8) -> bool| Said {
            now,
            fit: regression.fit(|texel| within(regions[texel]), 0..CHANNELS),
        };
        let is_skin = |region: u8| self.skin.contains(&region);
        let skin = revised(said(self.of_skin(), &is_skin), self.expected, true);
        let of = |region: u8| match is_skin(region) {
            true => skin,
            false => revised(said(self.of(region), &|other| other == region), skin, false),
        };
        self.regions = (0..=u8::MAX).map(of).collect();
    }
}

/// Factor on the errors of what is measured by highlights: under an even light they say little.
fn doubt(evenness: f32) -> f32 {
    (1.0 - evenness).max(1e-3).recip()
}

/// What highlights say of a region, whose term was taken to be `now`.
struct Said {
    now: SpecularTerm,
    fit: Fit,
}

impl Said {
    /// The reflectance, between `prior`, which `deviation` says how far to trust, and what the slope says, in which
    /// `model_error` is, and `floor` whatever it says; all relative, the last to the prior.
    fn reflectance(
        &self,
        prior: SpecularTerm,
        model_error: f32,
        floor: f32,
        deviation: f32,
    ) -> f32 {
        let Some((slope, error)) = self.fit.slope() else { return prior.reflectance };
        let now = f64::from(self.now.reflectance);
        let said = now * slope.max(0.0);
        let prior = f64::from(prior.reflectance);
        let error = (now * error).hypot(f64::from(model_error) * said);
        let error = error.hypot(f64::from(floor) * prior);
        posterior((said, error), (prior, f64::from(deviation) * prior)) as f32
    }

    /// The roughness, likewise, by its logarithm.
    fn roughness(&self, prior: SpecularTerm, model_error: f32, deviation: f32) -> f32 {
        let Some((step, error)) = self.fit.rougher() else { return prior.roughness };
        let error = error.hypot(f64::from(model_error));
        let said = f64::from(self.now.roughness.ln()) + step.clamp(-LARGEST, LARGEST);
        let prior = f64::from(prior.roughness.ln());
        posterior((said, error), (prior, f64::from(deviation))).exp() as f32
    }
}

/// Largest step of the logarithm of the roughness: further than that its derivative says nothing.
const LARGEST: f64 = 0.3;

/// Of two values with their standard deviations.
fn posterior((said, error): (f64, f64), (prior, deviation): (f64, f64)) -> f64 {
    let weight = deviation * deviation / (deviation * deviation + error * error);
    weight * said + (1.0 - weight) * prior
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::optimise::tint::tests::scene;

    const SKIN: f32 = 0.028;

    fn everywhere(reflectance: f32) -> RegionTerms {
        let expected = SpecularTerm::usual(reflectance);
        RegionTerms { regions: vec![expected; 256], expected, skin: vec![1] }
    }

    /// RegionTerms found of two halves of a texture whose highlights are `factors` of the predicted ones.
    fn found(factors: [f32; 2]) -> [f32; 2] {
        let (samples, predicted) = scene();
        let texels = samples.taps.size() * samples.taps.size();
        let regions: Vec<u8> = (0..texels).map(|at| 1 + u8::from(2 * at > texels)).collect();
        let factor = |i: usize| factors[usize::from(regions[samples.taps.nearest(i)]) - 1];
        let shown = |i: usize| {
            std::array::from_fn::<f32, CHANNELS, _>(|c| 3.0 + factor(i) * predicted[i][c])
        };
        let rows = |i: usize| [predicted[i], [0.0; CHANNELS]];
        let regression = Regression::new(&samples, &samples.weight, rows, shown);
        let mut all = everywhere(SKIN);
        all.update(&Config::default().reflectance, 0.0, &regression, &regions);
        [1, 2].map(|region| all.of(region).reflectance)
    }

    #[test]
    fn skin_that_mirrors_little_more_is_partly_another_exposure_and_skin_that_mirrors_nothing_is_not()
     {
        let config = Config::default().reflectance;
        let exposure = |factor: f32| {
            let mut all = everywhere(SKIN);
            all.scale(factor);
            all.exposure(&config)
        };
        assert_eq!(exposure(1.0), 1.0);
        // The share of the exposure's variance in both.
        let [own, skin] = [config.exposure_deviation, config.skin_deviation].map(|d| d * d);
        let expected = 1.1_f32.powf(own / (own + skin));
        assert!((exposure(1.1) - expected).abs() < 0.011, "{}", exposure(1.1));
        assert_eq!(exposure(0.0), 1.0);
        let mut half = everywhere(SKIN);
        half.scale(0.5);
        let peak = ReflectanceConfig { exposure_deviation: 0.0, ..config.clone() };
        assert_eq!(half.exposure(&peak), 1.0);
    }

    #[test]
    fn regions_mirror_what_their_highlights_show_but_for_what_is_expected() {
        let [skin, hair] = found([1.3, 0.4]);
        // A tenth of error of the model against half of deviation; for hair .3 of the little that it mirrors, and
        // .15 of what skin does.
        assert!((skin / (1.3 * SKIN) - 1.0).abs() < 0.02, "{skin}");
        let weight = |said: f32| 0.25 / (0.25 + 0.15_f32.powi(2) + (0.3 * said).powi(2));
        let said = 0.4 / 1.3;
        let expected = weight(said) * 0.4 + (1.0 - weight(said)) * 1.3;
        assert!((hair / (expected * SKIN) - 1.0).abs() < 0.03, "{hair} {expected}");
        // What seems to mirror nothing still mirrors a little: the light may be a little off.
        let [skin, hair] = found([1.0, -0.5]);
        assert!((skin / SKIN - 1.0).abs() < 1e-4, "{skin}");
        assert!((hair / ((1.0 - weight(0.0)) * SKIN) - 1.0).abs() < 0.1, "{hair}");
    }

    #[test]
    fn roughness_moves_by_what_highlights_change_with_it_whatever_their_strength() {
        let (samples, predicted) = scene();
        let regions = vec![1; samples.taps.size() * samples.taps.size()];
        let slope = |i: usize| predicted[i].map(|p| (40.0 * p).sin());
        let rows = |i: usize| [predicted[i], slope(i)];
        let shown =
            |i: usize| std::array::from_fn(|c| 3.0 + 1.7 * (predicted[i][c] + 0.2 * slope(i)[c]));
        let regression = Regression::new(&samples, &samples.weight, rows, shown);
        let found = |config: &ReflectanceConfig, evenness: f32| {
            let mut all = everywhere(SKIN);
            all.update_roughness(config, evenness, &regression, &regions);
            assert_eq!(all.of(1).reflectance, SKIN);
            all.of(1).roughness.ln()
        };
        let config = Config::default().reflectance;
        let exact = ReflectanceConfig { roughness_error: 0.0, ..config.clone() };
        assert!((found(&exact, 0.0) - 0.2).abs() < 1e-3, "{}", found(&exact, 0.0));
        // Between what is expected and what is shown, by their variances; an even light shows nothing.
        let doubtful = ReflectanceConfig { roughness_error: config.roughness_deviation, ..config };
        assert!((found(&doubtful, 0.0) - 0.1).abs() < 1e-3, "{}", found(&doubtful, 0.0));
        assert!(found(&doubtful, 1.0).abs() < 1e-3);
    }
}
