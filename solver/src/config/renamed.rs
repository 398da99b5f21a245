//! Renamed and removed keys.

use toml::{Table, Value};

use super::error::ConfigError;
use super::method::Method;

/// Old and new dotted keys of both methods.
const RENAMED: &[(&str, &str)] =
    &[("rendering.f0", "skin.f0"), ("adam.final_share", "adam.final_decay")];

/// Old and new dotted keys of the default method.
const RENAMED_IN_UNSHADE: &[(&str, &str)] = &[
    ("fine_tuning.texture_size", "maps.texture_size"),
    ("initialisation.skin_labels", "regions.skin_labels"),
    ("colour_regions.texture_size", "regions.texture_size"),
    ("hair_in_skin.enabled", "regions.hair_in_skin"),
    ("normalisation.specular_skin", "skin.reflectance"),
    ("transport.distance", "light.steps"),
    ("transport.distance_rate", "light.rate"),
    ("transport.nearness_rate", "light.nearness_rate"),
    ("transport.light_colour", "light.colour"),
    ("transport.light_colour_softness", "light.colour_softness"),
    ("transport.highlight_samples", "light.samples"),
    ("transport.iterations", "joint.steps"),
    ("transport.highlights", "joint.steps"),
    ("transport.light_rate", "joint.light_rate"),
    ("transport.diffuse_rate", "joint.albedo_rate"),
    ("transport.prior", "joint.prior"),
    ("transport.refinement", "albedo.steps"),
    ("transport.refinement_rate", "albedo.rate"),
    ("transport.refinement_prior", "albedo.prior"),
    ("reflectance.rounds", "light.rounds"),
    ("reflectance.model_error", "reflectance.skin_error"),
    ("reflectance.roughness_rounds", "roughness.rounds"),
    ("reflectance.roughness_samples", "roughness.samples"),
    ("reflectance.roughness_deviation", "roughness.deviation"),
    ("reflectance.roughness_error", "roughness.error"),
    ("model_error.doubt", "model_error.disagreement"),
    ("height.doubt", "relief.minimum_agreement"),
    ("height.diffuse_doubt", "relief.diffuse_share"),
    ("height", "relief"),
];

/// Tables of the published method only.
const OF_PAPER: &[&str] = &[
    "networks",
    "view_weights",
    "initialisation",
    "warm_up",
    "fine_tuning",
    "adam",
    "normalisation",
];
/// Tables of the default method only, of this version and earlier ones.
const OF_UNSHADE: &[&str] = &[
    "regions",
    "transport",
    "light",
    "joint",
    "reflectance",
    "roughness",
    "relief",
    "albedo",
    "model_error",
    "maps",
    "colour_regions",
    "hair_in_skin",
    "height",
];

/// Refuses renamed keys, with their new names, and tables of the other method.
pub(super) fn refuse_renamed(method: Method, given: &Table) -> Result<(), ConfigError> {
    let of_method = if method == Method::Unshade { RENAMED_IN_UNSHADE } else { &[] };
    for (old, new) in RENAMED.iter().chain(of_method) {
        let written = match old.split_once('.') {
            Some((table, key)) => {
                given.get(table).and_then(Value::as_table).is_some_and(|t| t.contains_key(key))
            }
            None => given.contains_key(*old),
        };
        if written {
            let fix = format!("has been renamed; write {new}");
            return Err(ConfigError::Renamed { old: (*old).to_owned(), fix });
        }
    }
    let (foreign, other) = match method {
        Method::Unshade => (OF_PAPER, "paper"),
        Method::Paper => (OF_UNSHADE, "unshade"),
    };
    match given.keys().find(|table| foreign.contains(&table.as_str())) {
        None => Ok(()),
        Some(table) => {
            let fix = format!("belongs to another method; remove it, or write base = {other:?}");
            Err(ConfigError::Renamed { old: format!("[{table}]"), fix })
        }
    }
}
