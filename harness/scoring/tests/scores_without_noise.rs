//! Scores from independent halves of the samples say the planted error, and of none nothing.

#![allow(clippy::unwrap_used)]

mod bench;
mod noise;
mod plane;

use bench::{Bench, value};
use noise::normal_noise;
use plane::{SIDE, albedo, write_halves, write_render};
use scoring::score::{Scores, score};

/// Relit pictures and truth with noise of a variance, the one of scale `global` too bright by 5 % of
/// the diffuse layer.
fn noisy(variance: f64) -> (Bench, Scores) {
    let bench = Bench::new(0.0);
    let maps = bench.albedo_maps(SIDE, albedo);
    let relit = bench.root.path().join("relit");
    let mut noise = normal_noise(5);
    for (folder, gain) in [("none", 1.0), ("global", 1.05)] {
        for (light, own) in [("own", 1.0), ("other", 1.3)] {
            for frame in [3, 4] {
                let path = relit.join(format!("{folder}/{light}/{frame:03}.exr"));
                write_halves(&path, frame, variance, &mut noise, own * gain);
                let truth = bench.capture().join(format!("truth/relit/{light}/{frame:03}.exr"));
                write_halves(&truth, frame, variance, &mut noise, own);
            }
        }
    }
    let scores = score(&bench.capture(), &maps, Some(&relit)).unwrap();
    (bench, scores)
}

/// Scores of this error without any noise.
fn exact() -> Scores {
    let bench = Bench::new(0.0);
    let relit = bench.root.path().join("relit");
    for frame in [3, 4] {
        for (light, own) in [("own", 1.0), ("other", 1.3)] {
            let path = relit.join(format!("global/{light}/{frame:03}.exr"));
            write_render(&path, frame, 0.0, &mut || 0.0, 1.05 * own);
        }
    }
    score(&bench.capture(), &bench.albedo_maps(SIDE, albedo), Some(&relit)).unwrap()
}

#[test]
fn a_planted_error_below_the_noise_is_found_and_none_is_infinite() {
    let exact = exact();
    // The noise of 1e-3 is 16 dB above the error, and bends sRGB values: only linear ones are exact.
    for (variance, spaces) in [(1e-3, &["lin"][..]), (1e-4, &["lin", "srgb"])] {
        let (_bench, scores) = noisy(variance);
        for (light, space) in
            ["own", "other"].into_iter().flat_map(|light| spaces.iter().map(move |s| (light, *s)))
        {
            let row = |scale: &str| {
                let id = format!("relit/{light}/psnr_{space}_unbiased@mask-e5:{scale}");
                scores.row(&id).unwrap()
            };
            // Nothing is wrong: an infinite score is within the interval.
            assert_eq!(row("none").ci95.unwrap()[1], 100.0, "{light} {space}");
            let id = format!("relit/{light}/psnr_{space}@mask-e5:global");
            let (truth, as_rendered) = (value(&exact, &id), value(&scores, &id));
            let [low, high] = row("global").ci95.unwrap();
            println!(
                "{variance} {light} {space}: {truth:.2} in {low:.2} .. {high:.2}; {as_rendered:.2}"
            );
            assert!(as_rendered < truth - 3.0, "{light} {space}: the noise is below the error");
            assert!(low <= truth && truth <= high && high < 60.0, "{light} {space}");
        }
    }
}

#[test]
fn a_picture_without_halves_has_no_such_score() {
    let exact = exact();
    assert!(exact.rows.iter().all(|row| !row.metric.ends_with("unbiased")));
}
