//! Ranges of the values.

use super::error::ConfigError;
use super::{
    ColourRegionConfig, HairInSkinConfig, HeightConfig, ModelErrorConfig, ReflectanceConfig,
    SkinConfig, TransportConfig,
};

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

impl SkinConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        let open = |x: f32| x > 0.0 && x < 1.0;
        range("skin.f0", self.f0, open, "above 0, below 1")?;
        self.lobes().into_iter().try_for_each(|(roughness, weight)| {
            range("skin.roughness", roughness, |x| x > 0.0 && x <= 1.0, "above 0, to 1")?;
            range("skin.weights", weight, |x| (0.0..=1.0).contains(&x), "0 to 1")
        })
    }
}

impl ReflectanceConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        range("reflectance.rounds", self.rounds, |x| x <= 20, "0 to 20")?;
        let deviation = |x: f32| (1e-3..=10.0).contains(&x);
        let wide = "0.001 to 10";
        range("reflectance.skin_deviation", self.skin_deviation, deviation, wide)?;
        range("reflectance.region_deviation", self.region_deviation, deviation, wide)?;
        let error = |x: f32| (0.0..=1.0).contains(&x);
        range("reflectance.model_error", self.model_error, error, "0 to 1")?;
        range("reflectance.region_error", self.region_error, error, "0 to 1")?;
        range("reflectance.region_floor", self.region_floor, error, "0 to 1")?;
        range("reflectance.roughness_rounds", self.roughness_rounds, |x| x <= 20, "0 to 20")?;
        let exponent = |x: i32| (1..=4096).contains(&x);
        let of_light = self.roughness_light_exponent;
        range("reflectance.roughness_light_exponent", of_light, exponent, "1 to 4096")?;
        let roughness = |x: f32| (0.0..=3.0).contains(&x);
        range("reflectance.roughness_deviation", self.roughness_deviation, roughness, "0 to 3")?;
        range("reflectance.roughness_error", self.roughness_error, roughness, "0 to 3")?;
        range("reflectance.roughness_samples", self.roughness_samples, |x| x > 0, "at least 1")?;
        range("reflectance.exposure_deviation", self.exposure_deviation, error, "0 to 1")
    }
}

impl ColourRegionConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        range("colour_regions.count", self.count, |x| x <= 64, "0 to 64")?;
        let side = |x: usize| (16..=512).contains(&x);
        range("colour_regions.texture_size", self.texture_size, side, "16 to 512")?;
        // The time of the normal equations grows with the fourth power.
        range("colour_regions.rows", self.rows, |x| (2..=16).contains(&x), "2 to 16")?;
        // The light is solved for after each joining of two parts that are no specks.
        let many = |x: usize| (1..=20).contains(&x);
        range("colour_regions.reweightings", self.reweightings, many, "1 to 20")?;
        range("colour_regions.edge_pairs", self.edge_pairs, |x| x >= 4, "at least 4")?;
        let distance = |x: usize| x > 0 && x < self.texture_size;
        let within = "1 to below texture_size";
        range("colour_regions.edge_distance", self.edge_distance, distance, within)?;
        positive(&[
            ("colour_regions.dark", self.dark),
            ("colour_regions.residual_floor", self.residual_floor),
            ("colour_regions.shading_floor", self.shading_floor),
            ("colour_regions.shading_prior", self.shading_prior),
        ])?;
        not_negative(&[
            ("colour_regions.blur", self.blur),
            ("colour_regions.luminance_weights", self.luminance_weights[0]),
            ("colour_regions.luminance_weights", self.luminance_weights[1]),
            ("colour_regions.edge", self.edge),
        ])
    }
}

impl HairInSkinConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        let share = |x: f32| (0.0..=1.0).contains(&x);
        range(
            "hair_in_skin.lobe_width",
            self.lobe_width,
            |x| x > 0.0 && x < 7.0,
            "above 0 and below 7",
        )?;
        range("hair_in_skin.lit", self.lit, share, "0 to 1")?;
        // Every part larger than that is tried.
        let least = |x: f32| (0.005..=1.0).contains(&x);
        range("hair_in_skin.least_share", self.least_share, least, "0.005 to 1")?;
        for left in self.most_left {
            range("hair_in_skin.most_left", left, share, "0 to 1")?;
        }
        not_negative(&[
            ("hair_in_skin.blur", self.blur),
            ("hair_in_skin.least_blue", self.least_blue),
        ])?;
        // Nearer ones could be inside of the head.
        for nearness in self.lamp_nearness {
            let far = |x: f32| (0.0..=3.0).contains(&x);
            range("hair_in_skin.lamp_nearness", nearness, far, "0 to 3")?;
        }
        positive(&[("hair_in_skin.prior", self.prior)])?;
        positive(&self.depths.map(|depth| ("hair_in_skin.depths", depth)))
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
        range("transport.highlight_samples", self.highlight_samples, |x| x > 0, "1 or more")?;
        let exponent = |x: i32| (1..=4096).contains(&x);
        range("transport.light_exponent", self.light_exponent, exponent, "1 to 4096")?;
        let ratio = |x: f64| x >= 1.0 && x.is_finite();
        range("transport.tint_range", self.tint_range, ratio, "1 or more")?;
        let error = |x: f64| x >= 0.0 && x.is_finite();
        range("transport.tint_error", self.tint_error, error, "zero or positive")?;
        let outside = |x: f32| x >= 1.0 && x.is_finite();
        range("transport.near_radius", self.near_radius, outside, "1 or more")?;
        range("transport.minimum_radius", self.minimum_radius, outside, "1 or more")?;
        positive(&[
            ("transport.even_contrast", self.even_contrast),
            ("transport.confidence_misfit", self.confidence_misfit),
            ("transport.light_colour_softness", self.light_colour_softness),
        ])?;
        not_negative(&[
            ("transport.ray_offset", self.ray_offset),
            ("transport.specular_floor_blur", self.specular_floor_blur),
            ("transport.confidence_blur", self.confidence_blur),
            ("transport.prior", self.prior),
            ("transport.grey_mean", self.grey_mean),
            ("transport.grey_texel", self.grey_texel),
            ("transport.light_rate", self.light_rate),
            ("transport.distance_rate", self.distance_rate),
            ("transport.nearness_rate", self.nearness_rate),
            ("transport.diffuse_rate", self.diffuse_rate),
            ("transport.specular_rate", self.specular_rate),
            ("transport.network_rate", self.network_rate),
            ("transport.refinement_reach", self.refinement_reach),
            ("transport.refinement_prior", self.refinement_prior),
            ("transport.refinement_rate", self.refinement_rate),
            ("transport.light_colour", self.light_colour),
        ])
    }
}

impl ModelErrorConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        not_negative(&[
            ("model_error.shading", self.shading),
            ("model_error.normal", self.normal),
            ("model_error.highlights", self.highlights),
            ("model_error.shadow", self.shadow),
            ("model_error.doubt", self.doubt),
        ])?;
        let albedo = |x: f32| x > 0.0 && x <= 1.0;
        range("model_error.darkest_albedo", self.darkest_albedo, albedo, "above 0, to 1")
    }
}

impl HeightConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        let share = |x: f32| x > 0.0 && x <= 1.0;
        range("height.texture_scale", self.texture_scale, share, "above 0, to 1")?;
        let rounds = |x: usize| (1..=8).contains(&x);
        range("height.linearisations", self.linearisations, rounds, "1 to 8")?;
        positive(&[
            ("height.residual_floor", self.residual_floor),
            ("height.steepest", self.steepest),
            ("height.darkest_albedo", self.darkest_albedo),
            ("height.minimum_contrast", self.minimum_contrast),
        ])?;
        let tolerance = |x: f64| (0.0..1.0).contains(&x);
        range("height.tolerance", self.tolerance, tolerance, "at least 0 and below 1")?;
        let narrow = |x: f32| (0.0..=0.1).contains(&x);
        range("height.albedo_smoothing", self.albedo_smoothing, narrow, "0 to 0.1")?;
        range("height.blur", self.blur, narrow, "0 to 0.1")?;
        let within = |x: f32| (0.0..=1.0).contains(&x);
        range("height.coarsest", self.coarsest, within, "0 to 1")?;
        range("height.diffuse_doubt", self.diffuse_doubt, within, "0 to 1")?;
        let below = |x: f32| (0.0..1.0).contains(&x);
        range("height.doubt", self.doubt, below, "at least 0 and below 1")?;
        range("height.rim", self.rim, |x: usize| x <= 16, "0 to 16")?;
        not_negative(&[
            ("height.usual_deviation", self.usual_deviation),
            ("height.usual_albedo_detail", self.usual_albedo_detail),
            ("height.neighbourhood", self.neighbourhood),
            ("height.unseen_damping", self.unseen_damping),
            ("height.flatness", self.flatness),
            ("height.smoothness", self.smoothness),
            ("height.albedo_damping", self.albedo_damping),
        ])
    }
}

pub(super) fn positive(values: &[(&'static str, f32)]) -> Result<(), ConfigError> {
    values
        .iter()
        .try_for_each(|(key, value)| range(key, *value, |x| x > 0.0 && x.is_finite(), "positive"))
}

pub(super) fn not_negative(values: &[(&'static str, f32)]) -> Result<(), ConfigError> {
    values.iter().try_for_each(|(key, value)| {
        range(key, *value, |x| x >= 0.0 && x.is_finite(), "zero or positive")
    })
}
