//! Times of passes on the device, by its own clock.

use std::collections::BTreeMap;

/// Times of the dispatches of one name, and the work that they cannot do without.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassTime {
    /// On the device.
    pub milliseconds: f64,
    /// How many there were.
    pub dispatches: usize,
    /// Floating-point operations, a multiply-add being two.
    pub flops: f64,
    /// From and to memory, every value read once and written once.
    pub bytes: f64,
}

/// By the name of the pass.
pub type Timings = BTreeMap<&'static str, PassTime>;
