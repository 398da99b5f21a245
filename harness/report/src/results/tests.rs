use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{failures_in_lines, write_results};
use crate::sample_run;

/// The sample run once more, with a second face whose scores all differ by `offset`.
fn two_faces(run: &Path, offset: f64) {
    sample_run::write(run);
    let mut manifest = read(&run.join("run.json"));
    let mut cases = manifest["cases"].as_array().unwrap().clone();
    for case in cases.clone() {
        let text = case.to_string().replace("demo", "eve");
        let mut case: Value = serde_json::from_str(&text).unwrap();
        case["capture"] = json!(case["capture"].as_str().unwrap().replace("eve", "demo"));
        for solver in case["solvers"].as_array().unwrap() {
            let path = solver["scores"].as_str().unwrap();
            let mut scores = read(&run.join(path.replace("eve", "demo")));
            for row in scores["rows"].as_array_mut().unwrap() {
                row["value"] = json!(row["value"].as_f64().unwrap() + offset);
            }
            save(&run.join(path), &scores);
        }
        cases.push(case);
    }
    manifest["cases"] = json!(cases);
    save(&run.join("run.json"), &manifest);
}

fn read(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn save(path: &Path, value: &Value) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, value.to_string()).unwrap();
}

fn results(root: &Path, runs: &[&str]) -> Result<String, String> {
    written(root, runs, "docs/results.md")
}

fn written(root: &Path, runs: &[&str], file: &str) -> Result<String, String> {
    let runs: Vec<PathBuf> = runs.iter().map(|run| root.join(run)).collect();
    let out = root.join(file);
    let written = write_results(&runs, &out, "unshade table RUN -o docs/results.md");
    written.map_err(|error| error.to_string())?;
    Ok(fs::read_to_string(out).unwrap())
}

/// The cells of a table's row under a heading.
fn cells(text: &str, section: &str, table: &str, method: &str) -> Vec<String> {
    let section = text.split(&format!("\n### {section}\n")).nth(1).unwrap();
    let table = section.split(&format!("\n{table}\n")).nth(1).unwrap();
    let line = table.lines().find(|line| line.starts_with(&format!("| {method}"))).unwrap();
    line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned()).collect()
}

const UNSHADE: &str = "&lt;unshade&gt; &amp; co";
const BASELINE: &str = "&lt;mean\\_texture&gt; &amp; co";
const ORACLE: &str = "&lt;oracle&gt; &amp; co";

#[test]
fn means_and_ranges_are_over_the_faces() {
    let root = tempfile::tempdir().unwrap();
    two_faces(&root.path().join("run"), 1.0);
    let text = results(root.path(), &["run"]).unwrap();
    // The scores of the sample run: 32.04 dB after one factor, one less without, a dB more for eve.
    // Student's t of two faces: 12.7 times .5 dB.
    let albedo = cells(&text, "flash light", "Diffuse albedo", UNSHADE);
    assert_eq!(albedo, [UNSHADE, "**32.5** ± 6.4 (32.0 … 33.0)", "**31.5** ± 6.4 (31.0 … 32.0)"]);
    let pictures = cells(&text, "flash light", "Withheld views, PSNR in dB", UNSHADE);
    assert_eq!(
        pictures[1..],
        [
            "36.5 ± 6.4 (36.0 … 37.0)",
            "**32.5** ± 6.4 (32.0 … 33.0)",
            "**33.5** ± 6.4 (33.0 … 34.0)"
        ]
    );
    // The oracle is better and wins nothing.
    let oracle = cells(&text, "flash light", "Diffuse albedo", ORACLE);
    assert_eq!(oracle[1], "54.5 ± 6.4 (54.0 … 55.0)");
    // 4 degrees where the mesh has 3.5, then 5 and 4.5.
    let normals = cells(&text, "uniform light", "Normals and specular parts", UNSHADE);
    assert!(normals[1].starts_with("4.50 / 4.00 = 11"), "{normals:?}");
    assert!(normals[1].ends_with(" % ± 20 (111 … 114)"), "{normals:?}");
    let baseline = cells(&text, "uniform light", "Normals and specular parts", BASELINE);
    assert_eq!(baseline[1], "–");
    assert!(text.contains("maps relit, other lights (uniform)"));
    // The floors of the sample oracle are 1.3 times its values, alike for both faces.
    let floor = cells(&text, "flash light", "Withheld views, PSNR in dB", "noise floor");
    assert_eq!(floor[2], "70.2 ± 0.0 (70.2 … 70.2)");
    assert_eq!(text.matches("\n### demo\n").count() + text.matches("\n### eve\n").count(), 2);
    assert!(text.contains("Maps are compared in texture space."), "the protocol");
}

#[test]
fn the_ending_of_the_file_says_markdown_latex_or_csv() {
    let root = tempfile::tempdir().unwrap();
    two_faces(&root.path().join("run"), 1.0);
    let latex = written(root.path(), &["run"], "t.tex").unwrap();
    assert!(latex.contains("% Two <balls>: flash light: Diffuse albedo\n\\begin{tabular}{lrr}"));
    let row = "\\textless{}unshade\\textgreater{} \\& co & \\textbf{32.5} ± 6.4";
    assert!(latex.contains(row), "{latex}");
    let csv = written(root.path(), &["run"], "t.csv").unwrap();
    let line = csv
        .lines()
        .find(|line| line.contains("flash,,<unshade> & co,Diffuse albedo,\"after"))
        .unwrap();
    let cells: Vec<&str> = line.split(',').rev().take(6).collect();
    let mean: f64 = cells[5].parse().unwrap();
    assert!(cells[0] == "2" && (mean - 32.541).abs() < 1e-2, "{line}");
    let message = written(root.path(), &["run"], "t.docx").unwrap_err();
    assert!(message.contains("t.docx: cannot tell the format") && message.contains(".tex or .csv"));
}

#[test]
fn photographs_have_their_figures_and_no_word_of_a_truth() {
    let root = tempfile::tempdir().unwrap();
    sample_run::write(&root.path().join("run"));
    sample_run::photograph(&root.path().join("run"), "demo");
    let text = results(root.path(), &["run"]).unwrap();
    let pictures = cells(&text, "Photographs", "Withheld views, PSNR in dB", UNSHADE);
    assert_eq!(pictures[1..], ["30.0", "28.0"]);
    let text = text.split("\n## Figures").next().unwrap();
    assert!(!text.contains("truth") && !text.contains("oracle"), "{text}");
}

#[test]
fn equal_runs_give_equal_bytes_and_times_do_not_matter() {
    let root = tempfile::tempdir().unwrap();
    two_faces(&root.path().join("run"), 1.0);
    let first = results(root.path(), &["run"]).unwrap();
    fs::write(root.path().join("run/timing.json"), "{}").unwrap();
    assert_eq!(results(root.path(), &["run"]).unwrap(), first);
    assert!(!first.contains(&*root.path().to_string_lossy()), "no path of this machine");
    let columns = |line: &str| line.replace("\\|", "").matches('|').count();
    let tables = first.split("\n\n").filter(|block| block.starts_with('|'));
    for table in tables {
        let mut widths: Vec<usize> = table.lines().map(columns).collect();
        widths.dedup();
        assert_eq!(widths.len(), 1, "{table}");
    }
}

#[test]
fn variants_have_tables_of_their_own_and_several_runs_follow_each_other() {
    let root = tempfile::tempdir().unwrap();
    sample_run::write(&root.path().join("clean"));
    sample_run::write(&root.path().join("faulty"));
    let path = root.path().join("faulty/run.json");
    let mut manifest = read(&path);
    for case in manifest["cases"].as_array_mut().unwrap() {
        case["variant"] = json!("no labels");
    }
    manifest["title"] = json!("With faults");
    save(&path, &manifest);
    let text = results(root.path(), &["clean", "faulty"]).unwrap();
    let (clean, faulty) = text.split_once("\n## With faults\n").unwrap();
    assert!(clean.contains("\n### flash light\n") && !clean.contains("no labels"));
    assert!(faulty.contains("\n### flash light, no labels\n"));
    assert!(faulty.contains("| flash, no labels | "), "face by face too");
}

#[test]
fn the_drop_of_every_variant_stands_beside_the_first() {
    let root = tempfile::tempdir().unwrap();
    let run = root.path().join("run");
    two_faces(&run, 1.0);
    let path = run.join("run.json");
    let mut manifest = read(&path);
    let mut cases = manifest["cases"].as_array().unwrap().clone();
    cases.iter_mut().for_each(|case| case["variant"] = json!("as captured"));
    for mut case in cases.clone() {
        case["variant"] = json!("one label");
        case["id"] = json!(format!("{}-one", case["id"].as_str().unwrap()));
        // Worse by 2 dB for one face, by 3 for the other.
        let loss = if case["face"] == "eve" { 3.0 } else { 2.0 };
        for solver in case["solvers"].as_array_mut().unwrap() {
            let mut scores = read(&run.join(solver["scores"].as_str().unwrap()));
            for row in scores["rows"].as_array_mut().unwrap() {
                row["value"] = json!(row["value"].as_f64().unwrap() - loss);
            }
            let place = format!("one/{}", solver["scores"].as_str().unwrap());
            save(&run.join(&place), &scores);
            solver["scores"] = json!(place);
        }
        cases.push(case);
    }
    manifest["cases"] = json!(cases);
    save(&path, &manifest);
    let text = results(root.path(), &["run"]).unwrap();
    let (_, drops) = text.split_once("light: change against \"as captured\"\n").unwrap();
    let row = drops.lines().find(|line| line.starts_with("| one label | &lt;unshade")).unwrap();
    assert!(row.contains(" | -2.5 | -2.5 | "), "{row}");
    for heading in ["albedo", "as is", "relit, own", "relit, others", "layer, energy"] {
        assert!(drops.lines().nth(3).unwrap().contains(&format!("| {heading} ")), "{heading}");
    }
    assert!(!drops.split("\n### ").next().unwrap().contains("| as captured |"));
}

#[test]
fn a_face_without_a_score_is_counted_and_a_run_without_any_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let run = root.path().join("run");
    two_faces(&run, 1.0);
    fs::remove_file(run.join("scores/eve-flash/unshade.json")).unwrap();
    let text = results(root.path(), &["run"]).unwrap();
    let albedo = cells(&text, "flash light", "Diffuse albedo", UNSHADE);
    assert_eq!(albedo[1], "**32.0** 1 of 2");
    fs::remove_dir_all(run.join("scores")).unwrap();
    let message = results(root.path(), &["run"]).unwrap_err();
    assert!(message.contains("nothing was scored yet; finish the run"), "{message}");
    assert!(!message.contains('\n'));
}

#[test]
fn the_terminal_says_what_failed() {
    let root = tempfile::tempdir().unwrap();
    let run = root.path().join("run");
    two_faces(&run, 1.0);
    let path = run.join("run.json");
    let mut manifest = read(&path);
    assert!(failures_in_lines(std::slice::from_ref(&run)).unwrap().is_empty());
    manifest["cases"][0]["solvers"][0]["failed"] = json!("out of memory");
    manifest["cases"][0]["solvers"][0]["title"] = json!("mine");
    save(&path, &manifest);
    let case = manifest["cases"][0]["id"].as_str().unwrap();
    let said = failures_in_lines(&[run]).unwrap();
    assert_eq!(said, [format!("mine failed on {case}: out of memory")]);
}

/// The sample run with a scene at its captures and with its methods called otherwise.
fn one_suite(run: &Path, called: impl Fn(&str) -> String, scene: &str) {
    sample_run::write(run);
    let path = run.join("run.json");
    let mut manifest = read(&path);
    for case in manifest["cases"].as_array_mut().unwrap() {
        let truth = run.join(case["capture"].as_str().unwrap()).join("truth");
        fs::create_dir_all(&truth).unwrap();
        fs::write(truth.join("scene.toml"), scene).unwrap();
        for solver in case["solvers"].as_array_mut().unwrap() {
            solver["id"] = json!(called(solver["id"].as_str().unwrap()));
            solver["title"] = json!(called("method"));
        }
    }
    manifest["versions"]["unshade"] = json!(called("0.1.0"));
    save(&path, &manifest);
}

#[test]
fn runs_of_one_suite_on_the_same_captures_share_their_tables() {
    let root = tempfile::tempdir().unwrap();
    let scene = "[render]\nwidth = 16\nheight = 16\n";
    one_suite(&root.path().join("a"), str::to_owned, scene);
    one_suite(&root.path().join("b"), |id| format!("late-{id}"), scene);
    let text = results(root.path(), &["a", "b"]).unwrap();
    assert_eq!(text.matches("\n## Two &lt;balls&gt;\n").count(), 1);
    let light = text.split("\n### flash light\n").nth(1).unwrap();
    let table = light.split("\n\n").nth(1).unwrap();
    assert!(table.contains("\n| method |") && table.contains("\n| late-method |"), "{table}");
    assert!(text.contains("unshade of late-method late-0.1.0"), "whose version it is");

    // Another scene, or the same methods once more: a section of its own.
    one_suite(&root.path().join("c"), |id| format!("late-{id}"), "[render]\nwidth = 32\n");
    one_suite(&root.path().join("d"), str::to_owned, scene);
    for other in ["c", "d"] {
        let text = results(root.path(), &["a", other]).unwrap();
        assert_eq!(text.matches("\n## Two &lt;balls&gt;\n").count(), 2, "{other}");
    }
}
