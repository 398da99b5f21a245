//! Errors of configurations.

/// A configuration that cannot be used.
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
    /// A key has another name or no use any more.
    #[error("configuration: {old} {fix}")]
    Renamed {
        /// Dotted key that was given.
        old: String,
        /// What became of it, and the fix.
        fix: String,
    },
    /// A value is out of its range.
    #[error("configuration: {key} is {value}, but must be {range}")]
    Range {
        /// Dotted key.
        key: String,
        /// The value that was given.
        value: String,
        /// The range, in words.
        range: String,
    },
}
