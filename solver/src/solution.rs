//! Results of a solve: maps, withheld views, the record, and times.

use std::path::{Path, PathBuf};

use formats::atomic::{self, Folder};
use formats::maps::{Maps, MapsError};
use formats::picture::{self, Picture};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::config::Config;
use crate::maps::{Scales, StageMaps};

/// The result of [`crate::solve`].
#[derive(Clone, Debug)]
pub struct Solution {
    /// The reflectance maps, normalised.
    pub maps: Maps,
    /// Standard deviation of the diffuse albedo after its one factor, R, G, B, reflectance; by the default method.
    pub diffuse_albedo_std: Option<Picture>,
    /// The light of each group of frames by the default method, in the order of [`capture::FrameLights::names`].
    pub lights: Vec<RecoveredLight>,
    /// Every withheld view, rendered by the model.
    pub views: Vec<ViewLayers>,
    /// The maps after every stage, small; empty if the configuration disables them.
    pub stages: Vec<StageMaps>,
    /// All inputs that determine the solution, and the losses.
    pub record: Record,
    /// Wall times.
    pub timing: Timing,
}

/// The results of a method: a solution without its record.
pub(crate) struct Results {
    pub maps: Maps,
    pub diffuse_albedo_std: Option<Picture>,
    pub lights: Vec<RecoveredLight>,
    pub views: Vec<ViewLayers>,
    pub stages: Vec<StageMaps>,
    pub scales: Scales,
    /// Side of the textures that were solved for, texels.
    pub texture_size: usize,
    /// The number of samples of the full pictures.
    pub samples: usize,
}

/// A synthesised view: linear radiance in the pictures' exposure, black where there is no mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewLayers {
    /// The frame's name.
    pub name: String,
    /// Nine channels, see [`ViewLayers::CHANNELS`]; the first three are the sum of the others.
    pub picture: Picture,
}

impl ViewLayers {
    /// Channel names, in order.
    pub const CHANNELS: [&str; 9] = [
        "R",
        "G",
        "B",
        "diffuse.R",
        "diffuse.G",
        "diffuse.B",
        "specular.R",
        "specular.G",
        "specular.B",
    ];
}

impl ViewLayers {
    /// Writes a training view into `layers/` of a maps folder, for viewing: 16-bit floats.
    pub fn write_layers(&self, maps: &Path) -> Result<(), MapsError> {
        let file = place(maps, "layers", &self.name)?;
        Ok(picture::write_exr_half(&file, &self.picture, &Self::CHANNELS)?)
    }
}

/// The content of `solve.json`; nothing in it depends on the time or the number of threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Record {
    /// "unshade".
    pub solver: String,
    /// Version of this crate.
    pub version: String,
    /// Seed of the networks' initial weights.
    pub seed: u64,
    /// Every value of the configuration.
    pub config: Config,
    /// Device and instruction set.
    pub backend: String,
    /// BLAKE3 hash of all input files.
    pub input: String,
    /// The parts of the truth that the solve held fixed: it is privileged unless there are none.
    pub given: Vec<String>,
    /// Where the caller interrupted the solve, such as "warm-up at step 3 of 500"; `None` for a finished solve.
    pub interrupted: Option<String>,
    /// Distance of the light from the head's centre, metres; `None` at infinity, and for the published method.
    pub light_distance: Option<f32>,
    /// "camera" if the lights stand still with respect to the camera; `None` if with respect to the head.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_frame: Option<&'static str>,
    /// The names of the groups of frames, each with its own light in `light/`, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<String>,
    /// Name and gain of every training view: the factor (R, G, B) of its picture relative to the geometric mean of all;
    /// empty unless the capture says that exposures are unknown.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gains: Vec<(String, [f32; 3])>,
    /// Side of the textures that were solved for, texels.
    pub texture_size: usize,
    /// The number of samples of the full pictures.
    pub samples: usize,
    /// Factor on the solved diffuse albedo.
    pub diffuse_scale: f32,
    /// Factor on the solved specular albedo.
    pub specular_scale: f32,
    /// The stages in their order.
    pub stages: Vec<StageRecord>,
}

/// The estimated light: cells of equal angles on a sphere around the head, in the frame of reference in which the light
/// stands still ([`capture::LightFrame`]); that of the camera has +Z towards the camera and +Y up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoveredLight {
    /// Rows of cells; twice as many columns.
    pub rows: usize,
    /// Radius of the sphere, metres; none at infinity.
    pub distance: Option<f32>,
    /// Linear R, G, B of every cell in the pictures' exposure, lat-long in Mitsuba's convention.
    pub radiance: Vec<f32>,
}

impl RecoveredLight {
    /// The radiance as a picture with one pixel per cell.
    pub fn picture(&self) -> Picture {
        let (width, height) = (2 * self.rows, self.rows);
        Picture { width, height, channels: 3, data: self.radiance.clone() }
    }
}

/// A stage of the record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageRecord {
    /// Name of the stage, as in the log and the timing.
    pub name: String,
    /// Loss before every step.
    pub loss: Vec<f64>,
}

/// The content of `timing.json`: seconds per stage, in their order.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Timing {
    /// Stage name to seconds.
    pub seconds: Map<String, Value>,
}

impl Solution {
    /// Writes the maps folder with `views/`, `solve.json` and `timing.json`, completely or not at
    /// all.
    pub fn write(&self, folder: &Path) -> Result<(), MapsError> {
        let partial = Folder::begin(folder)?;
        self.write_into(partial.path())?;
        Ok(partial.commit()?)
    }

    /// Writes the files into an existing folder, for callers that add files.
    pub fn write_into(&self, folder: &Path) -> Result<(), MapsError> {
        self.maps.write_into(folder)?;
        if let Some(deviation) = &self.diffuse_albedo_std {
            picture::write_exr_rgb(&folder.join("diffuse_albedo_std.exr"), deviation)?;
        }
        match self.lights.as_slice() {
            [light] => picture::write_exr_rgb(&folder.join("light.exr"), &light.picture())?,
            lights => {
                for (light, name) in lights.iter().zip(&self.record.lights) {
                    picture::write_exr_rgb(&place(folder, "light", name)?, &light.picture())?;
                }
            }
        }
        for view in &self.views {
            let file = place(folder, "views", &view.name)?;
            picture::write_exr(&file, &view.picture, &ViewLayers::CHANNELS)?;
        }
        for (number, StageMaps { stage, maps }) in self.stages.iter().enumerate() {
            let name = format!("{:02}-{}", number + 1, stage.replace(' ', "-"));
            let folder = folder.join("stages").join(name);
            create(&folder)?;
            maps.write_into(&folder)?;
        }
        write_json(&folder.join("solve.json"), &self.record)?;
        write_json(&folder.join("timing.json"), &self.timing)
    }
}

fn create(folder: &Path) -> Result<(), MapsError> {
    let io = |source| MapsError::Io { path: folder.to_path_buf(), source };
    std::fs::create_dir_all(folder).map_err(io)
}

/// Creates one of the folders of a maps folder if necessary, and returns the path of a frame in it.
fn place(maps: &Path, folder: &str, frame: &str) -> Result<PathBuf, MapsError> {
    let folder = maps.join(folder);
    create(&folder)?;
    Ok(folder.join(format!("{frame}.exr")))
}

/// Where the solve of a maps folder was interrupted; `None` if it was finished, or if unshade did not write the folder.
pub fn interrupted(maps: &Path) -> Option<String> {
    let record: Value =
        serde_json::from_slice(&std::fs::read(maps.join("solve.json")).ok()?).ok()?;
    record.get("interrupted")?.as_str().map(str::to_owned)
}

fn write_json(path: &Path, content: &impl Serialize) -> Result<(), MapsError> {
    let io = |source| MapsError::Io { path: path.to_path_buf(), source };
    let text = serde_json::to_string_pretty(content).map_err(|error| io(error.into()))?;
    atomic::write_file(path, text.as_bytes()).map_err(io)
}
