//! The configurations: every number of a method, with its source. Each preset is a TOML file beside this one, in
//! which every key has a comment that states its meaning and its unit.

mod error;
mod method;
mod paper;
mod ranges;
mod renamed;
mod shared;
mod unshade;

use serde::Serialize;
use toml::{Table, Value};

pub use error::ConfigError;
use method::Method;
pub use paper::*;
pub use shared::*;
pub use unshade::*;

/// The presets and their texts. A text with a `base` states what differs from that preset.
const PRESETS: [(&str, &str); 4] = [
    ("unshade", include_str!("unshade.toml")),
    ("fast", include_str!("fast.toml")),
    ("paper", include_str!("paper.toml")),
    ("paper-tuned", include_str!("paper-tuned.toml")),
];

/// The method of a solve with all of its values.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "base", rename_all = "lowercase")]
pub enum Config {
    /// The default method, with explicit light transport.
    Unshade(UnshadeConfig),
    /// The published method, with shading networks.
    Paper(PaperConfig),
}

impl Config {
    /// A preset: `unshade` (the default), `fast` (the same with fewer steps), `paper` (every published value), or
    /// `paper-tuned` (its unpublished values and its rates chosen).
    pub fn preset(name: &str) -> Result<Self, ConfigError> {
        let (method, table) = preset_table(name)?;
        Self::read(method, table)
    }

    /// Reads a configuration. `base = "paper"` names the preset (default `unshade`) of the values that the text does
    /// not set. Unknown keys, and values outside their ranges, are errors.
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        let mut given: Table = toml::from_str(text).map_err(|error| toml_error(&error))?;
        let base = match given.remove("base") {
            None => "unshade".to_owned(),
            Some(Value::String(name)) => name,
            Some(other) => {
                return Err(ConfigError::Toml(format!("base is {other}, expected a name")));
            }
        };
        let (method, mut table) = preset_table(&base)?;
        renamed::refuse_renamed(method, &given)?;
        overlay(&mut table, given);
        let config = Self::read(method, table)?;
        config.validate()?;
        Ok(config)
    }

    fn read(method: Method, table: Table) -> Result<Self, ConfigError> {
        let config = match method {
            Method::Unshade => table.try_into().map(Self::Unshade),
            Method::Paper => table.try_into().map(Self::Paper),
        };
        config.map_err(|error| toml_error(&error))
    }

    /// The whole configuration as TOML that [`Config::from_toml`] reads back.
    pub fn to_toml(&self) -> String {
        // Serialising plain numbers, booleans and strings below string keys cannot fail.
        toml::to_string(self).unwrap_or_default()
    }

    /// Checks every value against its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        ranges::check(&Table::try_from(self).map_err(|error| toml_error(&error))?)
    }

    /// The seed of all random numbers.
    pub fn seed(&self) -> u64 {
        match self {
            Self::Unshade(config) => config.seed,
            Self::Paper(config) => config.seed,
        }
    }

    /// The seed of the perturbation of the pictures at rounding level; 0: none.
    pub fn rounding_seed(&self) -> u64 {
        match self {
            Self::Unshade(config) => config.rendering.rounding_seed,
            Self::Paper(config) => config.rendering.rounding_seed,
        }
    }

    /// The side of the textures that are solved for.
    pub fn texture_size(&self) -> TextureSize {
        match self {
            Self::Unshade(config) => config.maps.texture_size,
            Self::Paper(config) => config.fine_tuning.texture_size,
        }
    }

    /// The records for the report.
    pub fn records(&self) -> RecordConfig {
        match self {
            Self::Unshade(config) => config.records,
            Self::Paper(config) => config.records,
        }
    }

    /// The same configuration without records for the report.
    #[must_use]
    pub fn without_records(mut self) -> Self {
        let none = RecordConfig { stages: false, layers: false };
        match &mut self {
            Self::Unshade(config) => config.records = none,
            Self::Paper(config) => config.records = none,
        }
        self
    }
}

impl Default for Config {
    fn default() -> Self {
        Self::Unshade(UnshadeConfig::default())
    }
}

/// The method of a preset, and all its values.
fn preset_table(name: &str) -> Result<(Method, Table), ConfigError> {
    let preset = PRESETS.iter().find(|(preset, _)| *preset == name);
    let (_, text) = preset.ok_or_else(|| ConfigError::UnknownPreset(name.to_owned()))?;
    let mut given: Table = toml::from_str(text).map_err(|error| toml_error(&error))?;
    let (method, mut table) = match given.remove("base") {
        Some(Value::String(base)) => preset_table(&base)?,
        _ if name == "paper" => (Method::Paper, Table::new()),
        _ => (Method::Unshade, Table::new()),
    };
    overlay(&mut table, given);
    Ok((method, table))
}

fn toml_error(error: &dyn std::fmt::Display) -> ConfigError {
    let message = error.to_string();
    let lines: Vec<&str> = message.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    ConfigError::Toml(lines.join(" "))
}

/// Merges tables, and replaces all other values by those of `above`.
fn overlay(below: &mut Table, above: Table) {
    for (key, value) in above {
        match (below.get_mut(&key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => overlay(old, new),
            // An integer is accepted where a float is expected.
            (Some(old @ Value::Float(_)), Value::Integer(number)) => {
                *old = Value::Float(number as f64)
            }
            (_, value) => {
                below.insert(key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_overrides_single_values_of_its_base() {
        let text = "base = \"paper\"\nseed = 3\n[fine_tuning]\ntexture_size = 256\nprior = 1\n";
        let mut expected = PaperConfig { seed: 3, ..PaperConfig::default() };
        expected.fine_tuning.texture_size = TextureSize::Side(256);
        expected.fine_tuning.prior = 1.0;
        assert_eq!(Config::from_toml(text).unwrap(), Config::Paper(expected));
        assert_eq!(Config::from_toml("").unwrap(), Config::default());
    }

    #[test]
    fn every_preset_is_valid_and_survives_the_round_trip() {
        for (name, _) in PRESETS {
            let config = Config::preset(name).unwrap();
            config.validate().unwrap();
            assert_eq!(Config::from_toml(&config.to_toml()).unwrap(), config, "{name}");
        }
    }

    #[test]
    fn every_key_of_a_preset_has_a_comment() {
        for (name, text) in PRESETS {
            let lines: Vec<&str> = text.lines().collect();
            for (number, line) in lines.iter().enumerate().filter(|(_, line)| line.contains(" = "))
            {
                let above = number > 0 && lines[number - 1].starts_with('#');
                assert!(line.contains('#') || above, "{name}.toml: {line}");
            }
        }
    }

    #[test]
    fn old_keys_are_refused_with_their_new_names() {
        for (base, old, new) in [
            ("unshade", "height.doubt", "relief.minimum_agreement"),
            ("unshade", "fine_tuning.texture_size", "maps.texture_size"),
            ("unshade", "warm_up.iterations", "base = \"paper\""),
            ("paper", "rendering.f0", "skin.f0"),
            ("paper", "transport.rows", "base = \"unshade\""),
        ] {
            let (table, key) = old.split_once('.').unwrap();
            let text = format!("base = {base:?}\n[{table}]\n{key} = 1");
            let message = Config::from_toml(&text).unwrap_err().to_string();
            assert!(message.contains(table) && message.contains(new), "{message}");
        }
    }

    #[test]
    fn mistakes_are_named() {
        let message = |text: &str| Config::from_toml(text).unwrap_err().to_string();
        let paper = |text: &str| message(&format!("base = \"paper\"\n{text}"));
        assert!(paper("[warm_up]\niteration = 3").contains("iteration"));
        assert!(paper("[warm_up]\niterations = 1.5").contains("iterations"));
        assert!(message("base = \"papper\"").contains("papper"));
        assert!(message("[maps]\ntexture_size = \"big\"").contains("auto"));
        assert!(
            paper("[networks]\nwidth = 10")
                .contains("networks.width is 10, but must be a multiple of 4")
        );
        assert!(paper("[adam]\nbeta1 = 1.0").contains("adam.beta1"));
        assert!(
            message("[albedo]\nrate = -1").contains("albedo.rate is -1, but must be 0 or more")
        );
        assert!(!message("x = [").contains('\n'));
    }
}
