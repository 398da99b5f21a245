//! The files of the viewer: the page, its style, its scripts, and three.js.

use std::path::Path;

use crate::error::ViewError;

/// The scripts, in the order in which a page loads them.
const SCRIPTS: [(&str, &str); 16] = [
    ("three.js", include_str!("page/vendor/three.js")),
    ("arrays.js", include_str!("page/arrays.js")),
    ("colours.js", include_str!("page/colours.js")),
    ("head.js", include_str!("page/head.js")),
    ("shaders.js", include_str!("page/shaders.js")),
    ("reflectance.js", include_str!("page/reflectance.js")),
    ("lights.js", include_str!("page/lights.js")),
    ("lamp.js", include_str!("page/lamp.js")),
    ("layers.js", include_str!("page/layers.js")),
    ("panes.js", include_str!("page/panes.js")),
    ("answer.js", include_str!("page/answer.js")),
    ("spot.js", include_str!("page/spot.js")),
    ("worst.js", include_str!("page/worst.js")),
    ("stills.js", include_str!("page/stills.js")),
    ("address.js", include_str!("page/address.js")),
    ("main.js", include_str!("page/main.js")),
];

const STYLE: (&str, &str) = ("style.css", include_str!("page/style.css"));
const LICENSE: (&str, &str) = ("three.LICENSE.txt", include_str!("page/vendor/three.LICENSE.txt"));
const PAGE: &str = include_str!("page/index.html");

/// Writes what all pages of a report share into `folder`.
pub fn write_shared(folder: &Path) -> Result<(), ViewError> {
    for (name, text) in SCRIPTS.into_iter().chain([STYLE, LICENSE]) {
        write(&folder.join(name), text)?;
    }
    Ok(())
}

/// Writes the page of the head whose data lie beside it; `shared` is the way to the shared files.
pub(crate) fn write_page(folder: &Path, title: &str, shared: &str) -> Result<(), ViewError> {
    let viewer = SCRIPTS.map(|(name, _)| format!("{shared}{name}"));
    // The manifest calls a function of the viewer.
    let scripts: String = (viewer.iter().map(String::as_str).chain(["data/scene.js"]))
        .map(|source| format!("<script src=\"{source}\"></script>\n"))
        .collect();
    let page = PAGE
        .replace("{title}", &escaped(title))
        .replace("{style}", &format!("{shared}{}", STYLE.0))
        .replace("{license}", &format!("{shared}{}", LICENSE.0))
        .replace("{scripts}", &scripts);
    write(&folder.join("index.html"), &page)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

fn write(path: &Path, text: &str) -> Result<(), ViewError> {
    std::fs::write(path, text).map_err(|error| ViewError::write(path, error))
}
