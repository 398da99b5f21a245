//! The size of the paper's capture.

use super::steps::Kind;

/// Textures of the warm-up.
pub(super) const COARSE: usize = 128;
/// The paper's capture: ten views of 12 million pixels in half resolution, 48 million in full,
/// textures of 2048²; steps of each kind.
pub(super) const PAPER_PIXELS: [usize; 2] = [12_000_000, 48_000_000];
pub(super) const PAPER_TEXTURE: usize = 2048;
pub(super) const PAPER_STEPS: [usize; 3] = [2000, 500, 500];
/// A processor does these shares of its pixels; a step's time is linear in them, but for its textures.
pub(super) const PAPER_SHARES: [usize; 2] = [16, 64];

/// The size of the paper's capture.
pub(super) struct Paper {
    pub quick: bool,
    /// One over the shares that a processor does.
    pub shares: [usize; 2],
}

impl Paper {
    /// Pixels and side of the textures in a kind of step, on one pixel of `share`.
    pub fn size(&self, kind: Kind, share: usize) -> (usize, usize) {
        let [half, full] = PAPER_PIXELS.map(|pixels| pixels / share);
        match kind {
            Kind::WarmUp => (half, COARSE),
            _ => (full, if self.quick { 32 } else { PAPER_TEXTURE }),
        }
    }
}
