//! The part of a picture that matters.

use std::ops::Range;

/// Of every row, one range of columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region(pub Vec<Range<usize>>);

impl Region {
    /// All of a picture.
    pub fn whole(width: usize, height: usize) -> Self {
        Self(vec![0..width; height])
    }

    /// With all that is at most `reach` columns and rows away, in a picture so wide.
    pub fn dilated(&self, reach: usize, width: usize) -> Self {
        let row = |y: usize| {
            let rows = y.saturating_sub(reach)..(y + reach + 1).min(self.0.len());
            match self.columns(rows) {
                near if near.is_empty() => near,
                near => near.start.saturating_sub(reach)..(near.end + reach).min(width),
            }
        };
        Self((0..self.0.len()).map(row).collect())
    }

    /// From the first to the last column that some rows have.
    pub fn columns(&self, rows: Range<usize>) -> Range<usize> {
        let rows = || self.0[rows.clone()].iter().filter(|row| !row.is_empty());
        let first = rows().map(|row| row.start).min().unwrap_or(0);
        first..rows().map(|row| row.end).max().unwrap_or(0)
    }
}

/// Columns of a row.
pub struct Place {
    /// Its number.
    pub row: usize,
    /// Which.
    pub columns: Range<usize>,
}

impl Place {
    /// Where their values lie in the row.
    pub fn within(&self, channels: usize) -> Range<usize> {
        self.columns.start * channels..self.columns.end * channels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dilated_point_is_a_square_inside_the_picture() {
        let mut rows = vec![0..0; 6];
        rows[1] = 3..4;
        let grown = Region(rows).dilated(2, 5);
        assert_eq!(grown.0[..4], [1..5, 1..5, 1..5, 1..5]);
        assert!(grown.0[4..].iter().all(Range::is_empty));
        assert_eq!(grown.columns(2..6), 1..5);
        assert!(grown.columns(4..6).is_empty());
    }
}
