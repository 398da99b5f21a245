//! The unit of a study is the face: means over faces, their intervals, and what varies below them.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Resamples of a bootstrap.
const RESAMPLES: usize = 2000;
const SEED: u64 = 2023;

/// One score below a face: a light, a seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// The score, pooled over its views.
    pub value: f64,
    /// The scores of single views; empty of a map.
    pub views: Vec<f64>,
}

/// A face with all of its scores of one figure and method.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The name.
    pub name: String,
    /// At least one.
    pub cells: Vec<Cell>,
}

impl Face {
    /// The mean over its cells.
    pub fn mean(&self) -> f64 {
        mean(self.cells.iter().map(|cell| cell.value))
    }
}

/// Mean of the values; NaN of none.
pub(super) fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) =
        values.into_iter().fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Standard deviation of a sample (n - 1); none of fewer than two.
pub fn spread(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let centre = mean(values.iter().copied());
    let squares: f64 = values.iter().map(|value| (value - centre).powi(2)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

/// The 95 % interval of the mean of values that are independent, one of each face: Student's t.
/// None of fewer than two faces, which say nothing of others.
pub fn interval(values: &[f64]) -> Option<[f64; 2]> {
    let centre = mean(values.iter().copied());
    let half =
        critical(values.len() as f64 - 1.0)? * spread(values)? / (values.len() as f64).sqrt();
    Some([centre - half, centre + half])
}

/// The 97.5 % quantile of Student's t.
pub(super) fn critical(freedom: f64) -> Option<f64> {
    StudentsT::new(0.0, 1.0, freedom).ok().map(|t| t.inverse_cdf(0.975))
}

/// The 95 % interval of the difference of the means of two groups of faces: Welch's t.
pub fn welch(a: &[f64], b: &[f64]) -> Option<[f64; 2]> {
    let of = |values: &[f64]| Some(spread(values)?.powi(2) / values.len() as f64);
    let (va, vb) = (of(a)?, of(b)?);
    let difference = mean(a.iter().copied()) - mean(b.iter().copied());
    if va + vb == 0.0 {
        return Some([difference; 2]);
    }
    let term = |v: f64, n: usize| v * v / (n - 1) as f64;
    let freedom = (va + vb).powi(2) / (term(va, a.len()) + term(vb, b.len()));
    let half = critical(freedom)? * (va + vb).sqrt();
    Some([difference - half, difference + half])
}

/// Decibels of the mean squared error over all faces, with the 95 % interval of a studentised
/// cluster bootstrap of its logarithm: faces are drawn, then the views of each of their cells. No
/// interval of fewer than four faces, whose resamples are too few.
pub fn pooled_decibels(faces: &[Face]) -> (f64, Option<[f64; 2]>) {
    let error = |decibels: f64| 10_f64.powf(-0.1 * decibels);
    let clusters: Vec<Vec<(f64, Vec<f64>)>> = faces
        .iter()
        .map(|face| {
            let of_cell =
                |cell: &Cell| (error(cell.value), cell.views.iter().copied().map(error).collect());
            face.cells.iter().map(of_cell).collect()
        })
        .collect();
    let plain: Vec<f64> =
        clusters.iter().map(|cells| mean(cells.iter().map(|cell| cell.0))).collect();
    let decibels = |log: f64| -10.0 * log / std::f64::consts::LN_10;
    let Some((log, error)) = log_mean(&plain) else { return (f64::NAN, None) };
    if faces.len() < 4 || error == 0.0 {
        return (decibels(log), None);
    }
    let mut random = Pcg64Mcg::seed_from_u64(SEED);
    let mut pivots: Vec<f64> = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        let drawn: Vec<f64> = (0..clusters.len())
            .map(|_| {
                let cells = &clusters[below(&mut random, clusters.len())];
                mean(cells.iter().map(|(value, views)| value + shift(&mut random, views)))
            })
            .collect();
        if let Some((other, its_error)) = log_mean(&drawn)
            && its_error > 0.0
        {
            pivots.push((other - log) / its_error);
        }
    }
    pivots.sort_unstable_by(f64::total_cmp);
    let at = |fraction: f64| {
        pivots.get((fraction * (pivots.len() - 1) as f64).round() as usize).copied()
    };
    let ends = || Some([log - at(0.025)? * error, log - at(0.975)? * error]);
    (
        decibels(log),
        if pivots.len() < RESAMPLES / 2 { None } else { ends().map(|e| e.map(decibels)) },
    )
}

/// The difference between the mean of views drawn with replacement and that of all.
fn shift(random: &mut Pcg64Mcg, views: &[f64]) -> f64 {
    if views.len() < 2 {
        return 0.0;
    }
    let drawn = mean((0..views.len()).map(|_| views[below(random, views.len())]));
    drawn - mean(views.iter().copied())
}

/// The logarithm of the mean of positive values, and its standard error.
fn log_mean(values: &[f64]) -> Option<(f64, f64)> {
    let centre = mean(values.iter().copied());
    let error = spread(values).unwrap_or(0.0) / (values.len() as f64).sqrt();
    (centre > 0.0).then(|| (centre.ln(), error / centre))
}

/// Uniform below `count` to within 2^-64.
pub(super) fn below(random: &mut Pcg64Mcg, count: usize) -> usize {
    ((u128::from(random.next_u64()) * count as u128) >> 64) as usize
}
