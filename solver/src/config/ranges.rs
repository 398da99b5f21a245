//! Ranges of the values.

use super::error::ConfigError;
use super::{HeightConfig, TransportConfig};

/// Refuses a value outside its range, which `range` states in words.
pub(super) fn range<T: ToString + Copy>(
    key: &'static str,
    value: T,
    allowed: impl Fn(T) -> bool,
    range: &'static str,
) -> Result<(), ConfigError> {
    if allowed(value) {
        Ok(())
    } else {
        Err(ConfigError::Range { key, value: value.to_string(), range })
    }
}

impl TransportConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        let side = |x: usize| (16..=512).contains(&x);
        range("transport.texture_size", self.texture_size, side, "16 to 512")?;
        range("transport.rows", self.rows, |x| (2..=64).contains(&x), "2 to 64")?;
        let rays = self.rays_per_cell_side;
        range("transport.rays_per_cell_side", rays, |x| (1..=16).contains(&x), "1 to 16")?;
        range("transport.bounces", self.bounces, |x| x <= 64, "0 to 64")?;
        let share = |x: f32| (0.0..=1.0).contains(&x);
        range("transport.bounce_albedo", self.bounce_albedo, share, "0 to 1")?;
        not_negative(&[
            ("transport.prior", self.prior),
            ("transport.grey_mean", self.grey_mean),
            ("transport.grey_texel", self.grey_texel),
            ("transport.light_rate", self.light_rate),
            ("transport.nearness_rate", self.nearness_rate),
            ("transport.diffuse_rate", self.diffuse_rate),
            ("transport.specular_rate", self.specular_rate),
            ("transport.network_rate", self.network_rate),
            ("transport.refinement_prior", self.refinement_prior),
        ])
    }
}

impl HeightConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        let share = |x: f32| x > 0.0 && x <= 1.0;
        range("height.texture_share", self.texture_share, share, "above 0, to 1")?;
        let rounds = |x: usize| (1..=8).contains(&x);
        range("height.linearisations", self.linearisations, rounds, "1 to 8")?;
        let floor = |x: f32| x > 0.0 && x.is_finite();
        range("height.residual_floor", self.residual_floor, floor, "positive")?;
        let narrow = |x: f32| (0.0..=0.1).contains(&x);
        range("height.albedo_smoothing", self.albedo_smoothing, narrow, "0 to 0.1")?;
        range("height.blur", self.blur, narrow, "0 to 0.1")?;
        let within = |x: f32| (0.0..=1.0).contains(&x);
        range("height.coarsest", self.coarsest, within, "0 to 1")?;
        range("height.diffuse_doubt", self.diffuse_doubt, within, "0 to 1")?;
        range("height.rim", self.rim, |x: usize| x <= 16, "0 to 16")?;
        not_negative(&[
            ("height.flatness", self.flatness),
            ("height.smoothness", self.smoothness),
            ("height.albedo_damping", self.albedo_damping),
        ])
    }
}

fn not_negative(values: &[(&'static str, f32)]) -> Result<(), ConfigError> {
    values.iter().try_for_each(|(key, value)| {
        range(key, *value, |x| x >= 0.0 && x.is_finite(), "zero or positive")
    })
}
