//! Backends that cannot be had.

/// Names the adapter to take, by a part of its name: the only way to a software adapter.
pub const VARIABLE: &str = "UNSHADE_ADAPTER";

/// A backend that cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum BackendError {
    /// There are no real GPUs.
    #[error(
        "no GPU was found ({}); install its Vulkan driver, or take the backend cpu or auto",
        listed(there)
    )]
    NoGpu {
        /// Adapters that there are.
        there: Vec<String>,
    },
    /// The environment names an adapter that is not there.
    #[error(
        "no adapter is called {named:?} ({}); correct {VARIABLE} or take it away",
        listed(there)
    )]
    NotThere {
        /// The name that was asked for.
        named: String,
        /// Adapters that there are.
        there: Vec<String>,
    },
    /// The adapter gives no device.
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
