//! Whether a solver's own trust in its texels means something: a foreign solver may leave none.

use std::path::Path;

use solver::picture::{self, Picture};

use super::ScoreError;
use super::protocol::MAP_BLOCK;
use super::rows::{Compared, Floors, Heading, rows};
use super::scores::Row;
use super::truth::Truth;
use crate::metrics::{Pair, Scale, ScaleMode, resample};

const FILE: &str = "confidence.exr";
const METRICS: [&str; 2] = ["confidence_rank", "sparsification"];

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
    let confidence = resample(&picture::read_exr(&path, &["Y"])?, width, height);
    let albedo = resample(albedo, width, height);
    let pair = Pair::new(&albedo, &truth.diffuse_albedo, &truth.region)
        .map(|pair| pair.scaled(scale.factors(ScaleMode::Global)))
        .and_then(|pair| pair.with_confidence(&confidence))
        .map_err(wrong)?;
    let scale = ScaleMode::Global.id();
    let heading =
        Heading { subject: "confidence", light: None, scale, label: None, block: MAP_BLOCK };
    rows(heading, &METRICS, &[Compared { frame: None, pair }], &Floors::new())
}
