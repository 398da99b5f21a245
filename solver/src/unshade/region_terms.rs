//! Specular reflectance and roughness per region, by highlights. Diffuse radiance does not depend on the view, so
//! view-to-view variation at a texel is specular: the slope of the observed on the predicted highlights is a factor of
//! the reflectance, and that on their derivative by the roughness a step of it.

use serde::{Deserialize, Serialize};

use super::regression::{Fit, Regression};
use crate::config::{ReflectanceConfig, RoughnessConfig};
use crate::transport::{CHANNELS, SpecularTerm};

/// Contrast of a light that is half even.
const HALF_EVEN_CONTRAST: f32 = 0.3;

/// The specular term per region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct RegionTerms {
    /// By the id of the region.
    regions: Vec<SpecularTerm>,
    /// The expected term of skin.
    expected: SpecularTerm,
    /// The regions that are skin and have one term; if none is named, the largest alone.
    skin: Vec<u8>,
}

impl RegionTerms {
    /// The expected term of skin everywhere; `regions` are those of a texture.
    pub fn expected(reflectance: f32, skin: &[u8], regions: &[u8]) -> Self {
        let mut skin = skin.to_vec();
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

    /// The terms relative to the [peak](crate::transport::Transport::peak) of another light, by its peak over that of
    /// this one: highlights are as strong as before. The expected term does not change.
    #[must_use]
    pub fn relative_to(&self, factor: f32) -> Self {
        let scaled =
            |term: &SpecularTerm| SpecularTerm { reflectance: factor * term.reflectance, ..*term };
        Self { regions: self.regions.iter().map(scaled).collect(), ..self.clone() }
    }

    fn of_skin(&self) -> SpecularTerm {
        self.of(self.skin[0])
    }

    /// The factor of the pictures' exposure over the light's peak. Skin's measured reflectance is the expected one
    /// times this factor and that of the person; both have a prior, and this is the most probable.
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

    /// The terms after a regression on the highlights that these terms predict, on a texture of the `regions`.
    /// Measurement and prior weigh by their variances; a region without highlights keeps the term of skin. Under an
    /// even light (`evenness` up to 1) highlights vary at grazing angles alone, where normals and visibility err most.
    #[must_use]
    pub fn with_reflectance(
        &self,
        config: &ReflectanceConfig,
        evenness: f32,
        regression: &Regression,
        regions: &[u8],
    ) -> Self {
        let inflation = error_inflation(evenness);
        self.revised(regression, regions, |measured, prior, is_skin| {
            // Under an even light, errors of skin, which has the stronger prior, are inflated twice; elsewhere the
            // light was found by other highlights, and errors are larger throughout.
            let (error, floor, deviation) = match is_skin {
                true => (config.skin_error * inflation * inflation, 0.0, config.skin_deviation),
                false => {
                    (config.region_error * inflation, config.region_floor, config.region_deviation)
                }
            };
            let reflectance = measured.reflectance(prior, error, floor, deviation);
            SpecularTerm { reflectance, ..measured.now }
        })
    }

    /// Likewise with the roughness.
    #[must_use]
    pub fn with_roughness(
        &self,
        config: &RoughnessConfig,
        evenness: f32,
        regression: &Regression,
        regions: &[u8],
    ) -> Self {
        let error = config.error * error_inflation(evenness);
        self.revised(regression, regions, |measured, prior, _| {
            let roughness = measured.roughness(prior, error, config.deviation);
            SpecularTerm { roughness, ..measured.now }
        })
    }

    /// Every term by its measurement and its prior: of skin, which has one term (`true`), the expected term; of any
    /// other region the new term of skin.
    fn revised(
        &self,
        regression: &Regression,
        regions: &[u8],
        revised: impl Fn(Measurement, SpecularTerm, bool) -> SpecularTerm,
    ) -> Self {
        let measured = |now: SpecularTerm, within: &dyn Fn(u8) -> bool| Measurement {
            now,
            fit: regression.fit(|texel| within(regions[texel]), 0..CHANNELS),
        };
        let is_skin = |region: u8| self.skin.contains(&region);
        let skin = revised(measured(self.of_skin(), &is_skin), self.expected, true);
        let of = |region: u8| match is_skin(region) {
            true => skin,
            false => revised(measured(self.of(region), &|other| other == region), skin, false),
        };
        Self { regions: (0..=u8::MAX).map(of).collect(), ..self.clone() }
    }
}

/// 1 of a light without contrast, 0 of lamps in the dark.
pub(super) fn evenness(contrast: f32) -> f32 {
    1.0 / (1.0 + (contrast / HALF_EVEN_CONTRAST).powi(2))
}

/// Factor on the errors of measurements by highlights under an even light.
fn error_inflation(evenness: f32) -> f32 {
    (1.0 - evenness).max(1e-3).recip()
}

/// The regression of a region whose term was taken to be `now`.
struct Measurement {
    now: SpecularTerm,
    fit: Fit,
}

impl Measurement {
    /// The posterior reflectance. The measurement has the relative `error` of the model and `floor` of the prior as
    /// its errors besides that of the regression; the prior has the relative `deviation`.
    fn reflectance(
        &self,
        prior: SpecularTerm,
        model_error: f32,
        floor: f32,
        deviation: f32,
    ) -> f32 {
        let Some((slope, error)) = self.fit.slope() else { return prior.reflectance };
        let now = f64::from(self.now.reflectance);
        let measured = now * slope.max(0.0);
        let prior = f64::from(prior.reflectance);
        let error = (now * error).hypot(f64::from(model_error) * measured);
        let error = error.hypot(f64::from(floor) * prior);
        posterior((measured, error), (prior, f64::from(deviation) * prior)) as f32
    }

    /// The posterior roughness, likewise, by its logarithm.
    fn roughness(&self, prior: SpecularTerm, model_error: f32, deviation: f32) -> f32 {
        let Some((step, error)) = self.fit.rougher() else { return prior.roughness };
        let error = error.hypot(f64::from(model_error));
        let measured = f64::from(self.now.roughness.ln()) + step.clamp(-LARGEST, LARGEST);
        let prior = f64::from(prior.roughness.ln());
        posterior((measured, error), (prior, f64::from(deviation))).exp() as f32
    }
}

/// Largest step of the logarithm of the roughness: farther than that its derivative does not hold.
const LARGEST: f64 = 0.3;

/// The posterior mean of a measurement and a prior with their standard deviations.
fn posterior((measured, error): (f64, f64), (prior, deviation): (f64, f64)) -> f64 {
    let weight = deviation * deviation / (deviation * deviation + error * error);
    weight * measured + (1.0 - weight) * prior
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::UnshadeConfig;
    use crate::unshade::tint::tests::scene;

    const SKIN: f32 = 0.028;

    fn everywhere(reflectance: f32) -> RegionTerms {
        RegionTerms::expected(reflectance, &[1], &[])
    }

    /// Terms whose measured reflectance is the expected one times a factor.
    fn measured(factor: f32) -> RegionTerms {
        let regions = vec![SpecularTerm::usual(factor * SKIN); 256];
        RegionTerms { regions, ..everywhere(SKIN) }
    }

    /// The reflectances of two halves of a texture whose highlights are `factors` of the predicted ones.
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
        let config = UnshadeConfig::default().reflectance;
        let all = everywhere(SKIN).with_reflectance(&config, 0.0, &regression, &regions);
        [1, 2].map(|region| all.of(region).reflectance)
    }

    #[test]
    fn stronger_highlights_of_skin_are_partly_exposure() {
        let config = UnshadeConfig::default().reflectance;
        let exposure = |factor: f32| measured(factor).exposure(&config);
        assert_eq!(exposure(1.0), 1.0);
        // The share of the exposure's variance in both.
        let [own, skin] = [config.exposure_deviation, config.skin_deviation].map(|d| d * d);
        let expected = 1.1_f32.powf(own / (own + skin));
        assert!((exposure(1.1) - expected).abs() < 0.011, "{}", exposure(1.1));
        assert_eq!(exposure(0.0), 1.0);
        let peak = ReflectanceConfig { exposure_deviation: 0.0, ..config.clone() };
        assert_eq!(measured(0.5).exposure(&peak), 1.0);
    }

    #[test]
    fn reflectance_lies_between_highlights_and_prior() {
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
    fn roughness_does_not_depend_on_the_strength_of_highlights() {
        let (samples, predicted) = scene();
        let regions = vec![1; samples.taps.size() * samples.taps.size()];
        let slope = |i: usize| predicted[i].map(|p| (40.0 * p).sin());
        let rows = |i: usize| [predicted[i], slope(i)];
        let shown =
            |i: usize| std::array::from_fn(|c| 3.0 + 1.7 * (predicted[i][c] + 0.2 * slope(i)[c]));
        let regression = Regression::new(&samples, &samples.weight, rows, shown);
        let found = |config: &RoughnessConfig, evenness: f32| {
            let all = everywhere(SKIN).with_roughness(config, evenness, &regression, &regions);
            assert_eq!(all.of(1).reflectance, SKIN);
            all.of(1).roughness.ln()
        };
        let config = UnshadeConfig::default().roughness;
        let exact = RoughnessConfig { error: 0.0, ..config.clone() };
        assert!((found(&exact, 0.0) - 0.2).abs() < 1e-3, "{}", found(&exact, 0.0));
        // Between what is expected and what is shown, by their variances; an even light shows nothing.
        let doubtful = RoughnessConfig { error: config.deviation, ..config };
        assert!((found(&doubtful, 0.0) - 0.1).abs() < 1e-3, "{}", found(&doubtful, 0.0));
        assert!(found(&doubtful, 1.0).abs() < 1e-3);
    }
}
