//! The pictures and maps of a method beside the true ones, by their files: for metrics that are not part of this
//! program, such as a network or a user's function.

use std::path::{Path, PathBuf};

use formats::picture::read_png_gray;
use serde::{Deserialize, Serialize};

use super::ScoreError;
use super::photographs::{self, FOUND_LIGHT, is_photographed};
use super::pictures::Frame;
use super::scores::Row;
use super::truth::{self, Identity};
use crate::metrics::Region;

/// A picture of a withheld view, or a map, beside the true one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shown {
    /// `view`, `relit`, or a map.
    pub subject: String,
    /// The light it is relit in.
    pub light: Option<String>,
    /// `none` or `global`.
    pub scale: String,
    /// The name of the view; empty for a map.
    pub frame: String,
    /// The method's picture, a linear EXR.
    pub picture: PathBuf,
    /// The true one, or the photograph.
    pub truth: PathBuf,
    /// The mask of the compared pixels, before the erosion.
    pub mask: PathBuf,
    /// The factor that the method's values are multiplied with first.
    pub factor: f64,
}

/// Every picture that [`score`](super::score()) compares as a whole, those of one row together.
pub fn shown(capture: &Path, maps: &Path, relit: Option<&Path>) -> Result<Vec<Shown>, ScoreError> {
    let photographed = is_photographed(capture);
    let (light, frames, lights) = if photographed {
        let light = FOUND_LIGHT.to_owned();
        (light.clone(), photographs::withheld(capture)?, vec![light])
    } else {
        let light = Identity::read(capture)?.light;
        let frames = truth::withheld(capture, &light)?;
        (light, frames, truth::lights(capture)?)
    };
    let true_folder = |light: &str| {
        if photographed { capture.join("images") } else { capture.join("truth/relit").join(light) }
    };
    let mut all = Vec::new();
    let mut add =
        |subject: &str, light: Option<&str>, scale: &str, folder: PathBuf, truth: PathBuf| {
            let of = |frame: &String| Shown {
                subject: subject.to_owned(),
                light: light.map(str::to_owned),
                scale: scale.to_owned(),
                frame: frame.clone(),
                picture: folder.join(format!("{frame}.exr")),
                truth: truth.join(format!("{frame}.exr")),
                mask: capture.join(format!("masks/{frame}.png")),
                factor: 1.0,
            };
            if folder.is_dir() {
                all.extend(frames.iter().map(of));
            }
        };
    add("view", None, "none", maps.join("views"), true_folder(&light));
    let of_light = |light| ["none", "global"].map(|scale| (light, scale));
    if let Some(relit) = relit {
        for (light, scale) in lights.iter().flat_map(of_light) {
            add("relit", Some(light), scale, relit.join(scale).join(light), true_folder(light));
        }
    }
    Ok(all)
}

/// The file of the true picture of a withheld view, in the capture's own light: a photograph, or part of the truth.
pub fn withheld_picture(capture: &Path, frame: &str) -> Result<PathBuf, ScoreError> {
    if is_photographed(capture) {
        return Ok(capture.join(format!("images/{frame}.exr")));
    }
    let light = Identity::read(capture)?.light;
    Ok(truth::folder(capture)?.join("relit").join(light).join(format!("{frame}.exr")))
}

/// Maps that have a true one.
const MAPS: [&str; 5] =
    ["diffuse_albedo", "specular_albedo", "diffuse_normal", "specular_normal", "roughness"];

/// Every map of a folder that the capture has the truth of; the diffuse albedo after one factor too, if it is given.
pub fn shown_maps(capture: &Path, maps: &Path, global: Option<f64>) -> Vec<Shown> {
    let truth = capture.join("truth");
    let of = |subject: &str, scale: &str, factor: f64| Shown {
        subject: subject.to_owned(),
        light: None,
        scale: scale.to_owned(),
        frame: String::new(),
        picture: maps.join(format!("{subject}.exr")),
        truth: truth.join(format!("{subject}.exr")),
        mask: truth.join("coverage.png"),
        factor,
    };
    let mut all: Vec<Shown> = MAPS.iter().map(|subject| of(subject, "none", 1.0)).collect();
    all.extend(global.map(|factor| of(MAPS[0], "global", factor)));
    all.retain(|shown| shown.picture.is_file() && shown.truth.is_file());
    all
}

/// The rows of a metric that gave every one of `shown` a value, or none where it is not defined: the mean over the
/// frames of each, without an interval, since nothing is known within a picture.
pub fn judged_rows(
    capture: &Path,
    shown: &[Shown],
    metric: &str,
    values: &[Option<f64>],
) -> Result<Vec<Row>, ScoreError> {
    let judged: Vec<(&Shown, Option<f64>)> = shown.iter().zip(values.iter().copied()).collect();
    let rows = judged.chunk_by(|(a, _), (b, _)| {
        (&a.subject, &a.light, &a.scale) == (&b.subject, &b.light, &b.scale)
    });
    rows.map(|row| {
        let first = row[0].0;
        let is_map = first.frame.is_empty();
        let (region, n) = if is_map {
            let mask = read_png_gray(&first.mask)?;
            let region =
                Region::eroded("coverage-e5", &mask).map_err(ScoreError::of("coverage"))?;
            ("coverage-e5", region.pixels().len() as u64)
        } else {
            let names = row.iter().map(|(shown, _)| shown.frame.clone()).collect();
            let frames = Frame::of(capture, names)?;
            ("mask-e5", frames.iter().map(|frame| frame.pixels().len() as u64).sum())
        };
        let defined: Vec<f64> = row.iter().filter_map(|(_, value)| *value).collect();
        let mean = defined.iter().sum::<f64>() / defined.len() as f64;
        let of_frame = |(shown, value): &(&Shown, Option<f64>)| {
            value.filter(|_| !is_map).map(|value| (shown.frame.clone(), value))
        };
        Ok(Row {
            subject: first.subject.clone(),
            metric: metric.to_owned(),
            scale: first.scale.clone(),
            region: region.to_owned(),
            label: None,
            light: first.light.clone(),
            value: (!defined.is_empty()).then_some(mean),
            ci95: None,
            block: None,
            n,
            floor: None,
            per_frame: row.iter().filter_map(of_frame).collect(),
        })
    })
    .collect()
}
