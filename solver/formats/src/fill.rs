//! Filling the unknown part of a map from the nearest known texel.

use rayon::prelude::*;

use crate::picture::Picture;

/// Row of a column without any known texel.
const NONE: u32 = u32::MAX;

/// For every texel the index (row * width + column) of the nearest known one by Euclidean
/// distance; its own if it is known, or if none is.
///
/// Exact, in linear time: nearest row per column, then the lower envelope of the columns' parabolas
/// per row (Felzenszwalb and Huttenlocher 2012).
pub fn nearest_known(known: &[bool], width: usize, height: usize) -> Vec<u32> {
    let rows = nearest_row(known, width, height);
    let mut nearest: Vec<u32> = (0..(width * height) as u32).collect();
    nearest.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, line)| {
        let column = &rows[y * width..][..width];
        // Parabola of each column with a known texel: (column, squared distance in the column).
        let mut envelope: Vec<(usize, f64)> = Vec::with_capacity(width);
        // Where the parabola begins to be the lowest.
        let mut begins: Vec<f64> = Vec::with_capacity(width);
        for (x, row) in column.iter().enumerate().filter(|(_, row)| **row != NONE) {
            let height = (f64::from(*row) - y as f64).powi(2);
            let meets = |(other, low): (usize, f64)| {
                let (x, other) = (x as f64, other as f64);
                (height + x * x - low - other * other) / (2.0 * (x - other))
            };
            while let (Some(last), Some(begin)) = (envelope.last(), begins.last()) {
                if meets(*last) > *begin {
                    break;
                }
                envelope.pop();
                begins.pop();
            }
            begins.push(envelope.last().map_or(f64::NEG_INFINITY, |last| meets(*last)));
            envelope.push((x, height));
        }
        let mut current = 0;
        for (x, index) in line.iter_mut().enumerate() {
            while begins.get(current + 1).is_some_and(|begin| *begin < x as f64) {
                current += 1;
            }
            if let Some((source, _)) = envelope.get(current) {
                *index = column[*source] * width as u32 + *source as u32;
            }
        }
    });
    nearest
}

/// Per texel the row of the nearest known texel in its column, the upper one in a tie.
fn nearest_row(known: &[bool], width: usize, height: usize) -> Vec<u32> {
    let mut above = vec![NONE; width * height];
    for index in 0..width * height {
        above[index] = match index.checked_sub(width) {
            _ if known[index] => (index / width) as u32,
            Some(up) => above[up],
            None => NONE,
        };
    }
    let mut below = vec![NONE; width];
    for (y, line) in above.chunks_mut(width.max(1)).enumerate().rev() {
        let y = y as u32;
        for (row, below) in line.iter_mut().zip(&mut below) {
            if *row == y {
                *below = y;
            } else if *row == NONE || (*below != NONE && *below - y < y - *row) {
                *row = *below;
            }
        }
    }
    above
}

/// Copies into every unknown texel the values of the nearest known one; nothing changes if none
/// is known.
pub fn fill_from_nearest(picture: &mut Picture, known: &[bool]) {
    let nearest = nearest_known(known, picture.width, picture.height);
    let channels = picture.channels;
    for (index, source) in nearest.into_iter().enumerate() {
        let start = source as usize * channels;
        picture.data.copy_within(start..start + channels, index * channels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_is_as_near_as_a_search_over_all_finds() {
        let (width, height) = (23, 17);
        // A few texels, scattered by a multiplicative generator; whole columns stay empty.
        let mut state = 7_u32;
        let mut known = vec![false; width * height];
        for texel in &mut known {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            *texel = state >> 16 < 1500;
        }
        let count = known.iter().filter(|texel| **texel).count();
        assert!((3..40).contains(&count), "{count}");
        let nearest = nearest_known(&known, width, height);
        let distance = |a: usize, b: usize| {
            (a % width).abs_diff(b % width).pow(2) + (a / width).abs_diff(b / width).pow(2)
        };
        for (texel, found) in nearest.iter().enumerate() {
            let found = *found as usize;
            let best = (0..known.len()).filter(|other| known[*other]);
            assert!(known[found]);
            assert_eq!(
                Some(distance(texel, found)),
                best.map(|other| distance(texel, other)).min()
            );
        }
        let mut picture = Picture::new(width, height, 2);
        for (texel, values) in picture.data.chunks_mut(2).enumerate().filter(|(t, _)| known[*t]) {
            values.fill(texel as f32);
        }
        fill_from_nearest(&mut picture, &known);
        let expected: Vec<f32> = nearest.iter().flat_map(|n| [*n as f32; 2]).collect();
        assert_eq!(picture.data, expected);
    }

    #[test]
    fn with_nothing_known_nothing_changes() {
        let mut picture = Picture { width: 2, height: 1, channels: 1, data: vec![3.0, 4.0] };
        fill_from_nearest(&mut picture, &[false, false]);
        assert_eq!(picture.data, [3.0, 4.0]);
    }
}
