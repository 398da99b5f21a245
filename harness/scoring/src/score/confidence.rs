//! A solver's confidence and stated deviations against its errors; another's solver may leave neither.

use std::path::Path;

use formats::picture::{self, Content, Picture};

use super::ScoreError;
use super::rows::{Compared, Floors, Heading, rows};
use super::scores::Row;
use super::truth::Truth;
use crate::metrics::{MetricError, Pair, Scale, ScaleMode, resample, scored};

/// A file beside the maps, with its channels; the subject and the metrics of its rows; its place in a pair.
struct Stated {
    file: &'static str,
    channels: &'static [&'static str],
    subject: &'static str,
    metrics: &'static [&'static str],
    add: for<'a> fn(Pair<'a>, &'a Picture) -> Result<Pair<'a>, MetricError>,
}

const CONFIDENCE: Stated = Stated {
    file: "confidence.exr",
    channels: &["Y"],
    subject: "confidence",
    metrics: &scored::CONFIDENCE,
    add: |pair, values| pair.with_confidence(values),
};
const DEVIATION: Stated = Stated {
    file: "diffuse_albedo_std.exr",
    channels: &["R", "G", "B"],
    subject: "diffuse_albedo_std",
    metrics: &scored::DEVIATION,
    add: |pair, values| pair.with_deviation(values),
};

/// Rows of confidence and deviations against the error of the diffuse albedo after its one factor, which is no texel's
/// fault; none without their files.
pub(super) fn rows_of_confidence(
    maps: &Path,
    albedo: &Picture,
    truth: &Truth,
    scale: &Scale,
) -> Result<Vec<Row>, ScoreError> {
    let (width, height) = truth.region.size();
    let mut found = Vec::new();
    for stated in [CONFIDENCE, DEVIATION] {
        let path = maps.join(stated.file);
        if !path.exists() {
            continue;
        }
        let values = resample(&read(maps, &path, stated.channels)?, width, height);
        let albedo = resample(albedo, width, height);
        let pair = Pair::new(&albedo, &truth.diffuse_albedo, &truth.region)
            .map(|pair| pair.scaled(scale.factors(ScaleMode::Global)))
            .and_then(|pair| (stated.add)(pair, &values))
            .map_err(ScoreError::of(stated.subject))?;
        let scale = ScaleMode::Global.id();
        let heading = Heading { subject: stated.subject, light: None, scale, label: None };
        let compared = [Compared { frame: None, pair }];
        found.extend(rows(heading, stated.metrics, &compared, &Floors::new())?);
    }
    Ok(found)
}

/// The values; finite wherever the maps have data. A file of one channel has it for all.
fn read(maps: &Path, path: &Path, channels: &[&str]) -> Result<Picture, ScoreError> {
    let names = picture::exr_channel_names(path)?;
    let channels = match names.as_slice() {
        [one] => &vec![one.as_str(); channels.len()],
        _ => channels,
    };
    let mut found = picture::read_exr_unchecked(path, channels, Content::Data)?;
    let coverage = maps.join("coverage.png");
    if coverage.exists() {
        let coverage = picture::read_png_gray(&coverage)?;
        if (coverage.width, coverage.height) == (found.width, found.height) {
            found.blacken_not_finite(|texel| coverage.data[texel] == 0);
        }
    }
    found.require_finite(path, channels)?;
    Ok(found)
}
