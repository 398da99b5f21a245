//! A solver's confidence and stated deviations against its errors; another's solver may leave neither.

use std::path::Path;

use formats::maps::read_deviation;
use formats::picture::{self, Content, Picture};

use super::ScoreError;
use super::rows::{Compared, Floors, Heading, rows};
use super::scores::Row;
use super::truth::Truth;
use crate::metrics::{MetricError, Pair, Scale, ScaleMode, resample, scored};

const CONFIDENCE: &str = "confidence.exr";
const DEVIATION: &str = "diffuse_albedo_std.exr";

/// Rows that compare confidence and stated deviations with the error of the diffuse albedo after its one factor; none
/// without their files.
pub(super) fn rows_of_confidence(
    maps: &Path,
    albedo: &Picture,
    truth: &Truth,
    scale: &Scale,
) -> Result<Vec<Row>, ScoreError> {
    let (width, height) = truth.region.size();
    let albedo = resample(albedo, width, height);
    let pair = || {
        let pair = Pair::new(&albedo, &truth.diffuse_albedo, &truth.region);
        pair.map(|pair| pair.scaled(scale.factors(ScaleMode::Global)))
    };
    let mut found = Vec::new();
    let path = maps.join(CONFIDENCE);
    if path.exists() {
        let confidence = picture::read_exr_unchecked(&path, &["Y"], Content::Data)?;
        let confidence = resample(&finite(maps, CONFIDENCE, confidence)?, width, height);
        let pair = pair().and_then(|pair| pair.with_confidence(&confidence));
        found.extend(rows_of("confidence", &scored::CONFIDENCE, pair)?);
    }
    if let Some(stated) = read_deviation(maps, "diffuse_albedo", &["R", "G", "B"])? {
        let stated = resample(&finite(maps, DEVIATION, stated)?, width, height);
        let pair = pair().and_then(|pair| pair.with_deviation(&stated));
        found.extend(rows_of("diffuse_albedo_std", &scored::DEVIATION, pair)?);
    }
    Ok(found)
}

fn rows_of(
    subject: &str,
    metrics: &[&str],
    pair: Result<Pair, MetricError>,
) -> Result<Vec<Row>, ScoreError> {
    let pair = pair.map_err(ScoreError::of(subject))?;
    let heading = Heading { subject, light: None, scale: ScaleMode::Global.id(), label: None };
    rows(heading, metrics, &[Compared { frame: None, pair }], &Floors::new())
}

/// Requires finite values wherever the maps have data.
fn finite(maps: &Path, file: &str, mut found: Picture) -> Result<Picture, ScoreError> {
    let coverage = maps.join("coverage.png");
    if coverage.exists() {
        let coverage = picture::read_png_gray(&coverage)?;
        if (coverage.width, coverage.height) == (found.width, found.height) {
            found.blacken_not_finite(|texel| coverage.data[texel] == 0);
        }
    }
    let names = if found.channels == 1 { &["Y"][..] } else { &["R", "G", "B"] };
    found.require_finite(&maps.join(file), names)?;
    Ok(found)
}
