//! The correlation of a solver's confidence with its errors; another's solver may leave no confidence.

use std::path::Path;

use formats::picture::{self, Content, Picture};

use super::ScoreError;
use super::rows::{Compared, Floors, Heading, rows};
use super::scores::Row;
use super::truth::Truth;
use crate::metrics::{Pair, Scale, ScaleMode, resample, scored};

const FILE: &str = "confidence.exr";

/// Rows of the confidence against the error of the diffuse albedo after its one factor, which is
/// no texel's fault; none without a confidence.
pub(super) fn rows_of_confidence(
    maps: &Path,
    albedo: &Picture,
    truth: &Truth,
    scale: &Scale,
) -> Result<Vec<Row>, ScoreError> {
    let path = maps.join(FILE);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let wrong = ScoreError::of("confidence");
    let (width, height) = truth.region.size();
    let confidence = resample(&read(maps, &path)?, width, height);
    let albedo = resample(albedo, width, height);
    let pair = Pair::new(&albedo, &truth.diffuse_albedo, &truth.region)
        .map(|pair| pair.scaled(scale.factors(ScaleMode::Global)))
        .and_then(|pair| pair.with_confidence(&confidence))
        .map_err(wrong)?;
    let scale = ScaleMode::Global.id();
    let heading = Heading { subject: "confidence", light: None, scale, label: None };
    rows(heading, &scored::CONFIDENCE, &[Compared { frame: None, pair }], &Floors::new())
}

/// The confidence; finite wherever the maps have data.
fn read(maps: &Path, path: &Path) -> Result<Picture, ScoreError> {
    let mut confidence = picture::read_exr_unchecked(path, &["Y"], Content::Data)?;
    let coverage = maps.join("coverage.png");
    if coverage.exists() {
        let coverage = picture::read_png_gray(&coverage)?;
        if (coverage.width, coverage.height) == (confidence.width, confidence.height) {
            confidence.blacken_not_finite(|texel| coverage.data[texel] == 0);
        }
    }
    confidence.require_finite(path, &["Y"])?;
    Ok(confidence)
}
