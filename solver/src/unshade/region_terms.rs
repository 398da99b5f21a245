//! Specular reflectance and roughness per region, from highlights. Diffuse radiance does not depend on the view, so
//! view-to-view variation at a texel is specular. The slope of the observed on the predicted highlights is a factor on
//! the reflectance; the slope on their derivative with respect to roughness is a step of the roughness.

use serde::{Deserialize, Serialize};

use super::regression::{Regression, RegressionSums};
use crate::config::{ReflectanceConfig, RoughnessConfig};
use crate::transport::{CHANNELS, SpecularTerm};

/// Contrast of a light with a uniformity of one half.
const HALF_UNIFORM_CONTRAST: f32 = 0.3;

/// The specular term per region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct RegionTerms {
    /// The term of each region, by its id.
    regions: Vec<SpecularTerm>,
    /// The prior mean of skin.
    prior: SpecularTerm,
    /// The regions of skin, which share one term; the largest region if no skin is named.
    skin: Vec<u8>,
    /// The known reflectance and roughness of every texel, in place of those of its region; see [`super::known`].
    known: [Option<Vec<f32>>; SpecularTerm::ROWS],
}

impl RegionTerms {
    /// The prior mean of skin in every region; `regions` has the region of every texel.
    pub fn prior(reflectance: f32, skin: &[u8], regions: &[u8]) -> Self {
        let mut skin = skin.to_vec();
        if skin.is_empty() {
            let mut counts = [0usize; 256];
            regions.iter().for_each(|region| counts[usize::from(*region)] += 1);
            let largest = (0..=u8::MAX).max_by_key(|region| counts[usize::from(*region)]);
            skin.extend(largest);
        }
        let prior = SpecularTerm::usual(reflectance);
        Self { regions: vec![prior; 256], prior, skin, known: [None, None] }
    }

    /// Replaces the reflectance and the roughness by textures.
    #[must_use]
    pub fn with_known(self, known: [Option<Vec<f32>>; SpecularTerm::ROWS]) -> Self {
        Self { known, ..self }
    }

    /// The specular term of a region.
    pub fn of(&self, region: u8) -> SpecularTerm {
        self.regions[usize::from(region)]
    }

    /// The [`SpecularTerm::channels`] of every texel, by its region.
    pub fn texture(&self, regions: &[u8]) -> Vec<f32> {
        let mut texture: Vec<f32> =
            regions.iter().flat_map(|region| self.of(*region).channels()).collect();
        for (row, known) in self.known.iter().enumerate() {
            let values = texture.iter_mut().skip(row).step_by(SpecularTerm::ROWS);
            values.zip(known.iter().flatten()).for_each(|(value, known)| *value = *known);
        }
        texture
    }

    /// Multiplies the reflectances by a factor: the [peak](crate::transport::Transport::peak) of another light over
    /// that of this one, which preserves the strength of highlights. The prior does not change.
    #[must_use]
    pub fn relative_to(&self, factor: f32) -> Self {
        let scaled =
            |term: &SpecularTerm| SpecularTerm { reflectance: factor * term.reflectance, ..*term };
        Self { regions: self.regions.iter().map(scaled).collect(), ..self.clone() }
    }

    fn of_skin(&self) -> SpecularTerm {
        self.of(self.skin[0])
    }

    /// The most probable error x of the exposure, a factor relative to the convention that the light's peak sets it.
    /// The measured reflectance of skin is its prior mean times x times a factor of the person; both factors have a
    /// prior.
    pub fn exposure_error(&self, config: &ReflectanceConfig) -> f32 {
        if config.exposure_deviation == 0.0 || self.known[0].is_some() {
            return 1.0;
        }
        let observed = self.of_skin().reflectance / self.prior.reflectance;
        let misfit = |log: &f32| {
            let of_person = (observed / log.exp() - 1.0) / config.skin_deviation;
            (log / config.exposure_deviation).powi(2) + of_person.powi(2)
        };
        let logs = (-100..=100).map(|hundredths: i32| 0.01 * hundredths as f32);
        let least = logs.min_by(|a, b| misfit(a).total_cmp(&misfit(b)));
        least.map_or(1.0, f32::exp)
    }

    /// Returns the terms with the posterior reflectances after a regression on the highlights that these terms predict,
    /// on a texture with these `regions`. Measurement and prior are weighted by the inverse variances; a region without
    /// highlights gets the reflectance of skin. In a light of `uniformity` 1, highlights vary only at grazing angles,
    /// where the model is least accurate.
    ///
    /// Outside of skin the posterior ends at `limits`, the factors on the highlights of each region at which they alone
    /// explain its darkest samples: without contrast in the light, only a positive albedo tells dark hair from a mirror.
    #[must_use]
    pub fn with_reflectance(
        &self,
        config: &ReflectanceConfig,
        uniformity: f32,
        regression: &Regression,
        regions: &[u8],
        limits: &[f32; 256],
    ) -> Self {
        let inflation = error_inflation(uniformity);
        self.revised(regression, regions, |measured, prior, region| {
            // In uniform light the slope of skin's highlights is underestimated, so its error is inflated twice. The
            // light was not fitted to highlights of other regions, whose errors are larger in any light.
            let reflectance = match region {
                None => {
                    let error = config.skin_error * inflation * inflation;
                    measured.reflectance(prior, error, 0.0, config.skin_deviation).0
                }
                Some(region) => {
                    let (error, floor) = (config.region_error * inflation, config.region_floor);
                    let posterior =
                        measured.reflectance(prior, error, floor, config.region_deviation);
                    // With contrast highlights are measured, and those predicted in shadows are too strong.
                    let limit = limits[usize::from(region)] / uniformity;
                    match limit.is_finite() {
                        true => {
                            mean_below(f64::from(limit * measured.current.reflectance), posterior)
                        }
                        false => posterior.0,
                    }
                }
            };
            let reflectance = reflectance as f32;
            SpecularTerm { reflectance, ..measured.current }
        })
    }

    /// Returns the terms with the posterior roughness, by the same rules as [`Self::with_reflectance`].
    #[must_use]
    pub fn with_roughness(
        &self,
        config: &RoughnessConfig,
        uniformity: f32,
        regression: &Regression,
        regions: &[u8],
    ) -> Self {
        let error = config.error * error_inflation(uniformity);
        self.revised(regression, regions, |measured, prior, _| {
            let roughness = measured.roughness(prior, error, config.deviation);
            SpecularTerm { roughness, ..measured.current }
        })
    }

    /// Returns the posterior of every term. The prior mean of skin (no region), which has one term, is [`Self::prior`];
    /// that of other regions is the posterior of skin.
    fn revised(
        &self,
        regression: &Regression,
        regions: &[u8],
        revised: impl Fn(Measurement, SpecularTerm, Option<u8>) -> SpecularTerm,
    ) -> Self {
        let measured = |current: SpecularTerm, within: &dyn Fn(u8) -> bool| Measurement {
            current,
            sums: regression.sums(|texel| within(regions[texel]), 0..CHANNELS),
        };
        let is_skin = |region: u8| self.skin.contains(&region);
        let skin = revised(measured(self.of_skin(), &is_skin), self.prior, None);
        let of = |region: u8| match is_skin(region) {
            true => skin,
            false => {
                revised(measured(self.of(region), &|other| other == region), skin, Some(region))
            }
        };
        Self { regions: (0..=u8::MAX).map(of).collect(), ..self.clone() }
    }
}

/// 1 for a light without contrast, near 0 for lamps in the dark.
pub(super) fn uniformity(contrast: f32) -> f32 {
    1.0 / (1.0 + (contrast / HALF_UNIFORM_CONTRAST).powi(2))
}

/// The factor on the errors of measurements from highlights in a light of this uniformity.
fn error_inflation(uniformity: f32) -> f32 {
    (1.0 - uniformity).max(1e-3).recip()
}

/// The regression of a region with its current term.
struct Measurement {
    current: SpecularTerm,
    sums: RegressionSums,
}

impl Measurement {
    /// The posterior mean and standard deviation of the reflectance. The errors of the measurement are those of the
    /// regression, a relative `model_error`, and a `floor` relative to the prior mean. The prior has a relative standard
    /// `deviation`.
    fn reflectance(
        &self,
        prior: SpecularTerm,
        model_error: f32,
        floor: f32,
        deviation: f32,
    ) -> (f64, f64) {
        let prior = f64::from(prior.reflectance);
        if prior == 0.0 {
            return (0.0, 0.0);
        }
        let deviation = f64::from(deviation) * prior;
        let Some((slope, error)) = self.sums.slope() else { return (prior, deviation) };
        let current = f64::from(self.current.reflectance);
        let measured = current * slope.max(0.0);
        let error = (current * error).hypot(f64::from(model_error) * measured);
        let error = error.hypot(f64::from(floor) * prior);
        let both = deviation * error / deviation.hypot(error);
        (posterior((measured, error), (prior, deviation)), both)
    }

    /// The posterior of the roughness, whose logarithm has these errors.
    fn roughness(&self, prior: SpecularTerm, model_error: f32, deviation: f32) -> f32 {
        let Some((step, error)) = self.sums.log_roughness_step() else { return prior.roughness };
        let error = error.hypot(f64::from(model_error));
        let measured =
            f64::from(self.current.roughness.ln()) + step.clamp(-LARGEST_STEP, LARGEST_STEP);
        let prior = f64::from(prior.roughness.ln());
        posterior((measured, error), (prior, f64::from(deviation))).exp() as f32
    }
}

/// Largest step of the logarithm of the roughness, beyond which the linear model does not hold.
const LARGEST_STEP: f64 = 0.3;

/// Intervals of the integral of [`mean_below`].
const INTERVALS: usize = 64;

/// The mean, below a `limit` and above 0, of a normal distribution; its own mean if both are far.
fn mean_below(limit: f64, (mean, deviation): (f64, f64)) -> f64 {
    if limit >= mean + 3.0 * deviation {
        return mean;
    }
    let sums = (0..INTERVALS).fold([0.0; 2], |[density, moment], i| {
        let value = limit * (i as f64 + 0.5) / INTERVALS as f64;
        let at = (-0.5 * ((value - mean) / deviation).powi(2)).exp();
        [density + at, moment + at * value]
    });
    if sums[0] > 0.0 { sums[1] / sums[0] } else { limit }
}

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
    const NO_LIMITS: [f32; 256] = [f32::INFINITY; 256];

    fn everywhere(reflectance: f32) -> RegionTerms {
        RegionTerms::prior(reflectance, &[1], &[])
    }

    /// Terms whose measured reflectance is the prior mean times a factor.
    fn measured(factor: f32) -> RegionTerms {
        let regions = vec![SpecularTerm::usual(factor * SKIN); 256];
        RegionTerms { regions, ..everywhere(SKIN) }
    }

    /// The reflectances of the two halves of a texture whose highlights are the predicted ones times `factors`.
    fn found(factors: [f32; 2]) -> [f32; 2] {
        let (samples, predicted) = scene();
        let texels = samples.taps.size() * samples.taps.size();
        let regions: Vec<u8> = (0..texels).map(|at| 1 + u8::from(2 * at > texels)).collect();
        let factor = |i: usize| factors[usize::from(regions[samples.taps.nearest(i)]) - 1];
        let observed = |i: usize| {
            std::array::from_fn::<f32, CHANNELS, _>(|c| 3.0 + factor(i) * predicted[i][c])
        };
        let rows = |i: usize| [predicted[i], [0.0; CHANNELS]];
        let regression = Regression::new(&samples, &samples.weight, None, rows, observed);
        let config = UnshadeConfig::default().reflectance;
        let all =
            everywhere(SKIN).with_reflectance(&config, 0.0, &regression, &regions, &NO_LIMITS);
        [1, 2].map(|region| all.of(region).reflectance)
    }

    #[test]
    fn stronger_highlights_of_skin_are_partly_exposure() {
        let config = UnshadeConfig::default().reflectance;
        let error = |factor: f32| measured(factor).exposure_error(&config);
        assert_eq!(error(1.0), 1.0);
        // The share of the exposure's variance in both.
        let [own, skin] = [config.exposure_deviation, config.skin_deviation].map(|d| d * d);
        let expected = 1.1_f32.powf(own / (own + skin));
        assert!((error(1.1) - expected).abs() < 0.011, "{}", error(1.1));
        assert_eq!(error(0.0), 1.0);
        let peak = ReflectanceConfig { exposure_deviation: 0.0, ..config.clone() };
        assert_eq!(measured(0.5).exposure_error(&peak), 1.0);
    }

    #[test]
    fn reflectance_lies_between_highlights_and_prior() {
        let [skin, hair] = found([1.3, 0.4]);
        // The model error is 0.1, or 0.3 for hair with a floor of 0.15; the deviation of the prior is 0.5.
        assert!((skin / (1.3 * SKIN) - 1.0).abs() < 0.02, "{skin}");
        let weight = |ratio: f32| 0.25 / (0.25 + 0.15_f32.powi(2) + (0.3 * ratio).powi(2));
        let ratio = 0.4 / 1.3;
        let expected = weight(ratio) * 0.4 + (1.0 - weight(ratio)) * 1.3;
        assert!((hair / (expected * SKIN) - 1.0).abs() < 0.03, "{hair} {expected}");
        // A region without measured highlights keeps a part of the prior, since the light may be slightly wrong.
        let [skin, hair] = found([1.0, -0.5]);
        assert!((skin / SKIN - 1.0).abs() < 1e-4, "{skin}");
        assert!((hair / ((1.0 - weight(0.0)) * SKIN) - 1.0).abs() < 0.1, "{hair}");
    }

    /// Without a measurement, the mean of the prior's part below the limit, by the closed form of a truncated normal.
    #[test]
    fn an_albedo_below_zero_excludes_a_reflectance() {
        let (samples, predicted) = scene();
        let texels = samples.taps.size() * samples.taps.size();
        let rows = |i: usize| [predicted[i], [0.0; CHANNELS]];
        let regression = Regression::new(&samples, &samples.weight, None, rows, |i| predicted[i]);
        let config = UnshadeConfig::default().reflectance;
        let found = |limit: f32| {
            let limits = [limit; 256];
            let regions = vec![1; texels];
            let all =
                everywhere(SKIN).with_reflectance(&config, 1.0, &regression, &regions, &limits);
            assert_eq!(all.of(1).reflectance, all.of_skin().reflectance, "skin has no limit");
            all.of(2).reflectance / all.of(1).reflectance
        };
        assert_eq!(found(10.0), 1.0);
        // Between -2 and 0 standard deviations of 0.5: 1 - 0.5 (phi(0) - phi(-2)) / (Phi(0) - Phi(-2)).
        assert!((found(1.0) - (1.0 - 0.5 * (0.398942 - 0.053991) / (0.5 - 0.022750))).abs() < 2e-3);
        assert!((found(0.01) - 0.005).abs() < 1e-3);
    }

    #[test]
    fn roughness_does_not_depend_on_the_strength_of_highlights() {
        let (samples, predicted) = scene();
        let regions = vec![1; samples.taps.size() * samples.taps.size()];
        let slope = |i: usize| predicted[i].map(|p| (40.0 * p).sin());
        let rows = |i: usize| [predicted[i], slope(i)];
        let observed =
            |i: usize| std::array::from_fn(|c| 3.0 + 1.7 * (predicted[i][c] + 0.2 * slope(i)[c]));
        let regression = Regression::new(&samples, &samples.weight, None, rows, observed);
        let found = |config: &RoughnessConfig, uniformity: f32| {
            let all = everywhere(SKIN).with_roughness(config, uniformity, &regression, &regions);
            assert_eq!(all.of(1).reflectance, SKIN);
            all.of(1).roughness.ln()
        };
        let config = UnshadeConfig::default().roughness;
        let exact = RoughnessConfig { error: 0.0, ..config.clone() };
        assert!((found(&exact, 0.0) - 0.2).abs() < 1e-3, "{}", found(&exact, 0.0));
        // Half of the step, with equal variances of prior and measurement; none in uniform light.
        let uncertain = RoughnessConfig { error: config.deviation, ..config };
        assert!((found(&uncertain, 0.0) - 0.1).abs() < 1e-3, "{}", found(&uncertain, 0.0));
        assert!(found(&uncertain, 1.0).abs() < 1e-3);
    }
}
