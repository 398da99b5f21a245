//! Scores of a capture whose every value is a formula: what is planted must be found.

#![allow(clippy::unwrap_used)]

mod bench;
mod noise;
mod plane;

use std::fs;

use bench::{Bench, value, write_lights};
use formats::picture::{read_exr, read_png_gray, write_exr};
use noise::normal_noise;
use plane::{SIDE, albedo, map, shading, specular, write_halves, write_render, write_rgb};
use scoring::compare::{Baseline, Tolerances, Verdict, compare};
use scoring::metrics::{METRICS, Quantity};
use scoring::score::{Scores, fit_scale, label_mean_maps, oracle_maps, score};

#[test]
fn the_oracle_is_perfect_and_scores_survive_their_file() {
    let bench = Bench::new(1e-5);
    let maps = bench.root.path().join("oracle");
    oracle_maps(&bench.capture(), &maps).unwrap();
    let scores = score(&bench.capture(), &maps, None).unwrap();
    assert_eq!(
        (scores.solver.as_str(), scores.face.as_str(), scores.light.as_str()),
        ("oracle", "flat", "own")
    );
    for id in [
        "psnr_srgb@coverage-e5:none",
        "psnr_lin@coverage-e5:global",
        "psnr_srgb@coverage-e5.lips:none",
    ] {
        assert_eq!(value(&scores, &format!("diffuse_albedo/{id}")), 100.0);
    }
    for id in [
        "diffuse_albedo/flip_mean",
        "diffuse_albedo/ciede2000_mean",
        "specular_albedo/rmse",
        "specular_normal/normal_mean_deg",
        "diffuse_normal/normal_mean_deg",
    ] {
        assert_eq!(value(&scores, &format!("{id}@coverage-e5:none")), 0.0, "{id}");
    }
    // No error, so nothing explains it: null, not zero and not NaN.
    assert_eq!(
        scores.row("diffuse_albedo/leakage_shading@coverage-e5:global").unwrap().value,
        None
    );
    for (id, degrees) in [("mesh_specular_normal", 6.0), ("mesh_diffuse_normal", 3.0)] {
        let found = value(&scores, &format!("{id}/normal_mean_deg@coverage-e5:none"));
        assert!((found - degrees).abs() < 1e-4, "{id}: {found}");
    }
    let whole = scores.regions.iter().find(|region| region.region == "coverage-e5").unwrap();
    assert_eq!((whole.pixels, whole.solved), ((SIDE - 4) * (SIDE - 4), Some(1.0)));
    let path = bench.root.path().join("scores.json");
    scores.write(&path).unwrap();
    assert_eq!(Scores::read(&path).unwrap(), scores);
    assert_eq!(
        score(&bench.capture(), &maps, None).unwrap(),
        scores,
        "the same inputs, the same scores"
    );
}

#[test]
fn a_factor_is_found_by_its_scale_mode_and_undone() {
    let bench = Bench::new(1e-5);
    let scores = bench.score_albedo(|u, v| {
        let [r, g, b] = albedo(u, v);
        [r * 0.8, g * 0.9, b * 0.8]
    });
    let scale = scores.scale.clone().unwrap();
    assert_eq!(fit_scale(&bench.capture(), &bench.root.path().join("maps")).unwrap(), scale);
    for fitted in [scale.channel, scale.median] {
        for (k, expected) in fitted.iter().zip([1.25, 1.0 / 0.9, 1.25]) {
            assert!((k - expected).abs() < 1e-5, "{fitted:?}");
        }
    }
    let psnr = |mode| value(&scores, &format!("diffuse_albedo/psnr_srgb@coverage-e5:{mode}"));
    assert!(psnr("none") + 3.0 < psnr("global") && psnr("global") + 20.0 < psnr("channel"));
    assert!(value(&scores, "diffuse_albedo/hc@coverage-e5:none") > 0.999);
    assert!(value(&scores, "diffuse_albedo/lp@coverage-e5:none") < 0.01);
}

#[test]
fn an_error_finer_than_a_cell_of_the_surface_goes_with_its_mean() {
    let bench = Bench::new(1e-5);
    // A texel is 2.1 mm wide: cells of .5 and 1 mm hold one, those of 4 mm two by two or fewer.
    let checked = |fine: f64, coarse: f64| {
        let scores = bench.score_albedo(|u, v| {
            let texel = |at: f64| (at * SIDE as f64) as i64;
            let odd = (texel(u) + texel(v)) % 2 == 1;
            albedo(u, v).map(|a| a + coarse + if odd { fine } else { -fine })
        });
        ["", "-0.5mm", "-1mm", "-4mm"].map(|side| {
            value(&scores, &format!("diffuse_albedo/psnr_srgb_area@coverage-e5{side}:none"))
        })
    };
    let [texels, half, one, four] = checked(0.02, 0.0);
    assert!((half - texels).abs() < 1e-9 && (one - texels).abs() < 1e-9, "{half} {one} {texels}");
    assert!(four > texels + 6.0, "{four} {texels}");
    let [texels, _, _, four] = checked(0.0, 0.02);
    assert!((four - texels).abs() < 0.1, "{four} {texels}");
}

#[test]
fn baked_shading_and_baked_highlights_are_told_apart() {
    let bench = Bench::new(1e-5);
    let leak = |scores: &Scores, cause: &str| {
        value(scores, &format!("diffuse_albedo/leakage_{cause}@coverage-e5:global"))
    };
    let shaded = bench.score_albedo(|u, v| {
        let (a, s) = (albedo(u, v), shading(u, v));
        [0, 1, 2].map(|c| a[c] * s[c].sqrt())
    });
    // The texels see the shading through the interpolation of three views, hence not quite one.
    assert!(leak(&shaded, "shading") > 0.97, "{}", leak(&shaded, "shading"));
    assert!(leak(&shaded, "specular") < 0.5);
    let glossy = bench.score_albedo(|u, v| {
        let (a, s) = (albedo(u, v), specular(u, v));
        [0, 1, 2].map(|c| a[c] + 0.02 * s[c])
    });
    assert!(leak(&glossy, "specular") > 0.9, "{}", leak(&glossy, "specular"));
}

#[test]
fn a_confidence_that_knows_the_error_is_told_from_one_that_says_nothing() {
    let bench = Bench::new(1e-5);
    // Off by a factor of exp(u - 0.5), which one factor cannot undo.
    let maps = bench.albedo_maps(SIDE, |u, v| albedo(u, v).map(|a| a * (u - 0.5).exp()));
    let row = |scores: &Scores, metric: &str| {
        scores.row(&format!("confidence/{metric}@coverage-e5:global")).unwrap().value
    };
    let scores = score(&bench.capture(), &maps, None).unwrap();
    assert!(scores.rows.iter().all(|row| row.subject != "confidence"), "none was left");
    let k = scores.scale.unwrap().global.ln();
    let scored = |trust: &dyn Fn(f64) -> f64| {
        let confidence = map(SIDE, 1, |u, _| [trust(u); 3]);
        write_exr(&maps.join("confidence.exr"), &confidence, &["Y"]).unwrap();
        let scores = score(&bench.capture(), &maps, None).unwrap();
        [row(&scores, "confidence_rank"), row(&scores, "sparsification")]
    };
    // Deviations that are the errors themselves.
    let stated =
        map(SIDE, 3, |u, v| albedo(u, v).map(|a| a * ((u - 0.5).exp() - (-k).exp()).abs()));
    write_exr(&maps.join("diffuse_albedo_std.exr"), &stated, &["R", "G", "B"]).unwrap();
    let scores = score(&bench.capture(), &maps, None).unwrap();
    let of = |metric: &str| {
        let id = format!("diffuse_albedo_std/{metric}@coverage-e5:global");
        scores.row(&id).unwrap().value.unwrap()
    };
    assert!((of("deviation_68") - 1.0).abs() < 1e-3, "{}", of("deviation_68"));
    assert!((of("deviation_95") - 0.5).abs() < 1e-3, "{}", of("deviation_95"));
    // One channel stands for all; a negative one is refused.
    let one = |value: f64| {
        write_exr(&maps.join("diffuse_albedo_std.exr"), &map(SIDE, 1, |_, _| [value; 3]), &["Y"])
            .unwrap();
        score(&bench.capture(), &maps, None)
    };
    let rows = one(0.1).unwrap().rows;
    assert!(rows.iter().any(|row| row.metric == "deviation_68" && row.value.is_some()));
    assert!(one(-0.1).unwrap_err().to_string().contains("deviation is -0.1 at"));
    fs::remove_file(maps.join("diffuse_albedo_std.exr")).unwrap();
    let error = |u: f64| (u - 0.5 + k).abs();
    let [rank, sparse] = scored(&|u| 1.0 - error(u)).map(Option::unwrap);
    // Every column of the region has one error; the better half of them is trusted.
    let mut errors: Vec<f64> =
        (2..SIDE - 2).map(|x| error((x as f64 + 0.5) / SIDE as f64)).collect();
    errors.sort_by(f64::total_cmp);
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
    let expected = mean(&errors[..errors.len() / 2]) / mean(&errors);
    assert!(rank < -0.999 && (sparse - expected).abs() < 1e-3, "{rank} {sparse} {expected}");
    let [rank, sparse] = scored(&error).map(Option::unwrap);
    assert!(rank > 0.99 && sparse > 1.45, "{rank} {sparse}");
    assert_eq!(scored(&|_| 0.7)[0], None);
    assert!((scored(&|_| 0.7)[1].unwrap() - 1.0).abs() < 1e-9);
}

#[test]
fn label_means_are_flat_and_right_in_the_mean() {
    let bench = Bench::new(1e-5);
    let maps = bench.root.path().join("means");
    label_mean_maps(&bench.capture(), &maps).unwrap();
    let truth =
        read_exr(&bench.capture().join("truth/diffuse_albedo.exr"), &["R", "G", "B"]).unwrap();
    let flat = read_exr(&maps.join("diffuse_albedo.exr"), &["R", "G", "B"]).unwrap();
    let labels = read_png_gray(&bench.capture().join("truth/labels.png")).unwrap().data;
    let cover = read_png_gray(&maps.join("coverage.png")).unwrap().data;
    let mut seen = 0;
    for label in (1..=7).filter(|label| labels.contains(label)) {
        let texels: Vec<usize> =
            (0..labels.len()).filter(|i| labels[*i] == label && cover[*i] > 0).collect();
        let mean = |channel: usize| {
            let values = texels.iter().map(|i| f64::from(truth.data[3 * i + channel]));
            values.sum::<f64>() / texels.len() as f64
        };
        for channel in 0..3 {
            let expected = mean(channel);
            let here = |i: &usize| f64::from(flat.data[3 * i + channel]);
            assert!(texels.iter().all(|i| (here(i) - expected).abs() < 1e-4), "label {label}");
        }
        seen += 1;
    }
    assert!(seen >= 2, "{seen} labels");
    let scores = score(&bench.capture(), &maps, None).unwrap();
    assert_eq!(scores.solver, "label-means");
    assert!(value(&scores, "diffuse_albedo/psnr_srgb@coverage-e5:none") > 15.0);
    assert!(scores.row("specular_albedo/rmse@coverage-e5:none").is_none());

    fs::remove_dir_all(bench.capture().join("truth")).unwrap();
    let message = label_mean_maps(&bench.capture(), &maps).unwrap_err().to_string();
    assert!(message.contains("has no truth"), "{message}");
}

#[test]
fn every_metric_is_scored_of_something() {
    let bench = Bench::new(1e-5);
    let maps = bench.root.path().join("oracle");
    oracle_maps(&bench.capture(), &maps).unwrap();
    write_exr(&maps.join("confidence.exr"), &map(SIDE, 1, |u, _| [u; 3]), &["Y"]).unwrap();
    let stated = map(SIDE, 3, |_, _| [0.1; 3]);
    write_exr(&maps.join("diffuse_albedo_std.exr"), &stated, &["R", "G", "B"]).unwrap();
    for frame in [3, 4] {
        let view = maps.join(format!("views/{frame:03}.exr"));
        write_render(&view, frame, 0.0, &mut || 0.0, 1.0);
        let truth = bench.capture().join(format!("truth/relit/own/{frame:03}.exr"));
        write_halves(&truth, frame, 1e-5, &mut || 0.0, 1.0);
    }
    write_lights(&bench.capture(), &maps);
    let scores = score(&bench.capture(), &maps, None).unwrap();
    for metric in METRICS.iter().filter(|metric| metric.quantity != Quantity::Perceptual) {
        let found = scores.rows.iter().any(|row| row.metric == metric.id);
        assert!(found, "{} has no row: name it in metrics/registry.rs, scored", metric.id);
    }
}

#[test]
fn maps_of_another_size_are_resampled() {
    let bench = Bench::new(1e-5);
    for side in [SIDE / 2, SIDE * 2] {
        let maps = bench.albedo_maps(side, albedo);
        let scores = score(&bench.capture(), &maps, None).unwrap();
        let psnr = value(&scores, "diffuse_albedo/psnr_srgb@coverage-e5:none");
        assert!(psnr > 45.0 && psnr < 100.0, "{side}: {psnr}");
    }
}

#[test]
fn the_noise_floor_is_what_two_noisy_renders_score() {
    // Highlights beyond one and dark texels: the curve is bent and clips. Around 37 dB and above,
    // as renders are; at 30 dB the noise of the mean itself makes the floor 0.2 dB too low.
    for variance in [1e-5, 1e-4] {
        let bench = Bench::new(variance);
        let maps = bench.albedo_maps(SIDE, albedo);
        let relit = bench.root.path().join("relit");
        let mut noise = normal_noise(99);
        for (light, gain) in [("own", 1.0), ("other", 1.3)] {
            for frame in [3, 4] {
                let path = relit.join(format!("none/{light}/{frame:03}.exr"));
                write_render(&path, frame, variance, &mut noise, gain);
                // The solver's own view has no noise: the floor is the truth's alone.
                let path = maps.join(format!("views/{frame:03}.exr"));
                write_render(&path, frame, 0.0, &mut noise, 1.0);
            }
        }
        let scores = score(&bench.capture(), &maps, Some(&relit)).unwrap();
        for subject in ["relit/own", "relit/other", "view"] {
            for metric in ["psnr_srgb", "psnr_lin"] {
                let row = scores.row(&format!("{subject}/{metric}@mask-e5:none")).unwrap();
                let (value, floor) = (row.value.unwrap(), row.floor.unwrap());
                assert!((value - floor).abs() < 0.2, "{subject} {metric}: {value} {floor}");
                assert_eq!(row.per_frame.keys().collect::<Vec<_>>(), ["003", "004"]);
            }
        }
        assert!(
            scores.row("relit/own/psnr_srgb@mask-e5:global").is_none(),
            "nothing was relit with it"
        );
        let energy = value(&scores, "view_specular_layer/energy_ratio@mask-e5:none");
        assert!((energy - 1.0).abs() < 1e-6);
        assert_eq!(scores.row("view/ssim@mask-e5:none").unwrap().floor, None);
    }
}

#[test]
fn the_energy_of_highlights_is_scored_only_where_the_truth_has_several() {
    let bench = Bench::new(1e-5);
    let maps = bench.albedo_maps(SIDE, albedo);
    for frame in 3..5 {
        write_render(&maps.join(format!("views/00{frame}.exr")), frame, 0.0, &mut || 0.0, 1.0);
    }
    let energy = "view_specular_layer/energy_ratio@mask-e5:none";
    assert!(score(&bench.capture(), &maps, None).unwrap().row(energy).is_some());
    let one = map(SIDE, 1, |_, _| [0.028; 3]);
    write_exr(&bench.capture().join("truth/specular_albedo.exr"), &one, &["Y"]).unwrap();
    let scores = score(&bench.capture(), &maps, None).unwrap();
    assert!(scores.row(energy).is_none());
    for row in ["view_specular_layer/pearson", "view_diffuse_layer/energy_ratio"] {
        assert!(scores.row(&format!("{row}@mask-e5:none")).is_some(), "{row}");
    }
}

#[test]
fn missing_files_have_no_rows_and_broken_ones_are_named() {
    let bench = Bench::new(1e-5);
    let maps = bench.albedo_maps(SIDE, albedo);
    let scores = score(&bench.capture(), &maps, None).unwrap();
    assert!(
        scores
            .rows
            .iter()
            .all(|row| !row.subject.starts_with("view") && !row.subject.starts_with("relit"))
    );
    assert!(scores.row("specular_normal/normal_mean_deg@coverage-e5:none").is_none());

    let empty = bench.root.path().join("empty");
    fs::create_dir(&empty).unwrap();
    assert!(bench.refused(&empty, None).contains("empty"));
    assert!(bench.refused(&bench.root.path().join("absent"), None).contains("absent"));

    write_render(&maps.join("views/003.exr"), 3, 0.0, &mut || 0.0, 1.0);
    let error = bench.refused(&maps, None);
    assert!(error.contains("004.exr") && error.contains("is missing"), "{error}");
    write_rgb(&maps.join("views/004.exr"), &map(SIDE / 2, 3, albedo));
    let error = bench.refused(&maps, None);
    assert!(error.contains("004.exr: is 48x48, expected 96x96"), "{error}");
    fs::remove_dir_all(maps.join("views")).unwrap();

    write_rgb(&maps.join("diffuse_albedo.exr"), &map(SIDE, 3, |_, _| [0.0; 3]));
    let error = bench.refused(&maps, None);
    assert!(error.contains("diffuse_albedo: no factor fits"), "{error}");
    // With its cameras it would be a capture that was photographed.
    fs::remove_dir_all(bench.capture().join("truth")).unwrap();
    fs::remove_file(bench.capture().join("transforms.json")).unwrap();
    assert!(bench.refused(&maps, None).contains("has no truth"));
}

#[test]
fn a_worse_albedo_turns_red_and_no_change_never_does() {
    let bench = Bench::new(1e-5);
    // A recovered albedo as they are: a little too bright, some shading left, no finest detail.
    let recovered = |u: f64, v: f64| {
        let (a, s) = (albedo(u, v), shading(u, v));
        [0, 1, 2].map(|c| 1.05 * a[c] * s[c].powf(0.15) + 0.01 * (80.0 * u).sin())
    };
    let collect = |scores: &Scores| {
        let mut baseline = Baseline::new("planted");
        baseline.add("case/solver", scores);
        baseline
    };
    let tolerances = Tolerances::built_in().unwrap();
    let before = collect(&bench.score_albedo(recovered));
    let same = compare(&collect(&bench.score_albedo(recovered)), &before, &tolerances).unwrap();
    assert!(same.passed() && same.count(Verdict::Same) == before.rows.len());

    let mut noise = normal_noise(5);
    let noise: Vec<f64> = (0..SIDE * SIDE).map(|_| noise()).collect();
    let texel =
        |u: f64, v: f64| (((1.0 - v) * SIDE as f64) as usize * SIDE) + (u * SIDE as f64) as usize;
    type Change<'a> = (&'a str, &'a dyn Fn(f64, f64) -> [f64; 3], &'a str);
    let worse: [Change; 3] = [
        (
            "brighter by 2 %",
            &|u, v| recovered(u, v).map(|a| 1.02 * a),
            "scale_global@coverage-e5:none",
        ),
        (
            "darker by 2 %",
            &|u, v| recovered(u, v).map(|a| 0.98 * a),
            "scale_global@coverage-e5:none",
        ),
        (
            "noise of 2 % per texel",
            &|u, v| recovered(u, v).map(|a| a * (1.0 + 0.02 * noise[texel(u, v)])),
            "psnr_srgb@coverage-e5:global",
        ),
    ];
    for (what, texture, found_by) in worse {
        let verdict =
            compare(&collect(&bench.score_albedo(texture)), &before, &tolerances).unwrap();
        let id = format!("case/solver/diffuse_albedo/{found_by}");
        let row = verdict.rows.iter().find(|row| row.id == id).unwrap();
        assert!(!verdict.passed() && row.verdict == Verdict::Worse, "{what}: {row:?}");
        assert!(verdict.table().contains(&id), "{}", verdict.table());
    }
}
