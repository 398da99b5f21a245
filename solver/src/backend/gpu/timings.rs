//! Times of passes on the device, by its own clock.

use std::collections::BTreeMap;

/// The times of the dispatches of one name, and their least work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassTime {
    /// Time on the device.
    pub milliseconds: f64,
    /// The number of dispatches.
    pub dispatches: usize,
    /// Floating-point operations, a multiply-add being two.
    pub flops: f64,
    /// Bytes from and to memory, every value read once and written once.
    pub bytes: f64,
}

/// The times of passes by name.
pub type Timings = BTreeMap<&'static str, PassTime>;
