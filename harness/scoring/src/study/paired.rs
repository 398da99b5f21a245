//! Two methods on the same faces: is the difference more than chance, and how large is it?

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use statrs::distribution::{ContinuousCDF, Normal};

use super::faces::{critical, mean, spread};

/// Up to so many faces all signs are tried.
const EXACT: usize = 16;
/// Random signs beyond.
const DRAWS: usize = 100_000;
const SEED: u64 = 2023;

/// The two-sided p value of the sign-flip permutation test that the mean of paired differences is
/// zero: the share of all ways to swap the two methods of each face whose mean is as far from zero.
/// Exact up to 16 faces, else of 100 000 random swaps and that which was seen. None without a face.
pub fn sign_flip(differences: &[f64]) -> Option<f64> {
    if differences.is_empty() {
        return None;
    }
    let seen = differences.iter().sum::<f64>().abs();
    // Sums in another order differ by rounding; equal ones must count.
    let threshold = seen - 1e-12 * differences.iter().map(|d| d.abs()).sum::<f64>();
    let sum = |signs: &dyn Fn(usize) -> bool| {
        let signed = differences.iter().enumerate().map(|(i, d)| if signs(i) { -d } else { *d });
        signed.sum::<f64>().abs()
    };
    if differences.len() <= EXACT {
        let all = 1_u32 << differences.len();
        let far = (0..all).filter(|bits| sum(&|i| bits >> i & 1 == 1) >= threshold).count();
        return Some(far as f64 / f64::from(all));
    }
    let mut random = Pcg64Mcg::seed_from_u64(SEED);
    let far = (0..DRAWS)
        .filter(|_| {
            let words: Vec<u64> =
                (0..differences.len().div_ceil(64)).map(|_| random.next_u64()).collect();
            sum(&|i| words[i / 64] >> (i % 64) & 1 == 1) >= threshold
        })
        .count();
    Some((far + 1) as f64 / (DRAWS + 1) as f64)
}

/// Holm's correction: p values that may be held against a level one by one, and still err in the
/// whole family no more often than it says.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let mut corrected = vec![0.0; p.len()];
    let mut largest = 0.0_f64;
    for (rank, at) in order.into_iter().enumerate() {
        largest = largest.max(((p.len() - rank) as f64 * p[at]).min(1.0));
        corrected[at] = largest;
    }
    corrected
}

/// Mean of the differences over their standard deviation, corrected for few faces (Hedges); none
/// where they do not differ.
pub fn effect_size(differences: &[f64]) -> Option<f64> {
    let deviation = spread(differences).filter(|deviation| *deviation > 0.0)?;
    let freedom = (differences.len() - 1) as f64;
    Some(mean(differences.iter().copied()) / deviation * (1.0 - 3.0 / (4.0 * freedom - 1.0)))
}

/// The fewest faces of which a paired comparison at 5 % finds a mean difference of `effect`
/// standard deviations in 80 % of studies; none beyond 10 000.
///
/// The power is that of the paired t test, which the sign-flip test follows closely; at least six
/// faces, below which no sign-flip test can reach 5 %.
pub fn faces_needed(effect: f64) -> Option<usize> {
    let enough = |faces: usize| power(effect.abs(), faces).is_some_and(|power| power >= 0.8);
    if !(effect.abs() > 0.0 && enough(10_000)) {
        return None;
    }
    let (mut low, mut high) = (5, 10_000);
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if enough(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

/// The power of a paired t test at 5 % over `faces` faces to find a difference of `effect` standard
/// deviations: P(|T| > t), T not central. Given the sample's variance T is normal, and that is
/// integrated over by quantiles.
pub fn power(effect: f64, faces: usize) -> Option<f64> {
    const NODES: usize = 400;
    let freedom = faces.checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
    let (limit, shift) = (critical(freedom)?, effect * (faces as f64).sqrt());
    let normal = Normal::standard();
    let chi = statrs::distribution::ChiSquared::new(freedom).ok()?;
    let of_node = |node: usize| {
        let square = chi.inverse_cdf((node as f64 + 0.5) / NODES as f64);
        let reach = limit * (square / freedom).sqrt();
        normal.cdf(shift - reach) + normal.cdf(-shift - reach)
    };
    Some((0..NODES).map(of_node).sum::<f64>() / NODES as f64)
}
