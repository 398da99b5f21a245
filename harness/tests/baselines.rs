//! Scores of the baselines on a capture whose every value is a formula.

#![allow(clippy::unwrap_used)]

#[path = "../scoring/tests/noise/mod.rs"]
mod noise;
#[path = "../scoring/tests/plane/mod.rs"]
mod plane;

use harness::suite::BaselineMethod;
use scoring::score::{Scores, score};

use plane::{SIDE, write_capture};

#[test]
fn the_semantic_initialisation_is_seen_through_where_the_mean_texture_is_not() {
    // The plane's pictures are its albedo, and its label images know one region.
    let root = tempfile::tempdir().unwrap();
    let capture = root.path().join("capture");
    write_capture(&capture, 1e-5);
    let scores = BaselineMethod::ALL.map(|method| {
        let maps = root.path().join(method.name());
        method.make(&capture, &maps, SIDE).unwrap();
        score(&capture, &maps, None).unwrap()
    });
    let [texture, semantic] = &scores;
    let row = |scores: &Scores, metric: &str, scale: &str| {
        scores.row(&format!("diffuse_albedo/{metric}@coverage-e5:{scale}")).unwrap().value
    };
    for mode in ["none", "global"] {
        assert!(row(texture, "psnr_srgb", mode).unwrap() > 40.0);
        let flat = row(semantic, "psnr_srgb", mode).unwrap();
        assert!(flat > 10.0 && flat < 25.0, "{mode}: {flat}");
    }
    // One colour follows nothing: its correlations are not defined, and not zero.
    assert!(row(texture, "wcorr", "none").unwrap() > 0.99);
    assert_eq!([row(semantic, "wcorr", "none"), row(semantic, "hc", "none")], [None, None]);
    assert!(row(semantic, "lp", "none").unwrap() > 0.1);
    assert!(semantic.row("specular_albedo/rmse@coverage-e5:none").is_none());
}
