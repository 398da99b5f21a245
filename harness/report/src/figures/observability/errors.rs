//! The errors of methods at every texel that scores compare.

use std::path::Path;

use formats::picture::{Content, GrayImage, Picture};
use scoring::metrics::resample;

use super::super::panels::ERROR;
use super::super::source::CaseSource;
use crate::comparison_figures::read_if_present;
use crate::difference::{self, Measure};
use crate::error::ReportError;
use crate::table::Column;
use crate::tone::Field;

const ALBEDO: &str = "diffuse_albedo.exr";
const NORMAL: &str = "specular_normal.exr";
const RGB: &[&str] = &["R", "G", "B"];

/// The errors of one method in one case at every texel; NaN outside the scored region.
pub(super) struct Errors {
    pub name: String,
    pub title: String,
    /// RMS over the channels of sRGB values, after the albedo's one factor.
    pub albedo: Field,
    /// Angle of the specular normal, degrees.
    pub normal: Option<Field>,
    /// The method's confidence in its texels, 0 to 1.
    pub confidence: Option<Picture>,
}

impl Errors {
    /// The errors of a method in `compared` texels; none without an albedo.
    pub fn of(
        source: &CaseSource,
        column: &Column,
        compared: &GrayImage,
    ) -> Result<Option<Self>, ReportError> {
        let read = |path: &Path, channels, content| read_if_present(path, channels, content);
        let errors = |file: &str, content: Content, measure, factor| {
            let Some(path) = source.map(column, file) else { return Ok(None) };
            let (Some(map), Some(truth)) =
                (read(&path, RGB, content)?, read(&source.truth(file), RGB, content)?)
            else {
                return Ok::<_, ReportError>(None);
            };
            let map = resample(&map, truth.width, truth.height);
            Ok(difference::field(&map, &truth, Some(compared), measure, factor))
        };
        let factor = column.factor().unwrap_or(1.0);
        let Some(albedo) = errors(ALBEDO, Content::Colour, ERROR, factor)? else { return Ok(None) };
        let normal = errors(NORMAL, Content::Data, Measure::Angle, 1.0)?;
        let confidence = match source.map(column, "confidence.exr") {
            Some(path) => read(&path, &["Y"], Content::Data)?,
            None => None,
        };
        let confidence = confidence.map(|map| resample(&map, albedo.width, albedo.height));
        let (name, title) = (column.method.id.clone(), column.method.title().to_owned());
        Ok(Some(Self { name, title, albedo, normal, confidence }))
    }
}
