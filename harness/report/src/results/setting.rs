//! Under which conditions the numbers of a run arose: faces, pictures, solvers, versions.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use scoring::tables::markdown_text;
use serde_json::Value;

use super::finished::Finished;
use crate::ReportError;
use crate::run::{self, Case, Frames};
use crate::solve::{interrupted, plain};

/// A list of what holds for all numbers of the run.
pub(super) fn describe(run: &Finished) -> Result<String, ReportError> {
    let (mut faces, mut pictures, mut makers) = (Vec::new(), Vec::new(), Vec::new());
    let add = |list: &mut Vec<String>, item: String| {
        if !item.is_empty() && !list.contains(&item) {
            list.push(item);
        }
    };
    for case in &run.manifest.cases {
        let scene = scene(&run.folder.join(&case.capture));
        add(&mut faces, face(case, &scene));
        add(&mut pictures, picture(&run.folder.join(&case.capture), &scene)?);
    }
    for solver in run.manifest.cases.first().map_or(&[][..], |case| &case.methods) {
        makers.extend(maker(run, &solver.id)?);
    }
    let versions: Vec<String> = (run.manifest.versions.iter())
        // Another renderer's build or thread count is another machine, not another result.
        .filter(|(name, _)| *name != "renderer")
        .map(|(name, version)| format!("{name} {}", plain(version)))
        .collect();
    let mut text = format!("- Suite: `{}`.\n", run.manifest.suite);
    for (name, items) in
        [("Faces", faces), ("Pictures", pictures), ("Solvers", makers), ("Versions", versions)]
    {
        if !items.is_empty() {
            text.push_str(&format!("- {name}: {}.\n", markdown_text(&items.join("; "))));
        }
    }
    Ok(text)
}

/// The scene of a capture; empty for a capture that is not ours.
pub(super) fn scene(capture: &Path) -> toml::Table {
    let text = fs::read_to_string(capture.join("truth/scene.toml")).unwrap_or_default();
    text.parse().unwrap_or_default()
}

/// A face with its type, age and seed.
pub(super) fn face(case: &Case, scene: &toml::Table) -> String {
    let value = |key: &str| scene.get("face").and_then(|face| face.get(key));
    let mut parts = Vec::new();
    if let Some(skin) = value("fitzpatrick").and_then(toml::Value::as_str) {
        parts.push(format!("type {skin}"));
    }
    if let Some(seed) = value("seed") {
        parts.push(format!("seed {seed}"));
    }
    match parts.is_empty() {
        true => case.face.clone(),
        false => format!("{} ({})", case.face, parts.join(", ")),
    }
}

fn picture(capture: &Path, scene: &toml::Table) -> Result<String, ReportError> {
    let frames = Frames::read(capture)?;
    let value = |table: &str, key: &str| scene.get(table)?.get(key).map(ToString::to_string);
    let mut parts = Vec::new();
    if let (Some(width), Some(height)) = (value("render", "width"), value("render", "height")) {
        parts.push(format!("{width} x {height} pixels"));
    }
    parts.push(format!("{} training views, {} withheld", frames.train.len(), frames.test.len()));
    for (table, key, unit) in [
        ("render", "samples", "samples a pixel"),
        ("render", "depth", "path segments"),
        ("face", "texture_size", "texels a side of the true maps"),
    ] {
        parts.extend(value(table, key).map(|value| format!("{value} {unit}")));
    }
    parts.extend(value("render", "seed").map(|seed| format!("seed {seed}")));
    Ok(parts.join(", "))
}

/// Textures and seeds of a solver over all cases, in words; none if its records have neither.
fn maker(run: &Finished, id: &str) -> Result<Option<String>, ReportError> {
    let keys = [("version", "version"), ("texture_size", "texels a side"), ("seed", "seed")];
    let mut found = keys.map(|_| BTreeSet::new());
    let mut title = None;
    let mut cut = 0;
    for case in &run.manifest.cases {
        for method in case.methods.iter().filter(|method| method.id == id) {
            title = Some(method.title().to_owned());
            let Some(maps) = &method.maps else { continue };
            let path = run.folder.join(maps).join("solve.json");
            let solve = run::read_json_if_present::<Value>(&path)?.unwrap_or_default();
            cut += usize::from(interrupted(&solve).is_some());
            for ((key, _), found) in keys.iter().zip(&mut found) {
                found.extend(solve.get(key).map(plain));
            }
        }
    }
    let mut parts: Vec<String> = keys
        .iter()
        .zip(&found)
        .filter(|(_, values)| !values.is_empty())
        .map(|((key, unit), values)| {
            let values = values.iter().cloned().collect::<Vec<_>>().join(" or ");
            if *key == "texture_size" {
                format!("{values} {unit}")
            } else {
                format!("{unit} {values}")
            }
        })
        .collect();
    if cut > 0 {
        parts.push(format!("interrupted in {cut} of {} cases", run.manifest.cases.len()));
    }
    Ok(title.filter(|_| !parts.is_empty()).map(|title| format!("{title}: {}", parts.join(", "))))
}
