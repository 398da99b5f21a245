//! Values that several metrics of a pair need, computed on first use.

use std::sync::OnceLock;

/// A value of the prediction and one of the truth.
pub(super) type Both<T> = [Vec<T>; 2];

/// Nothing that is made in here may wait for other threads: one that waits for a value could be handed its making.
#[derive(Debug, Default)]
pub(super) struct Shared {
    pub srgb: OnceLock<Both<f64>>,
    pub srgb_of_region: OnceLock<Both<f64>>,
    pub lab: OnceLock<Both<[f64; 3]>>,
    pub log_luminances: OnceLock<Both<f64>>,
}
