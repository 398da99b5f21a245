//! Statistics that reduce per-pixel values of any number of pictures to one number, with its confidence
//! interval.

use std::ops::Range;

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// PSNR is reported up to here, so that equal pictures have a finite value, dB.
const MAX_PSNR: f64 = 100.0;

/// Resamples of the bootstrap.
const RESAMPLES: usize = 1000;

/// Every interval draws the same blocks, so that scores of two methods are compared in pairs.
const SEED: u64 = 2023;

/// Bins of a quantile's interval, each with as many values.
const BINS: usize = 1024;

/// So many of them are added up together, until it is known which of these groups the quantile lies in.
const GROUP: usize = 32;

/// The summary of the values of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statistic {
    /// Mean of x.
    Mean,
    /// -10 log10 of the mean of x, peak 1.
    Psnr,
    /// [`Self::Psnr`] of products that may be negative: where their mean is not positive no error is
    /// left, which is 100 dB.
    UnbiasedPsnr,
    /// Mean over the pictures of the PSNR of each; its interval is that of faces, not of pixels.
    PsnrOfPictures,
    /// -10 log10 of the sum of x / sum of y, peak 1.
    PsnrOfRatio,
    /// Square root of the mean of x.
    RootMean,
    /// Standard deviation of x.
    Spread,
    /// Share of pixels with x below a limit.
    Below(f64),
    /// Quantile of x, linearly interpolated.
    Quantile(f64),
    /// |mean of x - mean of y|.
    MeanDifference,
    /// Sum of x / sum of y.
    Ratio,
    /// Pearson correlation of x and y.
    Correlation,
    /// The squared correlation: the share of the variance of x that a line in y explains.
    Explained,
    /// Slope of the line in y that fits x best: covariance of both over the variance of y.
    Slope,
}

/// The values of one picture: `arity` (1: x, 2: x and y) of them per pixel of the region, and
/// the block that each pixel lies in.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Interleaved.
    pub values: Vec<f64>,
    /// One per pixel, any numbering.
    pub blocks: Vec<usize>,
}

impl Statistic {
    /// Values per pixel.
    pub fn arity(self) -> usize {
        match self {
            Self::MeanDifference
            | Self::PsnrOfRatio
            | Self::Ratio
            | Self::Correlation
            | Self::Explained
            | Self::Slope => 2,
            Self::Mean
            | Self::Psnr
            | Self::UnbiasedPsnr
            | Self::PsnrOfPictures
            | Self::RootMean
            | Self::Spread
            | Self::Below(_)
            | Self::Quantile(_) => 1,
        }
    }

    /// The number over all pixels of all pictures; `None` where it is not defined (a correlation
    pub fn value<'a>(self, samples: impl IntoIterator<Item = &'a [f64]>) -> Option<f64> {
        let samples = samples.into_iter();
        if let Self::Quantile(fraction) = self {
            let mut values: Vec<f64> = samples.flatten().copied().collect();
            values.sort_unstable_by(f64::total_cmp);
            return quantile(&values, fraction);
        }
        if self == Self::PsnrOfPictures {
            let each: Option<Vec<f64>> =
                samples.map(|values| Self::Psnr.value(std::iter::once(values))).collect();
            let each = each.filter(|each| !each.is_empty())?;
            return Some(each.iter().sum::<f64>() / each.len() as f64);
        }
        let mut sums = Sums::default();
        samples.for_each(|values| {
            values.chunks_exact(self.arity()).for_each(|value| sums.add(self.terms(value)));
        });
        self.of_sums(&sums)
    }

    /// The 95 % interval of a bootstrap over blocks of neighbouring pixels, pooled over the
    /// pictures; `None` with fewer than two blocks.
    ///
    /// The interval covers the choice of the visible part of the face, not other faces, lights or seeds.
    pub fn interval(self, samples: &[Sample]) -> Option<[f64; 2]> {
        if let Self::Quantile(fraction) = self {
            return quantile_interval(samples, fraction);
        }
        if self == Self::PsnrOfPictures {
            return None;
        }
        let mut blocks: Vec<Sums> = Vec::new();
        for sample in samples {
            let start = blocks.len();
            for (value, block) in sample.values.chunks_exact(self.arity()).zip(&sample.blocks) {
                let slot = start + block;
                if slot >= blocks.len() {
                    blocks.resize_with(slot + 1, Sums::default);
                }
                blocks[slot].add(self.terms(value));
            }
        }
        blocks.retain(|block| block.count > 0.0);
        percentiles(blocks.len(), |drawn| {
            let mut sums = Sums::default();
            drawn.iter().for_each(|i| sums.merge(&blocks[*i]));
            self.of_sums(&sums)
        })
    }

    /// Terms of a pixel that are summed; the statistic is a function of the sums.
    fn terms(self, value: &[f64]) -> [f64; 5] {
        let x = value[0];
        match self {
            Self::Below(limit) => [f64::from(x < limit), 0.0, 0.0, 0.0, 0.0],
            Self::Spread => [x, x * x, 0.0, 0.0, 0.0],
            Self::MeanDifference | Self::PsnrOfRatio | Self::Ratio => [x, value[1], 0.0, 0.0, 0.0],
            Self::Correlation | Self::Explained | Self::Slope => {
                let y = value[1];
                [x, y, x * x, y * y, x * y]
            }
            Self::Mean
            | Self::Psnr
            | Self::UnbiasedPsnr
            | Self::PsnrOfPictures
            | Self::RootMean
            | Self::Quantile(_) => [x, 0.0, 0.0, 0.0, 0.0],
        }
    }

    fn of_sums(self, sums: &Sums) -> Option<f64> {
        if sums.count == 0.0 {
            return None;
        }
        let [a, b, c, d, e] = sums.terms.map(|term| term / sums.count);
        let value = match self {
            Self::Mean | Self::Below(_) => Some(a),
            Self::Psnr | Self::PsnrOfPictures => Some((-10.0 * a.log10()).min(MAX_PSNR)),
            Self::UnbiasedPsnr if a > 0.0 => Some((-10.0 * a.log10()).min(MAX_PSNR)),
            Self::UnbiasedPsnr => Some(MAX_PSNR),
            Self::RootMean => Some(a.sqrt()),
            Self::Spread => Some(variance(a, b).sqrt()),
            Self::MeanDifference => Some((a - b).abs()),
            Self::Ratio => (b != 0.0).then(|| a / b),
            Self::PsnrOfRatio => (b > 0.0).then(|| (-10.0 * (a / b).log10()).min(MAX_PSNR)),
            Self::Correlation | Self::Explained => {
                let (x, y) = (variance(a, c), variance(b, d));
                if x == 0.0 || y == 0.0 {
                    return None;
                }
                let r = ((e - a * b) / (x * y).sqrt()).clamp(-1.0, 1.0);
                Some(if self == Self::Correlation { r } else { r * r })
            }
            Self::Slope => {
                let y = variance(b, d);
                (y > 0.0).then(|| (e - a * b) / y)
            }
            Self::Quantile(_) => None,
        };
        value.filter(|value| value.is_finite())
    }
}

#[derive(Clone, Default)]
struct Sums {
    count: f64,
    terms: [f64; 5],
}

impl Sums {
    fn add(&mut self, terms: [f64; 5]) {
        self.merge(&Sums { count: 1.0, terms });
    }

    fn merge(&mut self, other: &Sums) {
        self.count += other.count;
        self.terms.iter_mut().zip(other.terms).for_each(|(sum, term)| *sum += term);
    }
}

/// Zero where nothing but rounding is left of it: then the values are constant.
fn variance(mean: f64, mean_square: f64) -> f64 {
    let variance = mean_square - mean * mean;
    if variance > 1e-12 * mean_square { variance } else { 0.0 }
}

fn quantile(sorted: &[f64], fraction: f64) -> Option<f64> {
    let place = fraction * sorted.len().checked_sub(1)? as f64;
    let low = place.floor() as usize;
    let high = (low + 1).min(sorted.len() - 1);
    Some(sorted[low] + (sorted[high] - sorted[low]) * place.fract())
}

/// Counts how many values of each block fall between a thousand quantiles of all values, so that
/// a resample adds counts instead of sorting.
fn quantile_interval(samples: &[Sample], fraction: f64) -> Option<[f64; 2]> {
    let mut values: Vec<(f64, usize)> = Vec::new();
    let mut blocks = 0;
    for sample in samples {
        values.extend(
            sample.values.iter().zip(&sample.blocks).map(|(v, block)| (*v, blocks + block)),
        );
        blocks += sample.blocks.iter().max().map_or(0, |last| last + 1);
    }
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let bins: Vec<&[(f64, usize)]> = values.chunks(values.len().div_ceil(BINS).max(1)).collect();
    let mut counts = vec![vec![0_u32; bins.len()]; blocks];
    for (bin, values) in bins.iter().enumerate() {
        values.iter().for_each(|(_, block)| counts[*block][bin] += 1);
    }
    counts.retain(|of_block| of_block.iter().any(|count| *count > 0));
    let groups: Vec<Vec<u32>> = counts
        .iter()
        .map(|bins| bins.chunks(GROUP).map(|group| group.iter().sum()).collect())
        .collect();
    percentiles(counts.len(), |drawn| {
        let sums = total(drawn, &groups, 0..bins.len().div_ceil(GROUP));
        let wanted = fraction * f64::from(sums.iter().sum::<u32>());
        let (group, before) = first_at(&sums, 0, wanted)?;
        let within = group * GROUP..bins.len().min((group + 1) * GROUP);
        let (bin, _) = first_at(&total(drawn, &counts, within), before, wanted)?;
        let bin = bins[group * GROUP + bin];
        Some(bin[bin.len() / 2].0)
    })
}

/// Sums of some columns over the rows `drawn`.
fn total(drawn: &[usize], rows: &[Vec<u32>], columns: Range<usize>) -> Vec<u32> {
    let mut sums = vec![0; columns.len()];
    for row in drawn {
        sums.iter_mut().zip(&rows[*row][columns.clone()]).for_each(|(sum, count)| *sum += count);
    }
    sums
}

/// The first of `counts` that is not empty and with which as many as `wanted` are seen, `before` having been seen
/// before all of them; and how many were seen before it.
fn first_at(counts: &[u32], before: u32, wanted: f64) -> Option<(usize, u32)> {
    let mut seen = before;
    counts.iter().enumerate().find_map(|(at, count)| {
        let before = seen;
        seen += count;
        (*count > 0 && f64::from(seen) >= wanted).then_some((at, before))
    })
}

/// The 2.5 % and 97.5 % percentiles of a statistic of `count` blocks drawn with replacement.
fn percentiles(
    count: usize,
    mut statistic: impl FnMut(&[usize]) -> Option<f64>,
) -> Option<[f64; 2]> {
    if count < 2 {
        return None;
    }
    let mut random = Pcg64Mcg::seed_from_u64(SEED);
    let mut drawn = vec![0; count];
    let mut values = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        // The high bits of the product are uniform below `count` to within 2^-64.
        drawn.fill_with(|| ((u128::from(random.next_u64()) * count as u128) >> 64) as usize);
        values.extend(statistic(&drawn));
    }
    values.sort_unstable_by(f64::total_cmp);
    Some([quantile(&values, 0.025)?, quantile(&values, 0.975)?])
}
