//! `unshade compare`: what moved is judged by direction and tolerance, and told as text and XML.

#![allow(clippy::unwrap_used)]

use std::fs;

use quick_junit::Report;
use scoring::compare::{
    Baseline, Calibration, Captured, CompareError, Entry, Places, Tolerances, Verdict, compare,
};

const PSNR: &str = "ada-studio/unshade/diffuse_albedo/psnr_srgb@coverage-e5:global";
const FLIP: &str = "ada-studio/unshade/relit/flash/flip_mean@mask-e5:global";
const SCALE: &str = "ada-studio/oracle/diffuse_albedo/scale_global@coverage-e5:none";

fn baseline(rows: &[(&str, Option<f64>)]) -> Baseline {
    let mut baseline = Baseline::new("demo");
    for (id, value) in rows {
        let entry = Entry { value: *value, ci95: value.map(|v| [v - 1.0, v + 1.0]), n: 10 };
        baseline.rows.insert((*id).to_owned(), entry);
    }
    baseline
}

fn verdict(id: &str, old: Option<f64>, new: Option<f64>) -> Verdict {
    let tolerances = Tolerances::built_in().unwrap();
    let (old, new) = (baseline(&[(id, old)]), baseline(&[(id, new)]));
    compare(&new, &old, &tolerances).unwrap().rows[0].verdict
}

#[test]
fn a_message_is_one_line_whatever_a_row_is_called() {
    let odd = baseline(&[("a/b/c\nd/no@x:none", Some(1.0))]);
    let error = compare(&odd, &odd, &Tolerances::built_in().unwrap()).unwrap_err();
    let message = error.to_string();
    assert!(message.starts_with("a/b/c d/no@x") && message.lines().count() == 1, "{message}");
}

#[test]
fn direction_and_tolerance_decide() {
    for (id, old, new, expected) in [
        (PSNR, 28.0, 27.85, Verdict::Worse),
        (PSNR, 28.0, 27.95, Verdict::Same),
        (PSNR, 28.0, 28.2, Verdict::Better),
        (FLIP, 0.1, 0.102, Verdict::Worse),
        (FLIP, 0.1, 0.098, Verdict::Better),
        (FLIP, 0.0, 0.0, Verdict::Same),
        // Brightness must not move at all, not even towards one.
        (SCALE, 1.05, 1.03, Verdict::Worse),
        (SCALE, 1.05, 1.045, Verdict::Same),
    ] {
        assert_eq!(verdict(id, Some(old), Some(new)), expected, "{id}: {old} {new}");
    }
    assert_eq!(verdict(PSNR, Some(28.0), None), Verdict::Missing, "a number became null");
    assert_eq!(verdict(PSNR, None, None), Verdict::Same);
    assert_eq!(verdict(PSNR, None, Some(1.0)), Verdict::New);
}

#[test]
fn missing_rows_fail_and_new_ones_are_noted() {
    let tolerances = Tolerances::built_in().unwrap();
    let old = baseline(&[(PSNR, Some(28.0)), (FLIP, None)]);
    let new = baseline(&[(PSNR, Some(28.0)), (SCALE, Some(1.0))]);
    let comparison = compare(&new, &old, &tolerances).unwrap();
    let verdicts: Vec<_> =
        comparison.rows.iter().map(|row| (row.id.as_str(), row.verdict)).collect();
    assert_eq!(verdicts, [(FLIP, Verdict::Missing), (SCALE, Verdict::New), (PSNR, Verdict::Same)]);
    assert!(!comparison.passed());
    assert!(compare(&old, &old, &tolerances).unwrap().passed());
    let table = comparison.table();
    assert!(
        table.contains("MISSING")
            && table.contains("demo: REGRESSION: 0 worse, 1 missing, 1 new, 1 same\n")
            && table.contains("false-alarm rate unknown"),
        "{table}"
    );
}

#[test]
fn the_verdicts_are_valid_junit() {
    let tolerances = Tolerances::built_in().unwrap();
    let old = baseline(&[(PSNR, Some(28.0)), (FLIP, Some(0.1)), (SCALE, Some(1.0))]);
    let new = baseline(&[(PSNR, Some(27.0)), (FLIP, Some(0.1))]);
    let comparison = compare(&new, &old, &tolerances).unwrap();
    let places = Places::from([("ada-studio".to_owned(), ("scenes/faces/ada.toml".to_owned(), 3))]);
    let xml = comparison.junit(&places).unwrap();
    assert_eq!(xml, comparison.junit(&places).unwrap());
    assert!(xml.contains("file=\"scenes/faces/ada.toml\" line=\"3\""), "{xml}");
    let report = Report::deserialize_from_str(&xml).unwrap();
    assert_eq!((report.tests, report.failures), (3, 2));
    let suites: Vec<_> = report.test_suites.iter().map(|suite| suite.name.as_str()).collect();
    assert_eq!(suites, ["ada-studio/oracle", "ada-studio/unshade"]);
    assert!(xml.contains("28.00000 -&gt; 27.00000 dB, allowed 0.10000"), "{xml}");
}

#[test]
fn a_baseline_survives_its_file_and_an_empty_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("baseline.json");
    let old = baseline(&[(PSNR, Some(28.123_456_789)), (FLIP, None)]);
    old.write(&path).unwrap();
    assert_eq!(Baseline::read(&path).unwrap(), old);
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(
        text.lines().filter(|line| line.contains('@')).count(),
        2,
        "one row per line: {text}"
    );

    Baseline::new("demo").write(&path).unwrap();
    assert!(matches!(Baseline::read(&path), Err(CompareError::Empty(_))));
    for broken in ["{", "{}", "{\"format\": 9, \"suite\": \"\", \"versions\": {}, \"rows\": {}}"] {
        fs::write(&path, broken).unwrap();
        let error = Baseline::read(&path).unwrap_err().to_string();
        assert!(error.contains("baseline.json") && !error.contains('\n'), "{error}");
    }
    let unknown = baseline(&[("a/b/view/loveliness@mask-e5:none", Some(1.0))]);
    let error =
        compare(&unknown, &unknown, &Tolerances::built_in().unwrap()).unwrap_err().to_string();
    assert!(error.contains("loveliness") && !error.contains('\n'), "{error}");
}

#[test]
fn a_run_folder_becomes_a_baseline() {
    let run = tempfile::tempdir().unwrap();
    let missing = Baseline::of_run(run.path()).unwrap_err().to_string();
    assert!(missing.contains("run.json"), "{missing}");
    let manifest = serde_json::json!({
        "format": 1, "suite": "demo", "versions": {"unshade": "0.1.0"},
        "cases": [{"id": "ada-studio", "face": "ada", "light": "studio", "capture": "c",
                   "solvers": [{"id": "unshade", "kind": "solver", "scores": "scores/a.json"}]}],
    });
    fs::write(run.path().join("run.json"), manifest.to_string()).unwrap();
    let scores = serde_json::json!({
        "format": 1, "capture": "c", "face": "ada", "light": "studio", "solver": "unshade",
        "protocol": {"id": "unshade-1", "statements": []},
        "inputs": {"capture": "", "maps": "", "relit": null}, "scale": null, "regions": [],
        "rows": [{"subject": "relit", "metric": "flip_mean", "scale": "global", "region": "mask-e5",
                  "label": null, "light": "flash", "value": 0.1, "ci95": [0.05, 0.2], "n": 7,
                  "floor": null}],
    });
    fs::create_dir(run.path().join("scores")).unwrap();
    fs::write(run.path().join("scores/a.json"), scores.to_string()).unwrap();
    let baseline = Baseline::of_run(run.path()).unwrap();
    assert_eq!(baseline.rows[FLIP], Entry { value: Some(0.1), ci95: Some([0.05, 0.2]), n: 7 });
    assert_eq!(baseline.versions["unshade"], "0.1.0");
}

/// Runs of one suite whose scores share most of their noise, as scores do.
fn seed_runs(runs: usize, shift: f64) -> Vec<Baseline> {
    let random = |at: usize| {
        // Sums of twelve uniform numbers: normal enough, and the same every time.
        let mut state = at as u64 * 7919 + 1;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 31)
        };
        (0..24).map(|_| uniform()).sum::<f64>() - 12.0
    };
    let run = |at: usize| {
        let (shared, own) = (0.02 * random(2 * at), 0.005 * random(2 * at + 1));
        let mut run = baseline(&[
            (PSNR, Some(28.0 + shared + own - shift)),
            (FLIP, Some(0.1 * (0.02 * shared).exp())),
            (SCALE, Some(1.0)),
        ]);
        run.suite_hash = Some("a".to_owned());
        run
    };
    (0..runs).map(run).collect()
}

#[test]
fn measured_tolerances_see_what_they_say_and_survive_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tolerances.toml");
    let rules = Tolerances::built_in().unwrap();
    let runs = seed_runs(24, 0.0);
    let calibration = Calibration::of_runs(&runs[..12], &rules, 0.01).unwrap();
    calibration.write(&path).unwrap();
    let measured = Tolerances::read(&path).unwrap();
    let row = calibration.rows[PSNR];
    assert_eq!(measured.calibration().unwrap().rows.len(), 3);
    assert!(!row.relative && calibration.rows[FLIP].relative, "errors are multiplied by chance");
    for (old, new) in runs[12..].iter().zip(&runs[13..]) {
        let comparison = compare(new, old, &measured).unwrap();
        assert!(
            comparison.passed() && comparison.count(Verdict::Better) == 0,
            "{}",
            comparison.table()
        );
        assert!(comparison.table().contains("1 % false alarms over all rows"));
    }
    // A change that is seen with probability 0.9, planted in twelve runs; and one of the row's spread.
    let planted = |shift: f64| {
        let changed = seed_runs(24, shift);
        let pairs = changed[12..].iter().zip(&runs[..12]);
        let seen = pairs.filter(|(new, old)| !compare(new, old, &measured).unwrap().passed());
        seen.count()
    };
    assert!(planted(row.sees) >= 9, "{} of 12", planted(row.sees));
    assert_eq!(planted(row.sd), 0);
    // What never moved is seen when it moves.
    let mut moved = runs[0].clone();
    moved.rows.insert(SCALE.to_owned(), Entry { value: Some(1.006), ci95: None, n: 10 });
    let comparison = compare(&moved, &runs[0], &measured).unwrap();
    assert_eq!(comparison.count(Verdict::Worse), 1, "{}", comparison.table());
    // Against the mean of twelve runs a smaller change is enough.
    let mean = Baseline::mean(&runs[..12]).unwrap();
    let change = |baseline: &Baseline| {
        let rows = compare(&runs[20], baseline, &measured).unwrap().rows;
        rows.into_iter().find(|row| row.id == PSNR).unwrap().allowed
    };
    assert!((change(&mean) / change(&runs[0]) - (13.0_f64 / 24.0).sqrt()).abs() < 1e-9);
}

#[test]
fn a_spread_on_kept_captures_is_for_comparisons_of_the_same_captures() {
    let on = |mut run: Baseline, hash: Option<&str>| {
        let (face, light) = ("ada".to_owned(), "studio".to_owned());
        let capture = hash.map(str::to_owned);
        run.cases.insert("ada-studio".to_owned(), Captured { face, light, capture });
        run
    };
    let rules = Tolerances::built_in().unwrap();
    let kept: Vec<Baseline> = seed_runs(6, 0.0).into_iter().map(|run| on(run, Some("a"))).collect();
    let mean = Baseline::mean(&kept).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tolerances.toml");
    Calibration::of_runs(&kept, &rules, 0.01).unwrap().write(&path).unwrap();
    let measured = Tolerances::read(&path).unwrap();
    assert_eq!(measured.calibration().unwrap().captures["ada-studio"], "a");
    let same = compare(&kept[1], &mean, &measured).unwrap();
    assert!(same.differences.is_empty() && same.tolerances.ends_with("on cached captures"));
    // Both on another machine's captures: the spread is still of the methods' seeds alone.
    let elsewhere = |run: &Baseline| on(run.clone(), Some("b"));
    let other = compare(&elsewhere(&kept[1]), &elsewhere(&kept[0]), &measured).unwrap();
    assert_eq!(other.differences, ["tolerances measured on other captures that were kept"]);
    let unknown = on(kept[0].clone(), None);
    for (new, old) in [
        (&elsewhere(&kept[1]), &kept[0]),
        (&kept[1], &unknown),
        (&unknown, &unknown),
        (&kept[1], &seed_runs(1, 0.0)[0]),
    ] {
        let error = compare(new, old, &measured).unwrap_err().to_string();
        assert!(error.starts_with("ada-studio: ") && error.contains("--vary both"), "{error}");
    }
    // One run of other captures, and the spread is of both.
    let mut mixed = kept.clone();
    mixed[3] = elsewhere(&mixed[3]);
    assert!(Calibration::of_runs(&mixed, &rules, 0.01).unwrap().captures.is_empty());
    assert_eq!(Baseline::mean(&mixed).unwrap().cases["ada-studio"].capture, None);
}

#[test]
fn few_runs_and_broken_calibrations_are_refused() {
    let rules = Tolerances::built_in().unwrap();
    let error = Calibration::of_runs(&seed_runs(3, 0.0), &rules, 0.01).unwrap_err().to_string();
    assert!(error.contains("3 runs are too few"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.toml");
    let head = "format = 2\n[calibration]\nsuite = \"s\"\nfalse_alarms = 0.01\n";
    for (text, expected) in [
        ("format = 2\n".to_owned(), "no [calibration]"),
        (format!("{head}runs = 2\n[calibration.rows]\n"), "at least 4"),
        (format!("{head}runs = 8\ncritical = -1.0\n[calibration.rows]\n"), "critical"),
        (
            format!(
                "{head}runs = 8\n[calibration.rows]\na = {{ sd = nan, matters = 0.1, sees = 0.1, power = 1.0 }}\n"
            ),
            "infinite spread",
        ),
    ] {
        fs::write(&path, text).unwrap();
        let error = Tolerances::read(&path).unwrap_err().to_string();
        assert!(error.contains(expected) && error.lines().count() == 1, "{error}");
    }
}

#[test]
fn undecided_rows_are_neither_the_same_nor_a_failure() {
    let rules = Tolerances::built_in().unwrap();
    let noisy: Vec<Baseline> = [27.0, 28.0, 29.0, 28.5, 27.5]
        .iter()
        .map(|psnr| baseline(&[(PSNR, Some(*psnr))]))
        .collect();
    let measured =
        Tolerances::calibrated(Calibration::of_runs(&noisy, &rules, 0.01).unwrap()).unwrap();
    let comparison = compare(&noisy[0], &noisy[2], &measured).unwrap();
    assert_eq!(comparison.rows[0].verdict, Verdict::CannotTell);
    assert!(comparison.passed());
    assert_eq!(compare(&noisy[0], &noisy[0], &measured).unwrap().rows[0].verdict, Verdict::Same);
    assert!(comparison.junit(&Places::new()).unwrap().contains("<skipped"));
}

#[test]
fn a_map_accounts_for_its_pictures_and_the_oracle_for_the_pipeline() {
    let tolerances = Tolerances::built_in().unwrap();
    let (a, b) = ("mei-flash/unshade", "mei-studio/unshade");
    let albedo = "diffuse_albedo/scale_global@coverage-e5:none";
    let relit = "relit/flash/psnr_srgb@mask-e5:global";
    let rows = |scale: f64, psnr: f64, oracle: f64| {
        let rows = [
            (format!("{a}/{albedo}"), scale),
            (format!("{b}/{albedo}"), scale),
            (format!("{a}/{relit}"), psnr),
            (format!("mei-studio/oracle/{relit}"), oracle),
        ];
        let rows: Vec<(&str, Option<f64>)> =
            rows.iter().map(|(id, value)| (id.as_str(), Some(*value))).collect();
        let mut run = baseline(&rows);
        for (case, light) in [("mei-flash", "flash"), ("mei-studio", "studio")] {
            let (face, light) = ("mei".to_owned(), light.to_owned());
            run.cases.insert(case.to_owned(), Captured { face, light, capture: None });
        }
        run
    };
    let old = rows(1.0, 30.0, 40.0);
    let sentences = |new: &Baseline| -> Vec<String> {
        let findings = compare(new, &old, &tolerances).unwrap().findings();
        findings.into_iter().map(|finding| finding.sentence).collect()
    };
    assert_eq!(
        sentences(&rows(1.021, 29.0, 40.0)),
        [
            "diffuse albedo of `unshade` is 2.1 % darker than the baseline's (2.1 % too dark against \
             the truth) under flash and studio; so do the pictures that are made with it (rows: 1)"
        ]
    );
    let pictures = sentences(&rows(1.0, 29.0, 40.0));
    assert!(
        pictures[0].starts_with("relit of `unshade` is 1.00 dB worse (PSNR 30.00 -> 29.00 dB)")
    );
    assert!(pictures[0].ends_with("no map that it is made of moved as far"), "{pictures:?}");
    let pipeline = sentences(&rows(1.5, 29.0, 30.0));
    assert!(pipeline.len() == 2 && pipeline[0].contains("no method caused this"), "{pipeline:?}");
}
