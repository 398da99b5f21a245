use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use formats::picture::{self, Picture};
use scoring::compare::Baseline;
use serde_json::{Value, json};

use super::link::WayToRun;
use super::page::{Page, TEMPLATES};
use super::run::RunFile;
use super::{ReportError, ReportSummary, sample_run, write};

mod photographs;

struct Made {
    folder: tempfile::TempDir,
    html: String,
}

fn report() -> Made {
    let folder = tempfile::tempdir().unwrap();
    sample_run::write(&folder.path().join("run"));
    let html = again(folder.path());
    Made { folder, html }
}

/// The report that the tests which only read share.
fn shared() -> &'static Made {
    static MADE: OnceLock<Made> = OnceLock::new();
    MADE.get_or_init(report)
}

/// Writes a report without an interrupt.
fn whole(run: &Path, out: &Path) -> Result<ReportSummary, ReportError> {
    write(run, out, &mut |_, _, _| true)
}

fn again(folder: &Path) -> String {
    whole(&folder.join("run"), &folder.join("report")).unwrap();
    fs::read_to_string(folder.join("report/index.html")).unwrap()
}

/// Texts between every `from` and the next `to`.
fn between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    text.split(from).skip(1).map(|rest| rest.split(to).next().unwrap()).collect()
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

#[test]
fn every_row_states_its_protocol_and_has_a_cell_per_column() {
    let html = &shared().html;
    let rows = between(html, "<tr title=\"", "</tr>");
    assert!(rows.len() > 20, "{}", rows.len());
    for row in rows {
        let protocol = between(row, "<td class=\"protocol\">", "</td>");
        assert_eq!(protocol.len(), 1);
        let parts: Vec<&str> = protocol[0].split("; ").collect();
        assert!(parts.len() == 3 && parts.iter().all(|part| !part.is_empty()), "{protocol:?}");
        // Protocol, three methods, trivial answer, noise floor.
        assert_eq!(row.matches("<td").count(), 6, "{row}");
    }
}

#[test]
fn a_score_that_does_not_exist_is_a_dash_and_the_best_is_bold() {
    let html = &shared().html;
    let row = between(html, "<tr title=\"view/psnr_srgb@mask-e5:none\">", "</tr>")[0];
    assert_eq!(between(row, "<td class=\"baseline\">", "</td>"), ["–"]);
    assert!(!row.contains("<b>"), "nothing to win without a contender");
    let row =
        between(html, "<tr title=\"diffuse_albedo/psnr_srgb@coverage-e5:global\">", "</tr>")[0];
    assert!(between(row, "<td class=\"solver\">", "</td>")[0].starts_with("<b>32.04</b>"), "{row}");
    assert!(between(row, "<td class=\"oracle\">", "</td>")[0].starts_with("53.98"), "{row}");
}

#[test]
fn a_plain_mesh_that_beats_the_recovered_normal_is_the_bold_one() {
    let html = &shared().html;
    let id = "<tr title=\"specular_normal/normal_mean_deg@coverage-e5:none\">";
    let row = between(html, id, "</tr>")[0];
    assert_eq!(between(row, "<td class=\"trivial\">", "</td>"), ["<b>3.50</b>"]);
    assert!(between(row, "<td class=\"solver\">", "</td>")[0].starts_with("4.00"), "{row}");
    assert!(html.contains("<td>4.00 / 3.50</td>"), "the key figures name both");
}

#[test]
fn every_part_of_the_page_and_of_a_case_is_shown_by_a_template() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    sample_run::write(&run);
    let manifest = RunFile::open(&run).unwrap();
    let way = WayToRun::new(&run, &folder.path().join("report")).unwrap();
    let page = Page::make(&run, &manifest, folder.path(), &way, &mut |_, _, _| true).unwrap();
    let page = serde_json::to_value(page).unwrap();
    let shown = |key: &str| {
        let mut words = TEMPLATES
            .iter()
            .flat_map(|(_, text)| text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'));
        words.any(|word| word == key)
    };
    for part in [&page, &page["cases"][0]] {
        for key in part.as_object().unwrap().keys() {
            assert!(shown(key), "no template shows {key}");
        }
    }
}

#[test]
fn names_are_escaped() {
    let html = &shared().html;
    assert!(html.contains("&lt;unshade&gt; &amp; co") && html.contains("Two &lt;balls&gt;"));
    assert!(!html.contains("<unshade>") && !html.contains("<balls>"));
}

#[test]
fn nothing_is_loaded_from_elsewhere_and_every_link_leads_somewhere() {
    let made = shared();
    for elsewhere in
        ["src=\"http", "src=\"//", "src=\"file", "src=\"/", "href=\"/", "<link", "@import", "url("]
    {
        assert!(!made.html.contains(elsewhere), "{elsewhere}");
    }
    let references = ["src=\"", "href=\"", "data-picture=\"", "data-truth=\"", "data-values=\""]
        .into_iter()
        .flat_map(|kind| between(&made.html, kind, "\""));
    let mut pictures = 0;
    for reference in references {
        // The source of a metric is followed by a reader, never loaded.
        if reference.starts_with("https://") {
            continue;
        }
        match reference.strip_prefix('#') {
            Some(id) => assert!(made.html.contains(&format!("id=\"{id}\"")), "{reference}"),
            None => {
                assert!(made.folder.path().join("report").join(reference).is_file(), "{reference}");
                pictures += 1;
            }
        }
    }
    assert!(pictures > 100, "{pictures}");
}

#[test]
fn the_matrix_has_a_block_per_input_light_with_three_comparisons() {
    let html = &shared().html;
    let matrix = between(html, "<section id=\"matrix\">", "</section>")[0];
    let blocks = between(matrix, "<th scope=\"col\">input: ", "<th scope=\"row\">");
    assert_eq!(blocks.len(), 2);
    for (block, other) in blocks.iter().zip(["uniform", "flash"]) {
        let titles = between(block, "<th scope=\"colgroup\" colspan=\"3\">", "</th>");
        let opposite = format!("Maps relit, opposite light: {other}");
        assert_eq!(titles, ["View synthesis, same light", "Maps relit, same light", &opposite]);
        assert_eq!(block.matches("alt=\"truth\"").count(), 3);
        assert_eq!(block.matches("alt=\"error of").count(), 3);
    }
}

#[test]
fn each_plate_with_pictures_has_a_slider_that_a_keyboard_can_move() {
    let html = &shared().html;
    let figures = between(html, "<figure class=\"plate\"", "</figure>");
    // Per case: four maps, own view, two lights, and two layers of view and relit picture.
    assert_eq!(figures.len(), 2 * (4 + 1 + 2 + 4));
    for figure in figures {
        assert_eq!(figure.matches("<input type=\"range\"").count(), 1);
        assert!(figure.contains("class=\"heat\""), "a colour bar");
    }
}

#[test]
fn a_solve_shows_what_it_left_and_nothing_of_what_it_did_not() {
    let made = report();
    let maps = made.folder.path().join("run/maps/demo-flash/unshade");
    let section = |html: &str| {
        between(html, "<h3>Optimisation</h3>", "<h3>Regions and provenance</h3>")[0].to_owned()
    };
    let before = section(&made.html);
    let pictures = |html: &str, title: &str| {
        between(html, &format!("alt=\"{title}: "), "\"")
            .iter()
            .map(|s| s.trim().to_owned())
            .collect()
    };
    let shown: Vec<String> = pictures(&before, "Light");
    assert_eq!(shown, ["truth", "truth, mean of each cell", "recovered"]);
    let shown: Vec<String> = pictures(&before, "Confidence");
    assert_eq!(
        shown,
        ["confidence", "error of the diffuse albedo", "error over the stated deviation"]
    );
    assert!(before.contains("Confidence against error -0.40; Error of the trusted half 0.80."));
    let shown: Vec<String> = pictures(&before, "Maps after each stage");
    // The first stage changed no normal, and a stage without a map has no picture.
    let of = |map: &str, columns: &[&str]| -> Vec<String> {
        columns.iter().map(|column| format!("{map} {column}")).collect()
    };
    let albedo = of("Diffuse albedo", &["warm-up", "heights", "result", "truth"]);
    assert_eq!(shown, [albedo, of("Specular normal", &["heights", "result", "truth"])].concat());
    let shown: Vec<String> = pictures(&before, "Layers of the training views");
    assert_eq!(shown.len(), 6 * 4);
    assert!(shown.contains(&"specular, truth 003".to_owned()));

    for folder in ["stages", "layers"] {
        fs::remove_dir_all(maps.join(folder)).unwrap();
    }
    for file in ["light.exr", "confidence.exr"] {
        fs::remove_file(maps.join(file)).unwrap();
    }
    let html = again(made.folder.path());
    assert!(!section(&html).contains("class=\"sheet\""), "{}", section(&html));
    assert!(section(&html).contains("class=\"curve\""));
    assert!(!made.html.contains("class=\"notice\""));
}

#[test]
fn an_interrupted_solve_says_so_wherever_its_figures_stand() {
    let made = report();
    let path = made.folder.path().join("run/maps/demo-flash/unshade/solve.json");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen('{', "{\"interrupted\": \"<fine-tuning>\",", 1)).unwrap();
    let html = again(made.folder.path());
    let notices = between(&html, "<p class=\"notice\">", "</p>");
    assert_eq!(notices.len(), 3, "key figures, case, optimisation");
    assert!(notices[0].contains("demo-flash</a>: &lt;unshade&gt; &amp; co was interrupted"));
    assert!(notices[1..].iter().all(|notice| notice.contains("“&lt;fine-tuning&gt;”")));
    let refused = text.replacen('{', "{\"interrupted\": null,", 1);
    fs::write(&path, refused).unwrap();
    assert!(!again(made.folder.path()).contains("class=\"notice\""));
}

#[test]
fn likely_faults_of_maps_stand_beside_the_method_s_name() {
    let made = report();
    assert!(!made.html.contains('⚠'));
    let path = made.folder.path().join("run/scores/demo-flash/unshade.json");
    let mut scores: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    scores["findings"] = json!([{
        "id": "flipped-v", "level": "warning", "map": "diffuse_albedo.exr",
        "message": "is <flipped> in v", "fix": "turn it", "evidence": {"correlation": 0.5},
    }]);
    fs::write(&path, scores.to_string()).unwrap();
    let html = again(made.folder.path());
    let words = "warning: diffuse_albedo.exr: is &lt;flipped&gt; in v; turn it [flipped-v]";
    let summary = between(&html, "<th scope=\"row\">&lt;unshade&gt; &amp; co", "</th>");
    assert!(summary[0].contains("1 likely fault of its maps") && summary[0].contains(words));
    assert!(!summary[1].contains('⚠'), "the other case has none");
    let notices = between(&html, "<p class=\"notice\">", "</p>");
    assert_eq!(notices.len(), 1);
    assert!(notices[0].contains("The maps of &lt;unshade&gt; &amp; co are likely wrong"));
    assert!(notices[0].contains(words));
    let heading = between(&html, "<th scope=\"col\" class=\"solver\">", "</th>");
    assert!(heading[0].contains('⚠'), "{}", heading[0]);
}

#[test]
fn equal_runs_differ_only_in_their_times() {
    let made = report();
    let (root, first) = (made.folder.path(), files(&made.folder.path().join("report")));
    again(root);
    assert_eq!(first, files(&root.join("report")));
    let times = r#"{"stages": [{"id": "capture/demo-flash", "seconds": 99.0, "cached": true}]}"#;
    fs::write(root.join("run/timing.json"), times).unwrap();
    fs::remove_file(root.join("run/maps/demo-flash/unshade/timing.json")).unwrap();
    let slower = again(root);
    let cut = |html: &str| {
        let (before, rest) = html.split_once("<section id=\"times\">").unwrap();
        format!("{before}{}", rest.split_once("</section>").unwrap().1)
    };
    assert!(made.html.contains("fine-tuning</th><td class=\"number\">1.0"), "a solver's stages");
    assert_ne!(made.html, slower);
    assert_eq!(cut(&made.html), cut(&slower));
}

#[test]
fn a_method_that_made_nothing_leaves_its_column_empty() {
    let made = report();
    let run = made.folder.path().join("run");
    for part in ["maps", "relit"] {
        fs::remove_dir_all(run.join(part).join("demo-flash/unshade")).unwrap();
    }
    fs::remove_file(run.join("scores/demo-flash/unshade.json")).unwrap();
    let html = again(made.folder.path());
    let row =
        between(&html, "<tr title=\"diffuse_albedo/psnr_srgb@coverage-e5:global\">", "</tr>")[0];
    assert_eq!(between(row, "<td class=\"solver\">", "</td>"), ["–"]);
    let baseline = made.folder.path().join("report/baseline.json");
    assert!(!baseline.exists(), "a later run would pass for want of scores");
}

#[test]
fn the_baseline_holds_the_scores_of_every_method() {
    let baseline = Baseline::read(&shared().folder.path().join("report/baseline.json")).unwrap();
    let value = |id: &str| baseline.rows[id].value.unwrap();
    let row = "diffuse_albedo/psnr_srgb@coverage-e5:global";
    assert!((value(&format!("demo-flash/unshade/{row}")) - 32.04).abs() < 0.01);
    assert!((value(&format!("demo-uniform/mean_texture/{row}")) - 20.0).abs() < 0.01);
}

#[test]
fn broken_runs_are_refused_in_one_line_and_leave_the_earlier_report() {
    let made = report();
    let (root, run) = (made.folder.path(), made.folder.path().join("run"));
    let refused = |file: &str, content: Option<&[u8]>, expected: &[&str]| {
        let path = run.join(file);
        let original = fs::read(&path).unwrap();
        match content {
            Some(content) => fs::write(&path, content).unwrap(),
            None => fs::remove_file(&path).unwrap(),
        }
        let message = whole(&run, &root.join("report")).unwrap_err().to_string();
        fs::write(&path, original).unwrap();
        assert!(!message.contains('\n'), "{message}");
        let name = Path::new(file).file_name().unwrap().to_string_lossy();
        assert!(message.contains(&*name), "{message}");
        assert!(expected.iter().all(|part| message.contains(part)), "{message}");
        assert!(!root.join("report.partial").exists());
        assert_eq!(fs::read_to_string(root.join("report/index.html")).unwrap(), made.html);
    };
    refused("run.json", None, &["cannot be read"]);
    refused("run.json", Some(b"{"), &["is not a valid file of a run", "run the suite again"]);
    refused("run.json", Some(br#"{"format":9,"suite":"s","cases":[]}"#), &["format 9", "reads 1"]);
    refused("scores/demo-flash/unshade.json", Some(b"[1"), &["cannot be understood"]);
    refused("captures/demo-flash/transforms.json", None, &["cannot be read"]);
    refused("captures/demo-flash/images/000.exr", Some(b"no picture"), &["cannot be read"]);
}

#[test]
fn an_interrupt_leaves_the_earlier_report() {
    let made = report();
    let (root, run) = (made.folder.path(), made.folder.path().join("run"));
    let mut seen = vec![];
    let result = write(&run, &root.join("report"), &mut |done, total, case| {
        seen.push((done, total, case.to_owned()));
        done == 0
    });
    assert!(matches!(result, Err(ReportError::Interrupted)), "{result:?}");
    assert_eq!(seen.len(), 2, "{seen:?}");
    assert_eq!(seen[0].0, 0);
    assert!(!root.join("report.partial").exists());
    assert_eq!(fs::read_to_string(root.join("report/index.html")).unwrap(), made.html);
}

#[test]
fn a_nan_in_a_map_is_reported_with_its_place() {
    let made = report();
    let path = made.folder.path().join("run/maps/demo-flash/unshade/specular_albedo.exr");
    let mut map = Picture::new(96, 96, 1);
    map.pixel_mut(3, 2)[0] = f32::NAN;
    picture::write_exr(&path, &map, &["Y"]).unwrap();
    let result = whole(&made.folder.path().join("run"), &made.folder.path().join("report"));
    let message = result.unwrap_err().to_string();
    assert!(message.contains("specular_albedo.exr: NaN at column 3, row 2"), "{message}");
}

#[test]
fn a_folder_that_is_not_a_report_is_not_replaced() {
    let made = report();
    let target = made.folder.path().join("thesis");
    fs::create_dir(&target).unwrap();
    fs::write(target.join("chapter.tex"), "years of work").unwrap();
    let message = whole(&made.folder.path().join("run"), &target).unwrap_err().to_string();
    assert!(message.contains("not written by unshade"), "{message}");
    assert!(target.join("chapter.tex").exists());
}
