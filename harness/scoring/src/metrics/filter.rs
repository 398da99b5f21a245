//! Gaussian filters for the metrics that look at a neighbourhood.

use formats::cancel;
use rayon::prelude::*;

/// A separable Gaussian cut off at `radius`; the picture is mirrored at its border, edge pixel
/// included (scipy's `reflect`).
pub fn gaussian(
    values: &[f64],
    width: usize,
    height: usize,
    sigma: f64,
    radius: usize,
) -> Vec<f64> {
    let weights: Vec<f64> = (0..=2 * radius)
        .map(|i| (-0.5 * ((i as f64 - radius as f64) / sigma).powi(2)).exp())
        .collect();
    let total: f64 = weights.iter().sum();
    let weights: Vec<f64> = weights.iter().map(|w| w / total).collect();
    let columns = mirrored(width, radius);
    let rows = mirrored(height, radius);
    let mut across = vec![0.0; values.len()];
    across.par_chunks_exact_mut(width).zip(values.par_chunks_exact(width)).for_each(
        |(out, row)| {
            cancel::check();
            let padded: Vec<f64> = columns.iter().map(|from| row[*from]).collect();
            for (shift, w) in weights.iter().enumerate() {
                out.iter_mut().zip(&padded[shift..]).for_each(|(out, value)| *out += w * value);
            }
        },
    );
    let mut down = vec![0.0; values.len()];
    down.par_chunks_exact_mut(width).enumerate().for_each(|(y, out)| {
        for (w, &from) in weights.iter().zip(&rows[y..]) {
            let row = &across[from * width..(from + 1) * width];
            out.iter_mut().zip(row).for_each(|(out, value)| *out += w * value);
        }
    });
    down
}

/// The index that each position from `-radius` to `length + radius` is mirrored to.
fn mirrored(length: usize, radius: usize) -> Vec<usize> {
    let period = 2 * length as isize;
    (-(radius as isize)..(length + radius) as isize)
        .map(|i| {
            let i = i.rem_euclid(period);
            if i < length as isize { i as usize } else { (period - 1 - i) as usize }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_mirrors_more_than_once_if_it_must() {
        assert_eq!(mirrored(2, 3), [1, 1, 0, 0, 1, 1, 0, 0]);
        let flat = gaussian(&[3.0; 12], 4, 3, 1.5, 5);
        assert!(flat.iter().all(|v| (v - 3.0).abs() < 1e-12));
    }
}
