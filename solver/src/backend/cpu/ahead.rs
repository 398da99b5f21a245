//! Prefetch of the next block's memory during the computation of a block.

use crate::model::planes::{BLOCK, Planes, Row};
use crate::simd::prefetch;

/// Largest number of planes of a pass.
const PLANES: usize = 7;
/// Values in a cache line.
const LINE: usize = 16;
/// Values asked for at a time, two lines: a block of a joint pass has 224 lines and 300 tiles, of the others up
/// to 368 and from 40 to 150.
const PACE: usize = 3 * LINE;

/// Prefetches rows a few lines at a time, between tiles of products: a core has about ten outstanding lines, and
/// further reads would wait for them. It does not change results.
pub struct Ahead<'a> {
    planes: [&'a [Row]; PLANES],
    plane: usize,
    /// The next row and the remaining requests of the current planes.
    next: *const f32,
    left: usize,
}

impl<'a> Ahead<'a> {
    /// The rows of a block, if it exists.
    pub fn new(planes: &[&'a Planes], block: usize) -> Self {
        let mut rows = [[].as_slice(); PLANES];
        for (rows, planes) in rows.iter_mut().zip(planes).filter(|(_, p)| block < p.blocks()) {
            *rows = planes.block(block);
        }
        let mut ahead = Self { planes: rows, plane: 0, next: std::ptr::null(), left: 0 };
        ahead.turn();
        ahead
    }

    /// Prefetches the next lines.
    #[inline(always)]
    pub fn ask(&mut self) {
        if self.left > 0 {
            prefetch(self.next);
            prefetch(self.next.wrapping_add(LINE));
            prefetch(self.next.wrapping_add(2 * LINE));
            self.next = self.next.wrapping_add(PACE);
            self.left -= 1;
            if self.left == 0 {
                self.turn();
            }
        }
    }

    /// Continues with the next planes that have rows.
    #[cold]
    #[inline(never)]
    fn turn(&mut self) {
        while let (0, Some(rows)) = (self.left, self.planes.get(self.plane)) {
            self.plane += 1;
            self.next = rows.as_ptr().cast();
            self.left = (rows.len() * BLOCK).div_ceil(PACE);
        }
    }
}
