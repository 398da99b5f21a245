//! Errors of configurations.

/// A configuration that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// No preset has this name.
    #[error(
        "no configuration is named {0:?}; the named ones are paper, paper-tuned, unshade and fast"
    )]
    UnknownPreset(String),
    /// The text is not TOML, has an unknown key, or a value of the wrong type.
    #[error("configuration: {0}")]
    Toml(String),
    /// A key has another name now.
    #[error("configuration: {old} has been renamed; write {new}")]
    Renamed {
        /// Dotted key that was given.
        old: &'static str,
        /// Its name now.
        new: &'static str,
    },
    /// A value is out of its range.
    #[error("configuration: {key} is {value}, but must be {range}")]
    Range {
        /// Dotted key.
        key: &'static str,
        /// The value that was given.
        value: String,
        /// The range, in words.
        range: &'static str,
    },
}
