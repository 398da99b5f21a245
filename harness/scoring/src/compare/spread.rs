//! The critical value of a comparison: the distance that the largest of many scores strays by chance.
//!
//! The scores of a run hang together (an albedo that is off moves its PSNR, its colour difference and
//! every relit picture), so that one hundred rows are not a hundred independent chances of a false alarm.
//! The distribution of the largest studentised difference is simulated from the runs themselves: normal
//! runs with the correlation that the seeds showed, shrunk towards independence (Schäfer and Strimmer
//! 2005) because few runs show too much of it. Some runs are further off than a normal one in all that
//! they score, since a solve may end elsewhere: each is scaled as Student's t with [`TAILS`] degrees of
//! freedom is. Each simulated calibration has its own spread estimated
//! from as many runs, as in the single-step procedure of Westfall and Young (1993).

use std::f64::consts::TAU;

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Simulated comparisons: at 1 % the critical value rests on the largest 200.
pub(super) const SIMULATIONS: usize = 20_000;

/// Degrees of freedom of a run's distribution: a kurtosis of 4. Of 24 runs of a small solve, rows had 3 in
/// the median and up to 7.
pub(super) const TAILS: usize = 10;

/// Simulations that share a stream of random numbers, whatever the number of threads.
const CHUNK: usize = 250;

/// One row over the calibration's runs.
pub(super) struct Column {
    /// Deviations from their mean over their standard deviation.
    standard: Vec<f64>,
    /// The lower limit of the standard deviation, in standard deviations of the row.
    floor: f64,
}

/// Standard deviation, with one degree of freedom taken by the mean.
pub(super) fn deviation(values: &[f64]) -> f64 {
    // The mean of equal values may be rounded to another, and the row would count as one that moves.
    if values.windows(2).all(|pair| pair[0] == pair[1]) {
        return 0.0;
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (values.len() - 1) as f64).sqrt()
}

impl Column {
    /// A row's values; none if it does not move, so that it can raise no alarm either.
    pub(super) fn new(values: &[f64], floor: f64) -> Option<Self> {
        let sd = deviation(values);
        if sd <= 0.0 || !sd.is_finite() {
            return None;
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let standard = values.iter().map(|value| (value - mean) / sd).collect();
        Some(Self { standard, floor: floor / sd })
    }
}

/// The value that the largest |difference of two runs| over √2 standard deviations exceeds with
/// probability `rate`, when nothing but seeds differs; `None` if no row moves. Runs are normal with no
/// `tails`.
pub(super) fn critical(
    columns: &[Column],
    rate: f64,
    tails: Option<usize>,
    simulations: usize,
    seed: u64,
) -> Option<f64> {
    columns.first()?;
    let shrinkage = shrinkage(columns);
    let chunks: Vec<Vec<f64>> = (0..simulations.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let stream = seed.wrapping_mul(1 << 32).wrapping_add(chunk as u64);
            let mut normal = Normal::new(stream);
            (0..CHUNK).map(|_| largest(columns, tails, shrinkage, &mut normal)).collect()
        })
        .collect();
    let mut largest = chunks.concat();
    largest.sort_unstable_by(|a, b| b.total_cmp(a));
    Some(largest[((rate * largest.len() as f64) as usize).min(largest.len() - 1)])
}

/// One simulated calibration of as many runs, and one comparison of two more.
fn largest(columns: &[Column], tails: Option<usize>, shrinkage: f64, normal: &mut Normal) -> f64 {
    let runs = columns.first().map_or(0, |column| column.standard.len());
    // A run's scores are a random mix of those that were seen, which gives them their correlation.
    let total = runs + 2;
    let shared = ((1.0 - shrinkage) / (runs - 1) as f64).sqrt();
    let mix: Vec<f64> = (0..total * runs).map(|_| shared * normal.draw()).collect();
    let own = shrinkage.sqrt();
    let sizes: Vec<f64> =
        (0..total).map(|_| tails.map_or(1.0, |tails| normal.size(tails))).collect();
    let mut values = vec![0.0; total];
    let mut largest = 0.0_f64;
    for column in columns {
        for ((value, mix), size) in values.iter_mut().zip(mix.chunks_exact(runs)).zip(&sizes) {
            let shared: f64 = mix.iter().zip(&column.standard).map(|(a, b)| a * b).sum();
            *value = size * (shared + own * normal.draw());
        }
        let sd = deviation(&values[..runs]).max(column.floor);
        let difference = (values[runs] - values[runs + 1]).abs();
        largest = largest.max(difference / (sd * std::f64::consts::SQRT_2));
    }
    largest
}

/// The shrinkage of the correlation towards zero: the sum over pairs of rows of a correlation's
/// variance, (1 - r²)² / (runs - 1) of normal values, over that of its square.
fn shrinkage(columns: &[Column]) -> f64 {
    let degrees = columns.first().map_or(1, |column| column.standard.len() - 1) as f64;
    let of_row = |(at, a): (usize, &Column)| {
        let pairs = columns[at + 1..].iter().map(|b| {
            let products: f64 = a.standard.iter().zip(&b.standard).map(|(x, y)| x * y).sum();
            let square = (products / degrees).powi(2);
            ((1.0 - square).powi(2) / degrees, square)
        });
        pairs.fold((0.0, 0.0), |sums, pair| (sums.0 + pair.0, sums.1 + pair.1))
    };
    let of_rows: Vec<(f64, f64)> = columns.par_iter().enumerate().map(of_row).collect();
    let (variances, squares) =
        of_rows.into_iter().fold((0.0, 0.0), |sums, row| (sums.0 + row.0, sums.1 + row.1));
    if squares > 0.0 { (variances / squares).clamp(0.0, 1.0) } else { 1.0 }
}

/// Normal random numbers, two at a time (Box and Muller).
pub(super) struct Normal {
    random: Pcg64Mcg,
    other: Option<f64>,
}

impl Normal {
    pub(super) fn new(seed: u64) -> Self {
        Self { random: Pcg64Mcg::seed_from_u64(seed), other: None }
    }

    /// Factor that makes a normal vector one of Student's t, with the variance that it had.
    fn size(&mut self, degrees: usize) -> f64 {
        let squares: f64 = (0..degrees).map(|_| self.draw().powi(2)).sum();
        ((degrees as f64 - 2.0) / squares).sqrt()
    }

    pub(super) fn draw(&mut self) -> f64 {
        if let Some(other) = self.other.take() {
            return other;
        }
        // 53 bits, and never zero.
        let mut uniform = || ((self.random.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64;
        let (radius, angle) = ((-2.0 * uniform().ln()).sqrt(), TAU * uniform());
        self.other = Some(radius * angle.sin());
        radius * angle.cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(rows: usize, runs: usize, shared: f64, seed: u64) -> Vec<Column> {
        let mut normal = Normal::new(seed);
        let common: Vec<f64> = (0..runs).map(|_| normal.draw()).collect();
        let row = |_| {
            let noise = (1.0 - shared * shared).sqrt();
            let values: Vec<f64> =
                common.iter().map(|common| shared * common + noise * normal.draw()).collect();
            Column::new(&values, 0.0).unwrap()
        };
        (0..rows).map(row).collect()
    }

    #[test]
    fn one_row_has_students_critical_value() {
        // 7 degrees of freedom, two sides, 1 % and 5 %: tables of the t distribution.
        for (rate, expected) in [(0.01, 3.499), (0.05, 2.365)] {
            let found = critical(&columns(1, 8, 0.0, 1), rate, None, 20_000, 1).unwrap();
            assert!((found / expected - 1.0).abs() < 0.04, "{found}, Student has {expected}");
        }
    }

    #[test]
    fn rows_that_hang_together_cost_less_than_rows_that_do_not() {
        let free = critical(&columns(60, 12, 0.0, 2), 0.05, None, 4000, 1).unwrap();
        let bound = critical(&columns(60, 12, 0.999, 3), 0.05, None, 4000, 1).unwrap();
        // Bonferroni: t with 11 degrees of freedom at 0.05 / 120, 4.63.
        assert!((4.0..4.9).contains(&free), "{free}");
        assert!(bound < 0.7 * free, "{bound} {free}");
    }

    #[test]
    fn rows_that_do_not_move_are_left_out() {
        assert!(Column::new(&[1.0; 5], 0.1).is_none());
        assert!(Column::new(&[0.1; 10], 0.1).is_none(), "ten times .1, summed, is not 1");
        assert!(critical(&[], 0.01, None, 100, 1).is_none());
    }

    /// Whole calibrations and comparisons, again and again: rows in blocks that hang together, as scores
    /// do, and the share of comparisons in which any row passes the critical value.
    #[test]
    fn false_alarms_over_all_rows_keep_to_the_stated_rate() {
        const RATE: f64 = 0.05;
        let (rows, block, runs, trials) = (60, 12, 8, 250);
        for (shared, tails) in [(0.0_f64, None), (0.7, None), (0.98, None), (0.7, Some(TAILS))] {
            let mut normal = Normal::new(17);
            let mut draw = || -> Vec<f64> {
                let common: Vec<f64> = (0..rows / block).map(|_| normal.draw()).collect();
                let own = (1.0 - shared * shared).sqrt();
                let size = tails.map_or(1.0, |tails| normal.size(tails));
                let mut value = |row| size * (shared * common[row / block] + own * normal.draw());
                (0..rows).map(&mut value).collect()
            };
            let mut alarms = 0;
            for trial in 0..trials {
                let seen: Vec<Vec<f64>> = (0..runs).map(|_| draw()).collect();
                let of_row = |row: usize| seen.iter().map(|run| run[row]).collect::<Vec<f64>>();
                let columns: Vec<Column> =
                    (0..rows).map(|row| Column::new(&of_row(row), 0.0).unwrap()).collect();
                let limit = critical(&columns, RATE, tails, 400, trial).unwrap();
                let (old, new) = (draw(), draw());
                let beyond = |row: usize| {
                    let sd = deviation(&of_row(row)) * std::f64::consts::SQRT_2;
                    (new[row] - old[row]).abs() > limit * sd
                };
                alarms += usize::from((0..rows).any(beyond));
            }
            let found = alarms as f64 / f64::from(trials as u32);
            // 5 % with three standard errors above; and not a procedure that never says anything.
            assert!((0.005..0.091).contains(&found), "{shared}: {found}");
        }
    }
}
