//! Reports of photographs, and of runs of which nothing can be scored.

use super::*;

/// The words of a page that a reader or a screen reader gets.
fn words(html: &str) -> String {
    let mut text = String::new();
    for part in html.split("<script>").next().unwrap().split('<').skip(1) {
        let (tag, rest) = part.split_once('>').unwrap();
        for attribute in ["alt=\"", "title=\"", "aria-label=\"", "data-title=\""] {
            between(tag, attribute, "\"").iter().for_each(|value| text += &format!(" {value}"));
        }
        if !tag.starts_with("style") {
            text += &format!(" {}", rest.trim());
        }
    }
    text
}

#[test]
fn photographs_are_compared_with_photographs_and_no_page_calls_one_the_truth() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    sample_run::write(&run);
    sample_run::photograph(&run, "demo");
    let html = words(&again(folder.path()));
    for word in
        ["truth", "known exactly", "oracle", "noise floor", "diffuse albedo, after one factor"]
    {
        assert!(!html.to_lowercase().contains(word), "{word}: {html}");
    }
    for sentence in [
        "compared with withheld photographs; the true maps are unknown",
        "photographs, light unknown",
        "The 4 photographs that every method gets",
        "Withheld photograph, maps relit: the light that the method recovered",
        "&lt;mean_texture&gt; &amp; co wrote neither pictures of the withheld views (views/) nor a light",
    ] {
        assert!(html.contains(sentence), "{sentence}: {html}");
    }
    // One case of each kind: either is called what it is.
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    sample_run::write(&run);
    sample_run::photograph(&run, "demo-uniform");
    let html = again(folder.path());
    let (rendered, photographed) = html.split_once("<section id=\"demo-uniform\"").unwrap();
    let photographed = words(photographed.split("<section id=\"metrics\">").next().unwrap());
    assert!(!photographed.contains("truth") && photographed.contains("photograph"));
    let rendered = words(rendered.split_once("<section id=\"demo-flash\"").unwrap().1);
    assert!(rendered.contains("truth") && !rendered.contains("photograph"));
    assert!(words(&html).contains("Reflectance maps of rendered faces"));
}

#[test]
fn methods_of_which_nothing_can_be_scored_have_a_report_and_no_baseline() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    sample_run::write(&run);
    sample_run::photograph(&run, "demo");
    let path = run.join("run.json");
    let mut manifest: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    for case in manifest["cases"].as_array_mut().unwrap() {
        case["solvers"].as_array_mut().unwrap().retain(|method| method["id"] == "mean_texture");
    }
    fs::write(&path, manifest.to_string()).unwrap();
    assert_eq!(whole(&run, &folder.path().join("report")).unwrap().baseline, None);
    let html = again(folder.path());
    assert!(html.contains("nothing of it can be compared with the photographs"));
    assert!(!html.contains("href=\"baseline.json\""));
}
