//! Memory that is asked for while a block is computed: what the next block will read.

use crate::model::planes::{BLOCK, Planes, Row};
use crate::simd::prefetch;

/// Planes that any pass reads, at most.
const PLANES: usize = 7;
/// Values in a line of the cache.
const LINE: usize = 16;
/// Values asked for at a time, two lines: a block of a joint pass has 224 lines and 300 tiles, of the others up
/// to 368 and from 40 to 150.
const PACE: usize = 3 * LINE;

/// Rows asked for a few lines at a time, between tiles of products: a core waits for some ten lines at most,
/// and whatever it reads besides would have to wait as well. It has no influence on results.
pub struct Ahead<'a> {
    planes: [&'a [Row]; PLANES],
    plane: usize,
    /// The next row to ask for and the requests left, for each of the rows at hand.
    next: *const f32,
    left: usize,
}

impl<'a> Ahead<'a> {
    /// The rows of a block, if there is one.
    pub fn new(planes: &[&'a Planes], block: usize) -> Self {
        let mut rows = [[].as_slice(); PLANES];
        for (rows, planes) in rows.iter_mut().zip(planes).filter(|(_, p)| block < p.blocks()) {
            *rows = planes.block(block);
        }
        let mut ahead = Self { planes: rows, plane: 0, next: std::ptr::null(), left: 0 };
        ahead.turn();
        ahead
    }

    /// Asks for the next lines.
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

    /// Goes on to the next planes that have rows.
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
