//! The comparison figures of the maps.

use formats::picture::Content;
use rayon::prelude::*;
use scoring::metrics::resample;

use super::comparison_figures::{self, ComparisonFigure, Made, Show, Studio, Subject};
use super::difference::Measure;
use super::error::ReportError;
use super::reference::Reference;

/// A map as it is shown and compared.
pub(super) struct MapKind {
    pub subject: &'static str,
    pub title: &'static str,
    pub channels: &'static [&'static str],
    pub show: Show,
    pub measure: Measure,
    metric: &'static str,
}

const RGB: &[&str] = &["R", "G", "B"];

pub(super) const MAPS: [MapKind; 4] = [
    MapKind {
        subject: "diffuse_albedo",
        title: "Diffuse albedo",
        channels: RGB,
        show: Show::Colour { exposure: 1.0 },
        measure: Measure::ColourDifference,
        metric: "psnr_srgb",
    },
    MapKind {
        subject: "specular_albedo",
        title: "Specular albedo",
        channels: &["Y"],
        show: Show::Grey { white: 0.05 },
        measure: Measure::Value,
        metric: "rmse",
    },
    MapKind {
        subject: "specular_normal",
        title: "Specular normal",
        channels: RGB,
        show: Show::Normal,
        measure: Measure::Angle,
        metric: "normal_mean_deg",
    },
    MapKind {
        subject: "diffuse_normal",
        title: "Diffuse normal",
        channels: RGB,
        show: Show::Normal,
        measure: Measure::Angle,
        metric: "normal_mean_deg",
    },
];

impl MapKind {
    /// Returns whether its numbers are colours.
    pub fn content(&self) -> Content {
        match self.show {
            Show::Colour { .. } => Content::Colour,
            Show::Grey { .. } | Show::Normal => Content::Data,
        }
    }
}

impl Studio<'_> {
    /// One figure per map whose truth the capture has.
    pub fn map_figures(&self) -> Result<Vec<ComparisonFigure>, ReportError> {
        MAPS.par_iter().filter_map(|kind| self.map_figure(kind).transpose()).collect()
    }

    fn map_figure(&self, kind: &MapKind) -> Result<Option<ComparisonFigure>, ReportError> {
        let file = format!("{}.exr", kind.subject);
        let folder = self.frames.root.join("truth");
        let path = folder.join(&file);
        let Some(truth) =
            comparison_figures::read_if_present(&path, kind.channels, kind.content())?
        else {
            return Ok(None);
        };
        let subject = Subject {
            name: kind.subject.to_owned(),
            title: String::new(),
            // The face looks along +Z.
            input: self.frames.nearest_train([0.0, 0.0, 1.0]),
            truth,
            path,
            mask: comparison_figures::read_mask_if_present(&folder.join("coverage.png"))?,
            show: kind.show,
            measure: kind.measure,
            scaled: kind.subject == "diffuse_albedo",
            values: matches!(kind.subject, "diffuse_albedo" | "specular_normal"),
        };
        let strip = self.strip(&subject, |method| {
            let Some(maps) = &method.maps else { return Ok(None) };
            let path = maps.join(&file);
            let map = comparison_figures::read_if_present(&path, kind.channels, kind.content())?;
            // After the factor, as the last error picture; a column without one has it as it is.
            let find = |scale| method.column.find(kind.subject, None, kind.metric, scale);
            let score = if subject.scaled { find("global") } else { None };
            let words = if score.is_some() { " after one factor" } else { "" };
            let score = score.or_else(|| find("none"));
            Ok(map.map(|map| {
                let (width, height) = (subject.truth.width, subject.truth.height);
                let picture = resample(&map, width, height);
                let caption = comparison_figures::caption(score, None) + words;
                Made { picture, path, caption }
            }))
        })?;
        let title = kind.title.to_owned();
        Ok(Some(ComparisonFigure::new(
            (kind.subject, None),
            Reference::Truth,
            title,
            kind.show,
            kind.measure,
            vec![strip],
        )))
    }
}
