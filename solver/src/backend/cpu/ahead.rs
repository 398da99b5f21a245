//! Memory that is asked for while a block is computed: what the next block will read.

use crate::model::planes::{BLOCK, Planes, Row};
use crate::simd::prefetch;

/// Values in a line of the cache.
const LINE: usize = 16;
/// Planes that any pass reads, at most.
const PLANES: usize = 7;
/// Lines asked for at a time: a block of a joint pass has 224 and 300 tiles, of the others up to 368 and
/// from 40 to 150.
const PACE: usize = 2;

/// Rows asked for a few lines at a time, between tiles of products: a core waits for some ten lines at most,
/// and whatever it reads besides would have to wait as well. It has no influence on results.
pub struct Ahead<'a> {
    planes: [&'a [Row]; PLANES],
    plane: usize,
    line: usize,
}

impl<'a> Ahead<'a> {
    /// Of a block, if there is one.
    pub fn new(planes: &[&'a Planes], block: usize) -> Self {
        let mut rows = [[].as_slice(); PLANES];
        for (rows, planes) in rows.iter_mut().zip(planes).filter(|(_, p)| block < p.blocks()) {
            *rows = planes.block(block);
        }
        Self { planes: rows, plane: 0, line: 0 }
    }

    /// Asks for the next lines.
    #[inline(always)]
    pub fn ask(&mut self) {
        for _ in 0..PACE {
            let Some(rows) = self.planes.get(self.plane) else { return };
            match rows.get(self.line * LINE / BLOCK) {
                Some(row) => {
                    prefetch(&row.0, self.line * LINE % BLOCK);
                    self.line += 1;
                }
                None => (self.plane, self.line) = (self.plane + 1, 0),
            }
        }
    }
}
