//! The size of the paper's capture.

use super::kind::Kind;

/// Textures of the warm-up.
pub(super) const COARSE: usize = 128;
/// The paper's capture: ten views of 12 million pixels in half resolution, 48 million in full,
/// textures of 2048²; steps of each kind.
pub(super) const PAPER_PIXELS: [usize; 2] = [12_000_000, 48_000_000];
pub(super) const PAPER_TEXTURE: usize = 2048;
pub(super) const PAPER_STEPS: [usize; 3] = [2000, 500, 500];
/// A processor does one pixel of 16, and one of 64; a step's time is linear in them, but for its textures.
pub(super) const PAPER_DIVISORS: [usize; 2] = [16, 64];

/// The size of the paper's capture.
pub(super) struct Paper {
    pub quick: bool,
    /// A processor does one of so many pixels.
    pub divisors: [usize; 2],
}

impl Paper {
    /// Pixels and side of the textures in a kind of step, on one pixel of `divisor`.
    pub fn size(&self, kind: Kind, divisor: usize) -> (usize, usize) {
        let [half, full] = PAPER_PIXELS.map(|pixels| pixels / divisor);
        match kind {
            Kind::WarmUp => (half, COARSE),
            _ => (full, if self.quick { 32 } else { PAPER_TEXTURE }),
        }
    }
}
