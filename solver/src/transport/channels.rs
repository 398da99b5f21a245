//! The channels of light.

/// Colour channels of the light.
pub const CHANNELS: usize = 3;
/// Rec.709.
pub(crate) const LUMINANCE: [f32; CHANNELS] = [0.2126, 0.7152, 0.0722];
