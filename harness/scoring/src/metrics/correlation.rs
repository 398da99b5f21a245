//! The correlation length of errors of neighbouring pixels, from which the blocks of the bootstrap follow.

use super::Region;

/// A block's side over the correlation length: what is left of the correlation between the middles
/// of neighbouring blocks is exp(-4).
const LENGTHS: f64 = 4.0;
const SMALLEST: usize = 4;
/// At least so many blocks across the region.
const ACROSS: usize = 5;

/// Side of the blocks of neighbouring pixels that err nearly independently of one another: four
/// times the distance at which the correlation of the values over a region has fallen to 1 / e, at
/// least 4 pixels and at most a fifth of the region's width or height. `values` has `arity` numbers
/// for each pixel; of two it is their difference that errs.
pub fn block_side(values: &[f64], arity: usize, region: &Region) -> usize {
    let (width, height) = region.size();
    let of = |pixel: &[f64]| if arity == 2 { pixel[0] - pixel[1] } else { pixel[0] };
    let mean = values.chunks_exact(arity).map(of).sum::<f64>() / region.pixels().len() as f64;
    let mut grid = vec![f64::NAN; width * height];
    for (i, value) in region.pixels().iter().zip(values.chunks_exact(arity)) {
        grid[*i] = of(value) - mean;
    }
    let extent = |of: &dyn Fn(usize) -> usize| {
        let ends = region
            .pixels()
            .iter()
            .fold((usize::MAX, 0), |(low, high), i| (low.min(of(*i)), high.max(of(*i))));
        ends.1 + 1 - ends.0.min(ends.1)
    };
    let room = extent(&|i| i % width).max(extent(&|i| i / width));
    let largest = (room / ACROSS).max(SMALLEST);
    let length = correlation_length(&grid, width, region, largest);
    ((LENGTHS * length).ceil() as usize).clamp(SMALLEST, largest)
}

/// The distance at which the correlation has fallen to 1 / e, between lags on a straight line.
fn correlation_length(grid: &[f64], width: usize, region: &Region, largest: usize) -> f64 {
    let variance = region.pixels().iter().map(|i| grid[*i].powi(2)).sum::<f64>();
    let variance = variance / region.pixels().len() as f64;
    if variance <= 0.0 {
        return 0.0;
    }
    let correlation = |lag: usize| {
        let (mut sum, mut count) = (0.0, 0.0);
        for &i in region.pixels() {
            let right = if i % width + lag < width { grid.get(i + lag) } else { None };
            for other in right.into_iter().chain(grid.get(i + lag * width)) {
                if !other.is_nan() {
                    sum += grid[i] * other;
                    count += 1.0;
                }
            }
        }
        if count > 0.0 { sum / count / variance } else { 0.0 }
    };
    let fallen = (-1.0_f64).exp();
    let (mut lag, mut last) = (1, (0, 1.0));
    while lag <= largest {
        let here = correlation(lag);
        if here < fallen {
            let (before, was) = last;
            let fraction = (was - fallen) / (was - here);
            return before as f64 + fraction * (lag - before) as f64;
        }
        last = (lag, here);
        lag += (lag / 4).max(1);
    }
    largest as f64
}
