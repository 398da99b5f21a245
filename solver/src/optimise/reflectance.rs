//! How much regions of a face mirror, by their highlights: what varies in one place from view to view is
//! hardly diffuse, so the slope of what is shown on what is predicted there is a factor of the reflectance.

use serde::{Deserialize, Serialize};

use super::context::SolveContext;
use super::tint::Regression;
use crate::config::ReflectanceConfig;

/// Reflectance at normal incidence by region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Reflectances {
    /// Id of each texel's region.
    regions: Vec<f32>,
    /// Reflectance of skin that is expected.
    expected: f32,
    /// The regions that are skin and have one reflectance; if none is named, the largest alone.
    skin: Vec<u8>,
}

impl Reflectances {
    /// Reflectance expected of skin, everywhere; `regions` are those of a texture.
    pub fn expected(context: &SolveContext, regions: &[u8]) -> Self {
        let expected = context.gain * context.config.normalisation.specular_skin;
        let mut skin = context.skin();
        if skin.is_empty() {
            let mut counts = [0usize; 256];
            regions.iter().for_each(|region| counts[usize::from(*region)] += 1);
            let largest = (0..=u8::MAX).max_by_key(|region| counts[usize::from(*region)]);
            skin.extend(largest);
        }
        Self { regions: vec![expected; 256], expected, skin }
    }

    /// Texel by texel of a texture of these regions.
    pub fn of(&self, regions: &[u8]) -> Vec<f32> {
        regions.iter().map(|region| self.regions[usize::from(*region)]).collect()
    }

    /// By what pictures are brighter than their peak says, as far as skin's highlights tell it: they differ from
    /// the expected ones by the product of that and of skin's reflectance over the expected, and both have a
    /// prior. The most probable.
    pub fn exposure(&self, config: &ReflectanceConfig) -> f32 {
        if config.exposure_deviation == 0.0 {
            return 1.0;
        }
        let shown = self.regions[usize::from(self.skin[0])] / self.expected;
        let misfit = |log: &f32| {
            let of_skin = (shown / log.exp() - 1.0) / config.skin_deviation;
            (log / config.exposure_deviation).powi(2) + of_skin.powi(2)
        };
        let logs = (-100..=100).map(|hundredths: i32| 0.01 * hundredths as f32);
        let least = logs.min_by(|a, b| misfit(a).total_cmp(&misfit(b)));
        least.map_or(1.0, f32::exp)
    }

    /// Multiplies all.
    pub fn scale(&mut self, factor: f32) {
        self.regions.iter_mut().for_each(|value| *value *= factor);
    }

    /// Takes in what highlights say that were predicted with these reflectances, on a texture of the
    /// `regions`. Both what is expected and what is said weigh by their variances; a region that says
    /// nothing mirrors like skin. Under an even light (`evenness` up to 1) highlights vary at grazing angles
    /// alone, where normals and visibility err most, and say little.
    pub fn update(
        &mut self,
        config: &ReflectanceConfig,
        evenness: f32,
        regression: &Regression,
        regions: &[u8],
    ) {
        // Skin, which has the stronger prior, is believed less.
        let doubt = (1.0 - evenness).max(1e-3).recip();
        let said = |now: f32, power: f32, doubt: f32, of: &dyn Fn(u8) -> bool| {
            let model_error = config.model_error * doubt;
            let (slope, error) = regression.slope(|texel| of(regions[texel]))?;
            let now = f64::from(now);
            let error = error.hypot(f64::from(model_error) * slope);
            Some((now * slope.max(0.0).powf(f64::from(power)), now * error))
        };
        let posterior = |said: Option<(f64, f64)>, prior: f32, deviation: f32| {
            let Some((said, error)) = said else { return prior };
            let (prior, spread) = (f64::from(prior), f64::from(deviation * prior));
            let weight = spread * spread / (spread * spread + error * error);
            (weight * said + (1.0 - weight) * prior) as f32
        };
        let is_skin = |region: u8| self.skin.contains(&region);
        let said_of_skin = said(
            self.regions[usize::from(self.skin[0])],
            config.relaxation,
            doubt * doubt,
            &is_skin,
        );
        let skin = posterior(said_of_skin, self.expected, config.skin_deviation);
        let of = |region: u8| {
            if is_skin(region) {
                return skin;
            }
            let now = self.regions[usize::from(region)];
            let said = said(now, 1.0, doubt, &|other| other == region);
            posterior(said, skin, config.region_deviation)
        };
        self.regions = (0..=u8::MAX).map(of).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::optimise::tint::tests::scene;
    use crate::transport::CHANNELS;

    const SKIN: f32 = 0.028;

    /// Reflectances found of two halves of a texture whose highlights are `factors` of the predicted ones.
    fn found(factors: [f32; 2]) -> [f32; 2] {
        let (samples, predicted) = scene();
        let texels = samples.taps.size() * samples.taps.size();
        let regions: Vec<u8> = (0..texels).map(|at| 1 + u8::from(2 * at > texels)).collect();
        let factor = |i: usize| factors[usize::from(regions[samples.taps.nearest(i)]) - 1];
        let shown = |i: usize| {
            std::array::from_fn::<f32, CHANNELS, _>(|c| 3.0 + factor(i) * predicted[i][c])
        };
        let regression = Regression::new(&samples, &samples.weight, &predicted, shown);
        let mut all = Reflectances { regions: vec![SKIN; 256], expected: SKIN, skin: vec![1] };
        let config = ReflectanceConfig { relaxation: 1.0, ..Config::default().reflectance };
        all.update(&config, 0.0, &regression, &regions);
        all.of(&[1, 2]).try_into().unwrap()
    }

    #[test]
    fn skin_that_mirrors_little_more_is_partly_another_exposure_and_skin_that_mirrors_nothing_is_not()
     {
        let config = Config::default().reflectance;
        let exposure = |factor: f32| {
            let regions = vec![factor * SKIN; 256];
            Reflectances { regions, expected: SKIN, skin: vec![1] }.exposure(&config)
        };
        assert_eq!(exposure(1.0), 1.0);
        // The share of the exposure's variance in both.
        let [own, skin] = [config.exposure_deviation, config.skin_deviation].map(|d| d * d);
        let expected = 1.1_f32.powf(own / (own + skin));
        assert!((exposure(1.1) - expected).abs() < 0.011, "{}", exposure(1.1));
        assert_eq!(exposure(0.0), 1.0);
        assert_eq!(
            Reflectances { regions: vec![0.5 * SKIN; 256], expected: SKIN, skin: vec![1] }
                .exposure(&ReflectanceConfig { exposure_deviation: 0.0, ..config.clone() }),
            1.0
        );
    }

    #[test]
    fn regions_mirror_what_their_highlights_show_but_for_what_is_expected() {
        let [skin, hair] = found([1.3, 0.4]);
        // A tenth of error of the model against half of deviation.
        assert!((skin / (1.3 * SKIN) - 1.0).abs() < 0.02, "{skin}");
        assert!((hair / (0.4 * SKIN) - 1.0).abs() < 0.1, "{hair}");
        let [skin, hair] = found([1.0, -0.5]);
        assert!((skin / SKIN - 1.0).abs() < 1e-4, "{skin}");
        assert!((0.0..0.1 * SKIN).contains(&hair), "{hair}");
    }
}
