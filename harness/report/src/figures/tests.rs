use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::sample_run;

fn request(run: &Path, kind: FigureKind) -> FigureRequest {
    let command = "unshade figure".to_owned();
    FigureRequest { kind, runs: vec![run.to_path_buf()], methods: vec![], cases: vec![], command }
}

fn sample() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    sample_run::write(&run);
    (folder, run)
}

fn write(request: &FigureRequest, out: &Path) -> Result<(), ReportError> {
    write_figure(request, out, |_| Ok(()))
}

#[test]
fn every_panel_figure_names_files_that_are_there_and_has_its_numbers_behind_it() {
    let (folder, run) = sample();
    for (kind, panels, rows) in [
        // Per case: input, then truth and method in the two lights.
        (FigureKind::Relighting, 2 * (1 + 2 * 2), 2 * 2 * 2),
        // Truth: input, view, three maps, relit; method: the same without the input.
        (FigureKind::Reflectance, 2 * (6 + 5), 2 * 9),
        // Per input light: input and three comparisons.
        (FigureKind::Emily, 2 * (1 + 3 * 3), 2 * 3),
        (FigureKind::Decomposition, 2 * (6 + 5), 2 * 3),
    ] {
        let out = folder.path().join("figure");
        write(&request(&run, kind), &out).unwrap();
        let json: serde_json::Value =
            serde_json::from_slice(&fs::read(out.join("figure.json")).unwrap()).unwrap();
        let mut files = Vec::new();
        for block in json["blocks"].as_array().unwrap() {
            for row in block["rows"].as_array().unwrap() {
                let cells = row["cells"].as_array().unwrap();
                assert_eq!(cells.len(), block["columns"].as_array().unwrap().len(), "{kind:?}");
                files.extend(cells.iter().filter_map(|cell| cell["file"].as_str()));
            }
        }
        assert_eq!(files.len(), panels, "{kind:?}");
        let latex = fs::read_to_string(out.join("figure.tex")).unwrap();
        for file in files {
            assert!(out.join(file).is_file() && latex.contains(file), "{kind:?}: {file}");
        }
        let csv = fs::read_to_string(out.join("figure.csv")).unwrap();
        assert_eq!(csv.lines().count() - 1, rows, "{kind:?}\n{csv}");
    }
}

#[test]
fn detail_is_recovered_by_the_oracle_and_less_of_it_by_the_others() {
    let (folder, run) = sample();
    let out = folder.path().join("figure");
    write(&request(&run, FigureKind::Detail), &out).unwrap();
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("figure.json")).unwrap()).unwrap();
    let lines = json["blocks"][0]["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 3);
    let gains = |line: &serde_json::Value| -> Vec<f64> {
        line["y"].as_array().unwrap().iter().map(|y| y.as_f64().unwrap()).collect()
    };
    // The sample's factor is 0.93, and its maps are off by 0.4 % at most.
    assert!(gains(&lines[2]).iter().all(|gain| (gain / 0.93 - 1.0).abs() < 0.05), "{lines:?}");
    assert!(gains(&lines[1]).iter().any(|gain| (gain / 0.93 - 1.0).abs() > 0.05));
}

#[test]
fn missing_data_is_an_error_of_one_line_and_leaves_the_earlier_figure() {
    let (folder, run) = sample();
    let out = folder.path().join("figure");
    write(&request(&run, FigureKind::Relighting), &out).unwrap();
    let refused = |request: FigureRequest, part: &str| {
        let message = write(&request, &out).unwrap_err().to_string();
        assert!(message.contains(part) && !message.contains('\n'), "{message}");
        assert!(out.join("figure.csv").is_file() && !folder.path().join("figure.partial").exists());
    };
    refused(request(&run, FigureKind::Ablations), "second method or variant");
    refused(request(&run, FigureKind::Bias), "`given` parts");
    refused(request(&run, FigureKind::Waterfall), "two solvers");
    let named = |methods: &[&str], cases: &[&str]| FigureRequest {
        methods: methods.iter().map(|name| (*name).to_owned()).collect(),
        cases: cases.iter().map(|name| (*name).to_owned()).collect(),
        ..request(&run, FigureKind::Emily)
    };
    refused(named(&["other"], &[]), "method \"other\": not in");
    refused(named(&[], &["nowhere"]), "name one of demo-flash, demo-uniform");
    refused(
        named(&[], &["demo-flash"]),
        "captures of one face in two lights, and a method that is shown; there are the cases demo-flash (face demo, light flash)",
    );
    let failing = |_: &Path| Err(ReportError::Interrupted);
    let result = write_figure(&request(&run, FigureKind::Emily), &out, failing);
    assert!(result.is_err() && !folder.path().join("figure.partial").exists());
    assert!(fs::read_to_string(out.join("figure.tex")).unwrap().contains("Relighting"));
}

#[test]
fn a_caption_names_interrupted_solves_of_the_methods_that_are_shown() {
    let (folder, run) = sample();
    let out = folder.path().join("figure");
    let path = run.join("maps/demo-flash/unshade/solve.json");
    let text = fs::read_to_string(&path).unwrap();
    let caption = |request: &FigureRequest| {
        write(request, &out).unwrap();
        fs::read_to_string(out.join("figure.tex")).unwrap()
    };
    assert!(!caption(&request(&run, FigureKind::Emily)).contains("Interrupted"));
    fs::write(&path, text.replacen('{', "{\"interrupted\": \"albedo\",", 1)).unwrap();
    let said = caption(&request(&run, FigureKind::Emily));
    assert!(said.contains("Interrupted solves") && said.contains("on demo-flash"), "{said}");
    let others =
        FigureRequest { methods: vec!["oracle".into()], ..request(&run, FigureKind::Emily) };
    assert!(!caption(&others).contains("Interrupted"));
}

#[test]
fn figures_of_photographs_show_photographs_and_name_no_truth() {
    let (folder, run) = sample();
    sample_run::photograph(&run, "demo");
    let out = folder.path().join("figure");
    for kind in [FigureKind::Relighting, FigureKind::Reflectance, FigureKind::Decomposition] {
        write(&request(&run, kind), &out).unwrap();
        let latex = fs::read_to_string(out.join("figure.tex")).unwrap();
        let shown = latex.replace("-truth", "");
        assert!(!shown.contains("truth") && !shown.contains("true "), "{kind:?}: {shown}");
        let photographs = kind != FigureKind::Decomposition;
        assert_eq!(shown.contains("photograph"), photographs, "{kind:?}: {shown}");
    }
}

#[test]
fn an_ablation_is_the_paired_difference_to_the_first_method_over_faces() {
    let (folder, run) = sample();
    let out = folder.path().join("figure");
    let methods = ["unshade", "oracle"].map(str::to_owned).to_vec();
    write(&FigureRequest { methods, ..request(&run, FigureKind::Ablations) }, &out).unwrap();
    let csv = fs::read_to_string(out.join("figure.csv")).unwrap();
    let row = csv.lines().find(|line| line.contains(",oracle,diffuse albedo,")).unwrap();
    let cells: Vec<&str> = row.split(',').collect();
    let number = |at: usize| cells[at].parse::<f64>().unwrap();
    // -20 log10 of half the errors 0.05 and 0.004; one face, so no interval.
    assert_eq!((cells[5], cells[7], cells[11]), ("1", "", ""));
    assert!((number(6) - 53.979).abs() < 1e-2 && (number(10) - 21.938).abs() < 1e-2, "{row}");
    let latex = fs::read_to_string(out.join("figure.tex")).unwrap();
    assert!(latex.contains("\\toprule") && latex.contains("figure.pdf"));

    let methods = ["unshade", "oracle"].map(str::to_owned).to_vec();
    write(&FigureRequest { methods, ..request(&run, FigureKind::Bias) }, &out).unwrap();
    let by_light = fs::read_to_string(out.join("figure.csv")).unwrap();
    let of = |light: &str| by_light.lines().filter(|line| line.contains(light)).count();
    assert_eq!((of(",flash"), of(",uniform")), (6, 6), "{by_light}");
}

#[test]
fn the_robustness_map_places_cases_by_their_scenes() {
    let (folder, run) = sample();
    for (case, exposure) in [("demo-flash", "0.5"), ("demo-uniform", "2")] {
        let text = format!("[face]\nfitzpatrick = \"IV\"\n[light]\nexposure = {exposure}\n");
        fs::write(run.join("captures").join(case).join("truth/scene.toml"), text).unwrap();
    }
    let out = folder.path().join("figure");
    write(&request(&run, FigureKind::Robustness), &out).unwrap();
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("figure.json")).unwrap()).unwrap();
    let blocks = json["blocks"].as_array().unwrap();
    assert_eq!(blocks.len(), 2, "albedo and relit, one skin, one roughness");
    assert_eq!(
        (&blocks[0]["x"], &blocks[0]["y"]),
        (&serde_json::json!([0.5, 2.0]), &serde_json::json!([1.0]))
    );
    let value = |block: usize, x: usize| blocks[block]["values"][0][x].as_f64().unwrap();
    assert!((value(0, 0) - 32.041).abs() < 1e-2 && (value(0, 1) - 32.041).abs() < 1e-2);
    // The sample's relit scores grow by one from flash to uniform: each case has the other light's.
    assert!((value(1, 0) - 33.041).abs() < 1e-2 && (value(1, 1) - 32.041).abs() < 1e-2);
}

#[test]
fn a_waterfall_goes_from_method_to_method_and_the_oracle_bounds_it() {
    let (folder, run) = sample();
    let out = folder.path().join("figure");
    let methods = ["mean_texture", "unshade"].map(str::to_owned).to_vec();
    write(&FigureRequest { methods, ..request(&run, FigureKind::Waterfall) }, &out).unwrap();
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("figure.json")).unwrap()).unwrap();
    let [albedo, relit] = [0, 1].map(|at| &json["blocks"][at]);
    // In the order of the suite, whatever was named first.
    let bar = |block: &serde_json::Value, at: usize| block["bars"][at]["value"].as_f64().unwrap();
    assert!((bar(albedo, 0) - 32.041).abs() < 1e-2 && (bar(albedo, 1) - 20.0).abs() < 1e-2);
    assert_eq!(albedo["levels"], serde_json::json!([]));
    assert!((relit["levels"][0][1].as_f64().unwrap() - 54.479).abs() < 1e-2, "{relit}");
    let csv = fs::read_to_string(out.join("figure.csv")).unwrap();
    let row = csv.lines().find(|line| line.starts_with("diffuse albedo,mean_texture")).unwrap();
    let step: f64 = row.rsplit(',').next().unwrap().parse().unwrap();
    assert!((step + 12.041).abs() < 1e-2, "{row}");
}
