//! `SCORES.json`.

use std::collections::BTreeMap;
use std::path::Path;

use formats::atomic;
use formats::picture::GrayImage;
use serde::{Deserialize, Serialize};

use super::ScoreError;
use super::protocol::Protocol;
use crate::check::Finding;
use crate::metrics::{OwnMetric, Region, Scale};

/// The format that is written and read.
const FORMAT: u32 = 1;

/// The scores of one solver on one capture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Version of the file format.
    pub format: u32,
    /// Name of the capture's folder.
    pub capture: String,
    /// Name of the face.
    pub face: String,
    /// Individual typology angle of the face's mean true skin colour, degrees; absent where no truth
    /// or no skin is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skin_tone: Option<f64>,
    /// Name of the light of the capture.
    pub light: String,
    /// Name of the solver.
    pub solver: String,
    /// The protocol of the numbers.
    pub protocol: Protocol,
    /// Hashes of what was scored.
    pub inputs: Inputs,
    /// Factors that align the diffuse albedo; none without one.
    pub scale: Option<Scale>,
    /// The size of each region.
    pub regions: Vec<RegionSize>,
    /// Likely faults of the maps; absent of sound ones.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub findings: Vec<Finding>,
    /// Metrics of the rows that are not unshade's own; absent where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub metrics: Vec<OwnMetric>,
    /// The numbers.
    pub rows: Vec<Row>,
}

/// BLAKE3 hashes of the folders that were scored.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Inputs {
    /// The capture with its truth.
    pub capture: String,
    /// The maps.
    pub maps: String,
    /// The relit pictures.
    pub relit: Option<String>,
}

/// The size of a region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionSize {
    /// As in row ids; pictures name their frame: `mask-e5/010`.
    pub region: String,
    /// The pixels.
    pub pixels: usize,
    /// The region's share of the mask before the erosion.
    pub share: f64,
    /// Share of it for which the solver says that it had data; none if it does not say.
    pub solved: Option<f64>,
    /// Mean side of a texel on the face, millimetres; none for regions of pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texel_mm: Option<f64>,
}

impl RegionSize {
    pub(super) fn new(region: &Region, name: &str, mask: &GrayImage, solved: Option<f64>) -> Self {
        let pixels = region.pixels().len();
        let foreground = mask.data.iter().filter(|value| **value > 127).count();
        Self {
            region: name.to_owned(),
            pixels,
            share: pixels as f64 / foreground as f64,
            solved,
            texel_mm: None,
        }
    }
}

/// One number with its protocol.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Subject: `diffuse_albedo`, `view`, `relit`, ...
    pub subject: String,
    /// Id of the metric.
    pub metric: String,
    /// `none`, `global`, `channel` or `median`.
    pub scale: String,
    /// The region of the comparison.
    pub region: String,
    /// Part of the face; none for all of it.
    pub label: Option<String>,
    /// The light it is relit in.
    pub light: Option<String>,
    /// The number, pooled over the frames; none where the metric is not defined.
    pub value: Option<f64>,
    /// 95 % confidence interval.
    pub ci95: Option<[f64; 2]>,
    /// Side of the blocks of its bootstrap, texels or pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block: Option<usize>,
    /// Pixels or texels.
    pub n: u64,
    /// The value that rendering noise alone would allow.
    pub floor: Option<f64>,
    /// The number of each frame.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub per_frame: BTreeMap<String, f64>,
}

impl Row {
    /// `<subject>[/light]/<metric>@<region>[.label]:<scale>`.
    pub fn id(&self) -> String {
        let light = self.light.as_ref().map_or(String::new(), |light| format!("/{light}"));
        let label = self.label.as_ref().map_or(String::new(), |label| format!(".{label}"));
        let Self { subject, metric, region, scale, .. } = self;
        format!("{subject}{light}/{metric}@{region}{label}:{scale}")
    }
}

impl Scores {
    pub(super) const FORMAT: u32 = FORMAT;

    /// The row with an id.
    pub fn row(&self, id: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.id() == id)
    }

    /// Reads a scores file.
    pub fn read(path: &Path) -> Result<Self, ScoreError> {
        let bytes = std::fs::read(path).map_err(|error| ScoreError::io(path, error))?;
        Self::from_bytes(path, &bytes)
    }

    /// Reads the scores file `file` of a run's folder, which may not be finished.
    pub(crate) fn of_run(run: &Path, file: &Path) -> Result<Self, ScoreError> {
        let path = run.join(file);
        if !path.exists() {
            return Err(ScoreError::Unfinished {
                run: run.to_path_buf(),
                file: file.to_path_buf(),
            });
        }
        Self::read(&path)
    }

    /// Reads a scores file in memory; `path` is for messages.
    pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<Self, ScoreError> {
        let scores: Self =
            serde_json::from_slice(bytes).map_err(|error| ScoreError::text(path, error))?;
        if scores.format != FORMAT {
            let reason =
                format!("has format {}, this version reads {FORMAT}; score again", scores.format);
            return Err(ScoreError::text(path, reason));
        }
        for metric in &scores.metrics {
            metric.register().map_err(|error| ScoreError::text(path, error))?;
        }
        Ok(scores)
    }

    /// Writes a scores file, completely or not at all; equal scores give equal bytes.
    pub fn write(&self, path: &Path) -> Result<(), ScoreError> {
        let mut text =
            serde_json::to_string_pretty(self).map_err(|error| ScoreError::text(path, error))?;
        text.push('\n');
        atomic::write_file(path, text.as_bytes()).map_err(|error| ScoreError::io(path, error))
    }
}
