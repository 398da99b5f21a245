//! `unshade compare`: what moved is judged by direction and tolerance, and told as text and XML.

#![allow(clippy::unwrap_used)]

use std::fs;

use quick_junit::Report;
use scoring::compare::{Baseline, CompareError, Entry, Places, Tolerances, Verdict, compare};

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
            && table.contains("no rate of false alarms is known"),
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
        "cases": [{"id": "ada-studio", "solvers": [{"id": "unshade", "scores": "scores/a.json"}]}],
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
