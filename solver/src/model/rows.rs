//! Rows of samples that begin at a cache line.

use std::fmt;
use std::mem::MaybeUninit;
use std::ops::{Deref, DerefMut};

/// Samples per block.
pub const BLOCK: usize = 256;

/// One quantity of the samples of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Row(pub [f32; BLOCK]);

impl Row {
    /// All zero.
    pub const ZERO: Self = Self([0.0; BLOCK]);
}

/// The first `R` rows: with their number known, a compiler keeps them apart.
#[inline(always)]
pub fn first_rows<const R: usize>(rows: &[Row]) -> &[Row; R] {
    // Planes are made with the rows that are asked of them.
    rows.first_chunk().unwrap_or_else(|| unreachable!("{} rows instead of {R}", rows.len()))
}

/// The first `R` rows, mutable.
#[inline(always)]
pub fn first_rows_mut<const R: usize>(rows: &mut [Row]) -> &mut [Row; R] {
    rows.first_chunk_mut().unwrap_or_else(|| unreachable!("fewer rows than {R}"))
}

/// A plain allocation with some room to move its beginning in. An allocator that is asked for the
/// alignment instead wants more than it has got back from the same request before, and a step's planes
/// are given back and asked for in every step.
pub struct Rows {
    /// Nothing of it counts as written for the vector.
    room: Vec<f32>,
    count: usize,
}

impl Rows {
    /// Room for `count` rows, which `write` has to write; and its result.
    ///
    /// # Safety
    /// All rows must be written when `write` returns.
    pub unsafe fn new<T>(
        count: usize,
        write: impl FnOnce(&mut [MaybeUninit<Row>]) -> T,
    ) -> (Self, T) {
        let slack = align_of::<Row>() / align_of::<f32>();
        let mut room: Vec<f32> = Vec::with_capacity(count * (size_of::<Row>() / 4) + slack);
        // SAFETY: rows that may not be written yet are made of floats that may not be either.
        let (_, rows, _) = unsafe { room.spare_capacity_mut().align_to_mut() };
        let result = write(&mut rows[..count]);
        (Self { room, count }, result)
    }

    /// Rows of zeros.
    pub fn zeros(count: usize) -> Self {
        let write = |rows: &mut [MaybeUninit<Row>]| {
            rows.iter_mut().for_each(|row| _ = row.write(Row::ZERO));
        };
        // SAFETY: it writes all of them.
        unsafe { Self::new(count, write).0 }
    }

    /// Floats before the first row.
    fn skipped(&self) -> usize {
        self.room.as_ptr().align_offset(align_of::<Row>())
    }
}

impl Deref for Rows {
    type Target = [Row];

    fn deref(&self) -> &[Row] {
        let start = self.room.as_ptr().wrapping_add(self.skipped());
        // SAFETY: `new` had `count` rows written from the first aligned place on.
        unsafe { std::slice::from_raw_parts(start.cast(), self.count) }
    }
}

impl DerefMut for Rows {
    fn deref_mut(&mut self) -> &mut [Row] {
        let start = self.room.as_mut_ptr().wrapping_add(self.skipped());
        // SAFETY: as above, and they are borrowed with `self`.
        unsafe { std::slice::from_raw_parts_mut(start.cast(), self.count) }
    }
}

impl Clone for Rows {
    fn clone(&self) -> Self {
        let write = |rows: &mut [MaybeUninit<Row>]| {
            rows.iter_mut().zip(&**self).for_each(|(row, from)| _ = row.write(*from));
        };
        // SAFETY: there are as many rows to copy.
        unsafe { Self::new(self.count, write).0 }
    }
}

impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Rows {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_aligned_and_copies_are_equal() {
        for count in [0, 1, 5] {
            let mut rows = Rows::zeros(count);
            rows.iter_mut().for_each(|row| row.0[7] = 2.0);
            assert_eq!(rows.len(), count);
            assert!(rows.as_ptr().is_aligned());
            assert_eq!(rows.clone(), rows);
            assert!(count == 0 || rows != Rows::zeros(count));
        }
    }
}
