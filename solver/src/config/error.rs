//! Errors of configurations.

/// An invalid configuration.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// No preset has this name.
    #[error(
        "no configuration is named {0:?}; the presets are unshade, fast, paper and paper-tuned"
    )]
    UnknownPreset(String),
    /// The text is not TOML, has an unknown key, or a value of the wrong type.
    #[error("configuration: {0}")]
    Toml(String),
    /// A key was renamed or removed.
    #[error("configuration: {old} {fix}")]
    Renamed {
        /// The given dotted key.
        old: String,
        /// The reason and the fix.
        fix: String,
    },
    /// A value is out of its range.
    #[error("configuration: {key} is {value}, but must be {range}")]
    Range {
        /// Dotted key.
        key: String,
        /// The given value.
        value: String,
        /// The range, as text.
        range: String,
    },
}
