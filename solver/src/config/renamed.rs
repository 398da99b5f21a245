//! Keys that have other names now.

use toml::{Table, Value};

use super::error::ConfigError;

/// Old and new dotted key.
pub(super) const RENAMED: &[(&str, &str)] = &[
    ("rendering.f0", "skin.f0"),
    ("initialisation.colour_regions", "colour_regions.count"),
    ("transport.veil", "transport.specular_floor"),
    ("transport.hold", "transport.albedo_frozen_steps"),
    ("height.texture_share", "height.texture_scale"),
    ("adam.final_share", "adam.final_decay"),
];

/// Refuses what was renamed, with its new name.
pub(super) fn refuse_renamed(given: &Table) -> Result<(), ConfigError> {
    let written = |(old, _): &&(&str, &str)| {
        old.split_once('.').is_some_and(|(table, key)| {
            given.get(table).and_then(Value::as_table).is_some_and(|t| t.contains_key(key))
        })
    };
    RENAMED
        .iter()
        .find(written)
        .map_or(Ok(()), |&(old, new)| Err(ConfigError::Renamed { old, new }))
}
