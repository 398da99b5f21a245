//! How much regions of a face mirror, by their highlights: what varies in one place from view to view is
//! hardly diffuse, so the slope of what is shown on what is predicted there is a factor of the reflectance.

use serde::{Deserialize, Serialize};

use super::site::Site;
use super::tint::Regression;
use crate::config::ReflectanceConfig;

/// Reflectance at normal incidence by region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Reflectances {
    /// Of every region's id.
    regions: Vec<f32>,
    /// Reflectance of skin that is expected.
    expected: f32,
    /// The regions that are skin and have one reflectance; if none is named, the largest alone.
    skin: Vec<u8>,
}

impl Reflectances {
    /// What is expected of skin, everywhere; `regions` are those of a texture.
    pub fn expected(site: &Site, regions: &[u8]) -> Self {
        let expected = site.gain * site.config.normalisation.specular_skin;
        let mut skin = site.skin();
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

    /// By what skin is brighter than expected.
    pub fn skin(&self) -> f32 {
        self.regions[usize::from(self.skin[0])] / self.expected
    }

    /// Multiplies all.
    pub fn scale(&mut self, factor: f32) {
        self.regions.iter_mut().for_each(|value| *value *= factor);
    }

    /// Takes in what highlights say that were predicted with these reflectances, on a texture of the
    /// `regions`. Both what is expected and what is said weigh by their variances; a region that says
    /// nothing mirrors like skin.
    pub fn update(&mut self, config: &ReflectanceConfig, regression: &Regression, regions: &[u8]) {
        let posterior = |now: f32, prior: f32, deviation: f32, of: &dyn Fn(u8) -> bool| {
            let Some((slope, error)) = regression.slope(|texel| of(regions[texel])) else {
                return prior;
            };
            let error = error.hypot(f64::from(config.model_error) * slope) * f64::from(now);
            let (said, spread) = (slope * f64::from(now), f64::from(deviation * prior));
            let weight = spread * spread / (spread * spread + error * error);
            (weight * said + (1.0 - weight) * f64::from(prior)).max(0.0) as f32
        };
        let is_skin = |region: u8| self.skin.contains(&region);
        let now = self.regions[usize::from(self.skin[0])];
        let skin = posterior(now, self.expected, config.skin_deviation, &is_skin);
        let of = |region: u8| match is_skin(region) {
            true => skin,
            false => {
                let now = self.regions[usize::from(region)];
                posterior(now, skin, config.region_deviation, &|other| other == region)
            }
        };
        self.regions = (0..=u8::MAX).map(of).collect();
        if std::env::var("DEBUG_G").is_ok() {
            let mut ids: Vec<u8> = regions.to_vec(); ids.sort(); ids.dedup();
            for id in ids { eprintln!("region {id} {:.4} slope {:?}", self.regions[id as usize], regression.slope(|t| regions[t]==id)); }
        }
    }
}
