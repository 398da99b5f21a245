//! Panels that several figures have: inputs, maps, views, errors.

use std::path::Path;

use formats::picture::{Content, Picture};

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
    /// A picture or one of its layers; none if it was not made.
    pub fn picture(
        &self,
        name: &str,
        path: Option<&Path>,
        layer: &Layer,
        caption: String,
    ) -> Result<Option<Panel>, ReportError> {
        let found = match path {
            Some(path) => read_if_present(path, layer.channels, Content::Colour)?,
            None => None,
        };
        let panel = |picture| self.panel(name, &tone::colour(&picture, layer.exposure), caption);
        found.map(panel).transpose()
    }

    /// The training view nearest to the first withheld one.
    pub fn input(
        &self,
        source: &CaseSource,
        frames: &Frames,
    ) -> Result<Option<Panel>, ReportError> {
        let direction = frames.test.first().map_or([0.0, 0.0, 1.0], |frame| frame.direction);
        let Some(index) = frames.nearest_train(direction) else { return Ok(None) };
        let image = Some(frames.train[index].image.as_path());
        self.picture(&format!("{}-input", source.case.id), image, &Layer::ALL, String::new())
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
        let mask =
            frame.mask.as_ref().map(|mask| read_mask_if_present(mask)).transpose()?.flatten();
        let field = difference::field(&made, &truth, mask.as_ref(), ERROR, 1.0);
        let panel =
            |field| self.panel(name, &tone::false_colour(&field, ERROR.top()), String::new());
        field.map(panel).transpose()
    }
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
