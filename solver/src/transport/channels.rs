//! The channels of light.

use std::iter::Sum;

/// Colour channels of the light.
pub const CHANNELS: usize = 3;
/// The channel by which errors of a pixel are compared: most of its luminance.
pub(crate) const GREEN: usize = 1;
/// Weights of Rec.709 luminance.
const LUMINANCE: [f32; CHANNELS] = [0.2126, 0.7152, 0.0722];

/// The Rec.709 luminance of R, G, B; products are f32, the sum is of `T`.
pub(crate) fn luminance<T: From<f32> + Sum>(rgb: &[f32]) -> T {
    rgb.iter().zip(LUMINANCE).map(|(value, weight)| T::from(value * weight)).sum()
}
