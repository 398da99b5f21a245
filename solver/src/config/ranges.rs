//! Ranges of the values. A number without a line here must be 0 or more.

use toml::{Table, Value};

use super::error::ConfigError;

/// The range of a number.
enum Range {
    /// Between the two numbers, both included.
    Within(f64, f64),
    /// Above the first number, up to the second.
    Above(f64, f64),
    /// At least 0 and below 1.
    BelowOne,
    /// A multiple of 4 up to 64.
    BlocksOfFour,
}
use Range::{Above, BelowOne, BlocksOfFour, Within};

const INFINITY: f64 = f64::INFINITY;
const SIDE: Range = Within(16.0, 8192.0);

const RANGES: &[(&str, Range)] = &[
    ("networks.width", BlocksOfFour),
    ("networks.outputs", BlocksOfFour),
    ("networks.hidden_layers", Within(1.0, 8.0)),
    ("networks.position_scale", Above(0.0, INFINITY)),
    ("networks.normal_scale", Above(0.0, INFINITY)),
    ("networks.reflection_scale", Above(0.0, INFINITY)),
    ("skin.f0", Above(0.0, 0.999)),
    ("skin.roughness", Above(0.0, 1.0)),
    ("skin.weights", Within(0.0, 1.0)),
    ("skin.reflectance", Above(0.0, 0.999)),
    ("view_weights.edge_slope", Above(0.0, INFINITY)),
    ("initialisation.specular_maximum", Above(0.0, INFINITY)),
    ("warm_up.texture_size", SIDE),
    ("fine_tuning.texture_size", SIDE),
    ("fine_tuning.deviation_range", Above(0.0, INFINITY)),
    ("fine_tuning.deviation_smoothing", Within(0.0, 0.1)),
    ("fine_tuning.deviation_extent", Within(0.0, 0.1)),
    ("fine_tuning.deviation_blur", Within(0.0, 0.1)),
    ("adam.beta1", BelowOne),
    ("adam.beta2", BelowOne),
    ("adam.epsilon", Above(0.0, INFINITY)),
    ("adam.final_decay", Above(0.0, 1.0)),
    ("normalisation.diffuse_percentile", Above(0.0, 100.0)),
    ("normalisation.specular_percentile", Above(0.0, 100.0)),
    ("normalisation.specular_maximum", Above(0.0, INFINITY)),
    ("regions.texture_size", Within(16.0, 512.0)),
    ("transport.texture_size", Within(16.0, 512.0)),
    ("transport.rows", Within(2.0, 64.0)),
    ("transport.rays_per_cell_side", Within(1.0, 16.0)),
    ("transport.bounces", Within(0.0, 64.0)),
    ("transport.bounce_albedo", Within(0.0, 1.0)),
    ("light.rounds", Within(1.0, 20.0)),
    ("light.colour_softness", Above(0.0, INFINITY)),
    ("light.samples", Within(1.0, INFINITY)),
    ("reflectance.skin_deviation", Within(1e-3, 10.0)),
    ("reflectance.region_deviation", Within(1e-3, 10.0)),
    ("reflectance.skin_error", Within(0.0, 1.0)),
    ("reflectance.region_error", Within(0.0, 1.0)),
    ("reflectance.region_floor", Within(0.0, 1.0)),
    ("reflectance.exposure_deviation", Within(0.0, 1.0)),
    ("roughness.rounds", Within(0.0, 20.0)),
    ("roughness.samples", Within(1.0, INFINITY)),
    ("roughness.deviation", Within(0.0, 3.0)),
    ("roughness.error", Within(0.0, 3.0)),
    ("relief.texture_scale", Above(0.0, 1.0)),
    ("relief.linearisations", Within(1.0, 8.0)),
    ("relief.diffuse_share", Within(0.0, 1.0)),
    ("relief.minimum_agreement", BelowOne),
    ("model_error.shadow", Above(0.0, INFINITY)),
    ("maps.texture_size", SIDE),
];

impl Range {
    fn holds(&self, x: f64) -> bool {
        match *self {
            Within(low, high) => (low..=high).contains(&x) && x.is_finite(),
            Above(low, high) => x > low && x <= high && x.is_finite(),
            BelowOne => (0.0..1.0).contains(&x),
            BlocksOfFour => x > 0.0 && x <= 64.0 && x % 4.0 == 0.0,
        }
    }

    fn words(&self) -> String {
        match *self {
            Within(low, INFINITY) => format!("{low} or more"),
            Within(low, high) => format!("{low} to {high}"),
            Above(low, INFINITY) => format!("above {low}"),
            Above(low, high) => format!("above {low}, to {high}"),
            BelowOne => "at least 0 and below 1".to_owned(),
            BlocksOfFour => "a multiple of 4 up to 64".to_owned(),
        }
    }
}

/// Refuses the first value of a configuration that is outside its range.
pub(super) fn check(config: &Table) -> Result<(), ConfigError> {
    config.iter().try_for_each(|(key, value)| check_value(key, value))
}

fn check_value(key: &str, value: &Value) -> Result<(), ConfigError> {
    let number = match value {
        Value::Table(table) => {
            return table
                .iter()
                .try_for_each(|(inner, value)| check_value(&format!("{key}.{inner}"), value));
        }
        Value::Array(values) => return values.iter().try_for_each(|value| check_value(key, value)),
        Value::Integer(number) => *number as f64,
        Value::Float(number) => *number,
        _ => return Ok(()),
    };
    let listed = RANGES.iter().find(|(name, _)| *name == key);
    let range = listed.map_or(&Within(0.0, INFINITY), |(_, range)| range);
    if range.holds(number) {
        return Ok(());
    }
    Err(ConfigError::Range { key: key.to_owned(), value: number.to_string(), range: range.words() })
}
