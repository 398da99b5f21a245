//! Confidence intervals contain the true value as often as they say, also where neighbouring
//! pixels err together.

#![allow(clippy::unwrap_used)]

mod noise;

use noise::normal_noise;
use scoring::metrics::{Region, Sample, Statistic, block_side};

const SIDE: usize = 96;
/// Pixels of a square that share one error.
const PATCH: usize = 4;
const TRIALS: usize = 200;

/// Share of trials in which the interval of a statistic of noise contains its true value.
fn coverage(statistic: Statistic, truth: f64, value: impl Fn(f64) -> Vec<f64>) -> f64 {
    let per_row = SIDE / PATCH;
    let mut noise = normal_noise(3);
    let hits = (0..TRIALS).filter(|_| {
        let patches: Vec<f64> = (0..per_row * per_row).map(|_| noise()).collect();
        let patch = |i: usize| patches[i / SIDE / PATCH * per_row + i % SIDE / PATCH];
        let sample = Sample {
            values: (0..SIDE * SIDE).flat_map(|i| value(patch(i))).collect(),
            blocks: (0..SIDE * SIDE).map(|i| i / SIDE / 8 * (SIDE / 8) + i % SIDE / 8).collect(),
        };
        let [low, high] = statistic.interval(&[sample]).unwrap();
        (low..=high).contains(&truth)
    });
    hits.count() as f64 / TRIALS as f64
}

#[test]
fn intervals_cover_the_truth_in_about_95_percent_of_trials() {
    let found = [
        ("mean", coverage(Statistic::Mean, 0.0, |x| vec![x])),
        ("psnr", coverage(Statistic::Psnr, 20.0, |x| vec![0.01 * x * x])),
        ("median", coverage(Statistic::Quantile(0.5), 0.0, |x| vec![x])),
        ("below", coverage(Statistic::Below(0.0), 0.5, |x| vec![x])),
    ];
    for (name, fraction) in found {
        println!("{name} {fraction}");
        // 200 trials at 95 %: two thirds of the results lie within 1.5 points of it, and a
        // percentile interval of 144 blocks is known to be a little short.
        assert!((0.89..=0.99).contains(&fraction), "{name}: {fraction}");
    }
}

#[test]
fn blocks_follow_the_correlation_and_their_intervals_hold() {
    // White noise, and noise that patches of 6 and 12 pixels share: the same field seen finer.
    let mut noise = normal_noise(8);
    let region = Region::whole(SIDE, SIDE).unwrap();
    let mut field = |patch: usize| -> Vec<f64> {
        let per_row = SIDE / patch;
        let patches: Vec<f64> = (0..per_row * per_row).map(|_| noise()).collect();
        (0..SIDE * SIDE).map(|i| patches[i / SIDE / patch * per_row + i % SIDE / patch]).collect()
    };
    let side = |values: &[f64]| block_side(values, 1, &region);
    assert_eq!(side(&field(1)), 4);
    let (fine, coarse) = (side(&field(3)), side(&field(6)));
    // Patches of n correlate by 1 - lag / n, which is 1 / e at .63 n.
    assert!((7..=9).contains(&fine) && (14..=17).contains(&coarse), "{fine} {coarse}");
    assert_eq!(side(&vec![1.0; SIDE * SIDE]), 4, "a constant");
    let hits = (0..TRIALS).filter(|_| {
        let values = field(4);
        let blocks = region.blocks(side(&values)).collect();
        let [low, high] = Statistic::Mean.interval(&[Sample { values, blocks }]).unwrap();
        (low..=high).contains(&0.0)
    });
    let fraction = hits.count() as f64 / TRIALS as f64;
    println!("chosen blocks {fraction}");
    assert!((0.88..=0.99).contains(&fraction), "{fraction}");
}

#[test]
fn intervals_are_repeatable_and_need_two_blocks() {
    let sample = |blocks: Vec<usize>| Sample { values: vec![1.0, 2.0, 4.0], blocks };
    let interval = Statistic::Mean.interval(&[sample(vec![0, 1, 2])]).unwrap();
    assert_eq!(interval, Statistic::Mean.interval(&[sample(vec![7, 8, 9])]).unwrap());
    assert!(interval[0] < 7.0 / 3.0 && interval[1] > 7.0 / 3.0);
    assert_eq!(Statistic::Mean.interval(&[sample(vec![0, 0, 0])]), None);
    assert_eq!(Statistic::Quantile(0.5).interval(&[sample(vec![5, 5, 5])]), None);
    // Blocks of two pictures are different blocks.
    let two = [sample(vec![0, 0, 0]), sample(vec![0, 0, 0])];
    assert!(Statistic::Mean.interval(&two).is_some());
    assert!(Statistic::Quantile(0.5).interval(&two).is_some());
}

#[test]
fn a_constant_has_no_correlation() {
    let values: Vec<f64> = (0..100).flat_map(|i| [0.1, f64::from(i)]).collect();
    assert_eq!(Statistic::Correlation.value([values.as_slice()]), None);
    assert_eq!(Statistic::Ratio.value([[1.0, 0.0].as_slice()]), None);
    assert_eq!(Statistic::Mean.value([[].as_slice()]), None);
    assert_eq!(Statistic::Quantile(0.5).value([[].as_slice()]), None);
}
