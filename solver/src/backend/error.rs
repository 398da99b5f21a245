//! Errors of opening a backend.

/// The environment variable with a part of the adapter's name; required for a software adapter.
pub const VARIABLE: &str = "UNSHADE_ADAPTER";

/// A backend cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum BackendError {
    /// No hardware GPU was found.
    #[error(
        "no GPU was found ({}); install its Vulkan driver, or take the backend cpu or auto",
        listed(there)
    )]
    NoGpu {
        /// The existing adapters.
        there: Vec<String>,
    },
    /// The environment names an adapter that does not exist.
    #[error(
        "no adapter is called {named:?} ({}); correct {VARIABLE} or take it away",
        listed(there)
    )]
    NotThere {
        /// The requested name.
        named: String,
        /// The existing adapters.
        there: Vec<String>,
    },
    /// The adapter cannot open a device.
    #[error("{name} cannot be used: {reason}; take the backend cpu")]
    Refused {
        /// The adapter.
        name: String,
        /// The driver's message.
        reason: String,
    },
    /// No such backend.
    #[error("no backend is named {0:?}; there are auto, cpu and gpu")]
    Unknown(String),
}

fn listed(adapters: &[String]) -> String {
    if adapters.is_empty() { "no adapter at all".to_owned() } else { adapters.join(", ") }
}
