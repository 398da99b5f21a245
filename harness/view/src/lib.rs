//! The recovered head in the browser: a capture, its truth and the maps of up to three methods as one folder that
//! opens from disk, without a server and without a network.
//!
//! [`write`] leaves `index.html`, the viewer's scripts, and the data as scripts that are loaded when they are shown.
//! A report writes the viewer once with [`write_shared`] and one page per case with [`write_head`].

mod error;
mod errors;
mod geometry;
mod limits;
mod packed;
mod page;
mod panes;
mod sources;
mod views;
mod visibility;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use capture::Capture;
use formats::atomic::{self, Folder};
use serde::Serialize;

pub use error::ViewError;
pub use limits::MOST_METHODS;
pub use page::write_shared;
pub use sources::MethodMaps;

use errors::Compared;
use geometry::Geometry;
use packed::{Array, Stored};
use panes::{Pane, StoredLight};
use sources::Source;
use views::Views;

/// Everything that a page knows before it loads an array.
#[derive(Serialize)]
struct Scene {
    title: String,
    mesh: Geometry,
    views: Views,
    panes: Vec<Pane>,
    /// The lights, by name, in which the suite relights the head.
    lights: Vec<(String, StoredLight)>,
    /// Why one light does not describe all pictures, if so; nothing is predicted then.
    moving_light: Option<&'static str>,
    label_names: BTreeMap<u8, String>,
    labels: Option<Stored>,
    /// For each measure the value where the colours of its errors end.
    tops: BTreeMap<String, f64>,
}

/// Writes the page of a capture and maps of methods to the folder `out`, replacing an earlier page; returns the page.
///
/// # Errors
/// If a folder cannot be read or written, or there are more than [`MOST_METHODS`]; then an earlier page stays.
pub fn write(capture: &Path, methods: &[MethodMaps], out: &Path) -> Result<PathBuf, ViewError> {
    let inputs: Vec<&Path> =
        std::iter::once(capture).chain(methods.iter().map(|method| &*method.folder)).collect();
    atomic::refuse_overlap(out, &inputs)?;
    let folder = Folder::begin(out)?;
    let title = capture.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
    let written = write_shared(folder.path())
        .and_then(|()| write_head(capture, methods, &title, folder.path(), ""));
    match written {
        Ok(()) => folder.commit()?,
        Err(error) => {
            folder.abandon();
            return Err(error);
        }
    }
    Ok(out.join("index.html"))
}

/// Writes the page of one head into `folder`, which exists; `shared` is the way from there to the folder that
/// [`write_shared`] filled, as an address that ends in a slash, or empty.
///
/// # Errors
/// As [`write`].
pub fn write_head(
    capture: &Path,
    methods: &[MethodMaps],
    title: &str,
    folder: &Path,
    shared: &str,
) -> Result<(), ViewError> {
    if methods.len() > MOST_METHODS {
        return Err(ViewError::TooMany(methods.len()));
    }
    let truth_folder = capture.join("truth");
    let truth = truth_folder.is_dir().then(|| Source::read(&truth_folder)).transpose()?;
    let labels = sources::labels(&truth_folder)?;
    let sources: Vec<Source> =
        methods.iter().map(|method| Source::read(&method.folder)).collect::<Result<_, _>>()?;
    let capture = Capture::reopen(capture)?;
    let mut panes = Vec::new();
    if let Some(truth) = &truth {
        panes.push(Pane::write(truth, "truth", "truth", true, folder)?);
    }
    let compared = truth.as_ref().map(|truth| {
        let reason = |reason| ViewError::Compare { path: truth_folder.clone(), reason };
        Compared::new(truth, labels.as_ref()).map_err(reason)
    });
    let compared = compared.transpose()?;
    let mut all_tops: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (at, (method, source)) in methods.iter().zip(&sources).enumerate() {
        let mut pane = Pane::write(source, &format!("method{at}"), &method.title, false, folder)?;
        if let Some(compared) = &compared {
            pane.factor = compared.factor(&source.maps);
            for errors in compared.errors(source, pane.factor.unwrap_or(1.0)) {
                all_tops.entry(errors.measure.to_owned()).or_default().push(errors.top());
                pane.worst.extend(compared.worst(&errors));
            }
        }
        for (map, stated) in &source.deviations {
            // Green stands for a colour.
            let top = errors::top_of(stated, stated.channels / 2);
            all_tops.entry(format!("{map}_std")).or_default().push(top);
        }
        panes.push(pane);
    }
    let side = panes_side(truth.iter().chain(&sources));
    let others = sources::other_lights(&truth_folder)?.into_iter().enumerate();
    let lights = others.map(|(at, (name, light))| {
        Ok((name, StoredLight::write(&light, true, folder, &format!("light{at}"))?))
    });
    let lights = lights.collect::<Result<_, ViewError>>()?;
    let scene = Scene {
        title: title.to_owned(),
        mesh: Geometry::write(&capture.mesh, folder)?,
        views: Views::write(&capture, side, folder)?,
        panes,
        lights,
        moving_light: capture.lights.beyond_one_still_light(),
        label_names: capture.label_names.clone(),
        labels: labels.map(|map| Array::gray(&map).write(folder, "labels")).transpose()?,
        tops: all_tops.into_iter().map(|(measure, tops)| (measure, median(tops))).collect(),
    };
    let path = folder.join("data/scene.js");
    let text = serde_json::to_string(&scene)
        .map_err(|error| ViewError::write(&path, std::io::Error::from(error)))?;
    // A title may hold what would end the script.
    let text = format!("unshadeView.open({});\n", text.replace("</", "<\\/"));
    std::fs::write(&path, text).map_err(|error| ViewError::write(&path, error))?;
    page::write_page(folder, title, shared)
}

/// Side of the texture whose texels are looked up in the views: that of the first maps, 512 at most.
fn panes_side<'a>(mut sources: impl Iterator<Item = &'a Source>) -> usize {
    let first = sources.find_map(|source| source.maps.diffuse_albedo.as_ref());
    first.map_or(1, |map| map.width.min(512))
}

/// The middle value, the lower one of two: one method that is far off does not stretch the scale of all.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied().unwrap_or(0.0)
}
