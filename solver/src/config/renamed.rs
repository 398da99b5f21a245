//! Keys that have other names now.

use toml::{Table, Value};

use super::error::ConfigError;

/// Old and new dotted key.
pub(super) const RENAMED: &[(&str, &str)] =
    &[("rendering.f0", "skin.f0"), ("initialisation.colour_regions", "colour_regions.count")];

/// Refuses what was renamed, with its new name.
pub(super) fn refuse_renamed(given: &Table) -> Result<(), ConfigError> {
    let written = |(old, _): &&(&str, &str)| {
        let (table, key) = old.split_once('.').unwrap_or((old, ""));
        let found = given.get(table).and_then(Value::as_table);
        if key.is_empty() { found.is_some() } else { found.is_some_and(|t| t.contains_key(key)) }
    };
    RENAMED
        .iter()
        .find(written)
        .map_or(Ok(()), |&(old, new)| Err(ConfigError::Renamed { old, new }))
}
