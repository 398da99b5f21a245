//! Panels that several figures have: inputs, maps, views, errors.

use std::path::Path;

use formats::picture::{Content, GrayImage, Picture};

use super::crop::Crop;
use super::drawing::{Drawing, Panel};
use super::source::CaseSource;
use crate::comparison_figures::{read_if_present, read_mask_if_present};
use crate::difference::{self, Measure};
use crate::error::ReportError;
use crate::maps::MapKind;
use crate::run::{Frame, Frames};
use crate::table::Column;
use crate::tone;
use crate::views::Layer;

/// The measure of the error pictures: the difference of sRGB values, as in the report.
pub(super) const ERROR: Measure = Measure::Display;

impl Drawing {
    /// The head in a picture of a frame, or in one of its layers; none if it was not made.
    pub fn picture(
        &self,
        name: &str,
        path: Option<&Path>,
        layer: &Layer,
        frame: &Frame,
        caption: String,
    ) -> Result<Option<Panel>, ReportError> {
        let found = match path {
            Some(path) => read_if_present(path, layer.channels, Content::Colour)?,
            None => None,
        };
        let Some(found) = found else { return Ok(None) };
        let head = mask_of(frame)?.and_then(|mask| Crop::around(&mask));
        let shown = match head {
            Some(head) => head.of(found),
            None => found,
        };
        self.panel(name, &tone::colour(&shown, layer.exposure), caption).map(Some)
    }

    /// The training view nearest to the first withheld one.
    pub fn input(
        &self,
        source: &CaseSource,
        frames: &Frames,
    ) -> Result<Option<Panel>, ReportError> {
        let direction = frames.test.first().map_or([0.0, 0.0, 1.0], |frame| frame.direction);
        let Some(index) = frames.nearest_train(direction) else { return Ok(None) };
        let frame = &frames.train[index];
        let name = format!("{}-input", source.case.id);
        self.picture(&name, Some(&frame.image), &Layer::ALL, frame, String::new())
    }

    /// A map; none if it was not made.
    pub fn map(
        &self,
        name: &str,
        path: Option<&Path>,
        kind: &MapKind,
    ) -> Result<Option<Panel>, ReportError> {
        let Some(path) = path else { return Ok(None) };
        let map = read_if_present(path, kind.channels, kind.content())?;
        map.map(|map| self.panel(name, &kind.show.raster(&map), String::new())).transpose()
    }

    /// The error of a picture against another inside the face; none if either was not made.
    pub fn error(
        &self,
        name: &str,
        made: Option<&Path>,
        truth: Option<&Path>,
        frame: &Frame,
    ) -> Result<Option<Panel>, ReportError> {
        let read = |path| read_if_present(path, Layer::ALL.channels, Content::Colour);
        let Some(made) = made.map(read).transpose()?.flatten() else { return Ok(None) };
        let Some(truth) = truth.map(read).transpose()?.flatten() else { return Ok(None) };
        let mask = mask_of(frame)?;
        let head = mask.as_ref().and_then(Crop::around);
        let Some(field) = difference::field(&made, &truth, mask.as_ref(), ERROR, 1.0) else {
            return Ok(None);
        };
        let whole =
            Picture { width: field.width, height: field.height, channels: 1, data: field.values };
        let Picture { width, height, data: values, .. } = match head {
            Some(head) => head.of(whole),
            None => whole,
        };
        let field = tone::Field { width, height, values };
        self.panel(name, &tone::false_colour(&field, ERROR.top()), String::new()).map(Some)
    }
}

fn mask_of(frame: &Frame) -> Result<Option<GrayImage>, ReportError> {
    Ok(frame.mask.as_ref().map(|mask| read_mask_if_present(mask)).transpose()?.flatten())
}

/// The metrics below a picture, of one frame or of all.
pub(super) struct PictureScores {
    pub psnr: Option<f64>,
    pub ssim: Option<f64>,
    pub flip: Option<f64>,
}

impl PictureScores {
    /// Scores of a view (`light` none) or of a relit picture after the albedo's one factor.
    pub fn find(column: &Column, light: Option<&str>, frame: Option<&str>) -> Self {
        let subject = if light.is_some() { "relit" } else { "view" };
        let scales: &[&str] = if light.is_some() { &["global", "none"] } else { &["none"] };
        let of = |metric: &str| {
            let row = scales.iter().find_map(|scale| column.find(subject, light, metric, scale))?;
            match frame {
                Some(frame) => row.per_frame.get(frame).copied(),
                None => row.value,
            }
        };
        Self { psnr: of("psnr_srgb"), ssim: of("ssim"), flip: of("flip_mean") }
    }

    pub fn in_words(&self) -> String {
        let parts = [
            self.psnr.map(|value| format!("{value:.2} dB")),
            self.ssim.map(|value| format!("{value:.3}")),
            self.flip.map(|value| format!("{value:.3}")),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(" / ")
    }

    pub fn values(&self) -> [Option<f64>; 3] {
        [self.psnr, self.ssim, self.flip]
    }
}

/// The brightness of a colour picture: the mean of its channels.
pub(super) fn brightness(picture: &Picture) -> Vec<f64> {
    let mean =
        |pixel: &[f32]| pixel.iter().map(|v| f64::from(*v)).sum::<f64>() / pixel.len() as f64;
    picture.data.chunks_exact(picture.channels).map(mean).collect()
}
