//! The pictures of a method beside the true ones, by their files: for a judge that is not part of this
//! program, such as a network.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::ScoreError;
use super::photographs::{self, FOUND_LIGHT, is_photographed};
use super::pictures::Frame;
use super::scores::Row;
use super::truth::{self, Identity};

/// A picture of a withheld view beside the true one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Shown {
    /// `view` or `relit`.
    pub subject: &'static str,
    /// The light it is relit in.
    pub light: Option<String>,
    /// `none` or `global`.
    pub scale: &'static str,
    /// Its name.
    pub frame: String,
    /// The method's picture, a linear EXR.
    pub picture: PathBuf,
    /// The true one, or the photograph.
    pub truth: PathBuf,
    /// What is compared, before the erosion.
    pub mask: PathBuf,
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
    let mut add = |subject, light: Option<&str>, scale, folder: PathBuf, truth: PathBuf| {
        let of = |frame: &String| Shown {
            subject,
            light: light.map(str::to_owned),
            scale,
            frame: frame.clone(),
            picture: folder.join(format!("{frame}.exr")),
            truth: truth.join(format!("{frame}.exr")),
            mask: capture.join(format!("masks/{frame}.png")),
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

/// The rows of a judge who gave every one of `shown` a value: the mean over the frames of each, without an
/// interval, since nothing is known within a picture.
pub fn judged_rows(
    capture: &Path,
    shown: &[Shown],
    metric: &str,
    values: &[f64],
) -> Result<Vec<Row>, ScoreError> {
    let judged: Vec<(&Shown, f64)> = shown.iter().zip(values.iter().copied()).collect();
    let rows = judged.chunk_by(|(a, _), (b, _)| {
        (a.subject, &a.light, a.scale) == (b.subject, &b.light, b.scale)
    });
    rows.map(|row| {
        let first = row[0].0;
        let frames =
            Frame::of(capture, row.iter().map(|(shown, _)| shown.frame.clone()).collect())?;
        Ok(Row {
            subject: first.subject.to_owned(),
            metric: metric.to_owned(),
            scale: first.scale.to_owned(),
            region: "mask-e5".to_owned(),
            label: None,
            light: first.light.clone(),
            value: Some(row.iter().map(|(_, value)| value).sum::<f64>() / row.len() as f64),
            ci95: None,
            block: None,
            n: frames.iter().map(|frame| frame.pixels().len() as u64).sum(),
            floor: None,
            per_frame: row.iter().map(|(shown, value)| (shown.frame.clone(), *value)).collect(),
        })
    })
    .collect()
}
