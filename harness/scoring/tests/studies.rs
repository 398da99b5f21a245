//! Intervals over faces hold the true value, and paired tests err, as often as they say.

#![allow(clippy::unwrap_used)]

mod noise;

use noise::normal_noise;
use scoring::study::{
    Cell, Face, effect_size, faces_needed, holm, interval, pooled_decibels, power, sign_flip, welch,
};

const STUDIES: usize = 500;
const FACES: usize = 12;

/// Faces of a study: `face` draws what a face is, and each has two lights of three views, which
/// err too.
fn study(face: &mut dyn FnMut() -> f64, noise: &mut dyn FnMut() -> f64) -> Vec<Face> {
    (0..FACES)
        .map(|i| {
            let level = face();
            let cells = (0..2).map(|_| {
                let views: Vec<f64> = (0..3).map(|_| level + 0.7 * noise()).collect();
                Cell { value: views.iter().sum::<f64>() / 3.0, views }
            });
            Face { name: i.to_string(), cells: cells.collect() }
        })
        .collect()
}

fn fraction(hits: impl Iterator<Item = bool>) -> f64 {
    hits.filter(|hit| *hit).count() as f64 / STUDIES as f64
}

#[test]
fn intervals_over_faces_hold_the_true_mean_in_95_percent_of_studies() {
    let mut noise = normal_noise(11);
    // Decibels of faces are near normal; the other law has a skewness of one.
    type Law = fn(&mut dyn FnMut() -> f64) -> f64;
    let laws: [(&str, f64, Law); 2] = [
        ("normal", 35.0, |n| 35.0 + 2.0 * n()),
        ("skewed", 35.0, |n| 34.0 + (0..8).map(|_| n().powi(2)).sum::<f64>() / 8.0),
    ];
    for (name, truth, law) in laws {
        let hits = (0..STUDIES).map(|_| {
            let (mut faces, mut views) = (normal_noise_of(&mut noise), normal_noise_of(&mut noise));
            let faces = study(&mut || law(&mut faces), &mut views);
            let means: Vec<f64> = faces.iter().map(Face::mean).collect();
            let [low, high] = interval(&means).unwrap();
            (low..=high).contains(&truth)
        });
        let covered = fraction(hits);
        println!("{name} {covered}");
        assert!((0.93..=0.97).contains(&covered), "{name}: {covered}");
    }
}

/// A stream of its own, seeded by another.
fn normal_noise_of(noise: &mut dyn FnMut() -> f64) -> impl FnMut() -> f64 + use<> {
    normal_noise(noise().to_bits())
}

#[test]
fn pooled_errors_hold_the_true_mean_square_in_95_percent_of_studies() {
    let mut noise = normal_noise(12);
    // Views of decibels v + .7 n: the mean of 10^(-x/10) is that of a log-normal law.
    let spread = std::f64::consts::LN_10 / 10.0;
    let mean_error = |sigma: f64| (0.5 * (spread * sigma).powi(2)).exp();
    let hits = (0..STUDIES).map(|_| {
        let mut drawn = normal_noise_of(&mut noise);
        let faces: Vec<Face> = (0..FACES)
            .map(|i| {
                let level = 30.0 + 1.5 * drawn();
                let views: Vec<f64> = (0..4).map(|_| level + 0.7 * drawn()).collect();
                let error = views.iter().map(|v| 10_f64.powf(-0.1 * v)).sum::<f64>() / 4.0;
                Face {
                    name: i.to_string(),
                    cells: vec![Cell { value: -10.0 * error.log10(), views }],
                }
            })
            .collect();
        let (value, ends) = pooled_decibels(&faces);
        let [low, high] = ends.unwrap();
        assert!(low < value && value < high);
        let truth = 30.0 - 10.0 * (mean_error(1.5) * mean_error(0.7)).log10();
        (low..=high).contains(&truth)
    });
    let covered = fraction(hits);
    println!("pooled {covered}");
    assert!((0.93..=0.97).contains(&covered), "{covered}");
}

#[test]
fn paired_tests_raise_a_false_alarm_in_5_percent_of_studies_and_find_what_is_there() {
    let mut noise = normal_noise(13);
    let mut differences = |shift: f64| -> Vec<f64> {
        // Two methods on the same faces: what a face does to both drops out.
        (0..FACES).map(|_| shift + noise() - 0.5 * noise()).collect()
    };
    let alarms = fraction((0..STUDIES).map(|_| sign_flip(&differences(0.0)).unwrap() <= 0.05));
    println!("false alarms {alarms}");
    assert!((0.03..=0.07).contains(&alarms), "{alarms}");
    // The power that the table promises is the power that there is.
    let deviation = 1.25_f64.sqrt();
    let found = fraction((0..STUDIES).map(|_| sign_flip(&differences(deviation)).unwrap() <= 0.05));
    let promised = power(1.0, FACES).unwrap();
    println!("found {found}, promised {promised}");
    assert!((found - promised).abs() < 0.05);
}

#[test]
fn sign_flips_and_holm_have_the_values_of_their_definitions() {
    // Of the 2^6 sums none but all plus and all minus is as far.
    assert_eq!(sign_flip(&[1.0, 2.0, 1.5, 0.5, 3.0, 0.1]), Some(2.0 / 64.0));
    assert_eq!(sign_flip(&[1.0, -1.0]), Some(1.0));
    assert_eq!(sign_flip(&[]), None);
    // scipy.stats.permutation_test(([...],), mean, permutation_type="samples"): .109375
    assert_eq!(sign_flip(&[1.0, 2.0, -0.5, 0.7, 1.1, -0.2, 0.4]), Some(14.0 / 128.0));
    // Random signs come near the exact share.
    let many: Vec<f64> = (0..17).map(|i| f64::from(i % 5) - 1.2).collect();
    let p = sign_flip(&many).unwrap();
    assert!((p - 0.105_865).abs() < 0.003, "{p}");
    // statsmodels.stats.multitest.multipletests(..., method="holm")
    let corrected = holm(&[0.01, 0.04, 0.03, 0.005]);
    for (found, expected) in corrected.iter().zip([0.03, 0.06, 0.06, 0.02]) {
        assert!((found - expected).abs() < 1e-12, "{corrected:?}");
    }
}

#[test]
fn powers_and_intervals_are_those_of_the_tables() {
    // G*Power 3.1, matched pairs, two-sided, 5 %, 80 %.
    for (effect, faces) in [(0.2, 199), (0.5, 34), (0.8, 15), (1.0, 10), (3.0, 6)] {
        assert_eq!(faces_needed(effect), Some(faces), "{effect}");
    }
    assert_eq!(faces_needed(0.0), None);
    // scipy.stats.t.interval, ttest_ind(equal_var=False).confidence_interval()
    let [low, high] = interval(&[1.0, 2.0, 4.0, 3.5]).unwrap();
    assert!((low - 0.434_057).abs() < 1e-5 && (high - 4.815_943).abs() < 1e-5, "{low} {high}");
    let [low, high] = welch(&[1.0, 2.0, 4.0, 3.5], &[0.5, 0.7, 0.1]).unwrap();
    assert!((low - 0.068_712).abs() < 1e-5 && (high - 4.314_621).abs() < 1e-5, "{low} {high}");
    assert_eq!(interval(&[1.0]), None);
    let g = effect_size(&[1.0, 2.0, 4.0, 3.5]).unwrap();
    assert!((g - 1.906_467 * (1.0 - 3.0 / 11.0)).abs() < 1e-6, "{g}");
}
