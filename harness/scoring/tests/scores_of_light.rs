//! A light that was found against the true one.

#![allow(clippy::unwrap_used)]

mod bench;
mod noise;
mod plane;

use std::fs;

use bench::{Bench, value, write_lights};
use plane::{SIDE, albedo};
use scoring::score::score;
use scoring::study::{Study, observations};

#[test]
fn a_light_is_scored_by_its_directions_after_one_factor() {
    let bench = Bench::new(1e-5);
    let maps = bench.albedo_maps(SIDE, albedo);
    assert!(
        score(&bench.capture(), &maps, None).unwrap().row("light/log_rmse@whole:global").is_none()
    );
    write_lights(&bench.capture(), &maps);
    let scores = score(&bench.capture(), &maps, None).unwrap();
    // One lamp is 5.6° of azimuth aside, at 30 % of the way down: by sin(54°); the other a row's half.
    let peaks = value(&scores, "light_peaks/direction_mean_deg@whole:none");
    assert!((1.5..5.0).contains(&peaks), "{peaks}");
    for sphere in ["mirror", "glossy", "diffuse"] {
        let row =
            |metric: &str| value(&scores, &format!("light_{sphere}_sphere/{metric}@sphere:global"));
        assert!(row("psnr_srgb") > 20.0, "{sphere}");
    }
    assert!(value(&scores, "light_diffuse_sphere/chromaticity_deg@sphere:global") < 1e-3);
    // The same light, its rows taken for bands between the poles, is nearly the same light.
    fs::copy(bench.capture().join("truth/light.exr"), maps.join("light.exr")).unwrap();
    let scores = score(&bench.capture(), &maps, None).unwrap();
    let diffuse = value(&scores, "light_diffuse_sphere/psnr_srgb@sphere:global");
    let mirror = value(&scores, "light_mirror_sphere/psnr_srgb@sphere:global");
    assert!(diffuse > 35.0 && mirror > 35.0, "{diffuse} {mirror}");
}

#[test]
fn a_study_shows_the_light_that_was_found() {
    let bench = Bench::new(1e-5);
    let (maps, run) = (bench.albedo_maps(SIDE, albedo), bench.root.path().join("run"));
    write_lights(&bench.capture(), &maps);
    fs::create_dir(&run).unwrap();
    score(&bench.capture(), &maps, None).unwrap().write(&run.join("scores.json")).unwrap();
    let method = serde_json::json!({"id": "own", "kind": "solver", "scores": "scores.json"});
    let case = serde_json::json!({
        "id": "flat-own", "face": "flat", "light": "own", "variant": null, "seed": null,
        "capture": "capture", "solvers": [method],
    });
    let file = serde_json::json!({"format": 1, "suite": "one", "cases": [case]});
    fs::write(run.join("run.json"), file.to_string()).unwrap();
    let page = Study::of(&observations(&[run]).unwrap()).markdown("unshade study");
    for figure in ["light_peaks/direction_mean_deg@whole:none", "light/log_rmse@whole:global"] {
        assert!(page.contains(figure), "{figure}\n{page}");
    }
}
