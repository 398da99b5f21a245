//! `transforms.json`: cameras and file names, as nerfstudio and instant-ngp write them.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use glam::Mat4;
use serde::Deserialize;
use serde_json::Value;

use super::frame::{FileFrame, Frame, Shared, Use, matrix};
use super::frame_lights::{FrameLights, LightFrame, require_all_or_none};
use super::paths::{inside, plain};

/// File of the mesh where `transforms.json` names none.
const MESH: &str = "mesh.obj";

/// Contents of `transforms.json`.
pub(super) struct Transforms {
    pub mesh_path: PathBuf,
    pub train: Vec<Frame>,
    pub withheld: Vec<Frame>,
    pub label_names: BTreeMap<u8, String>,
    /// The transform that the writer of the file applied to all cameras, if it states one.
    pub applied: Option<Mat4>,
    pub lights: FrameLights,
    /// Whether every frame has an unknown factor on each channel.
    pub has_unknown_exposure: bool,
}

#[derive(Deserialize)]
struct File {
    mesh: Option<String>,
    frames: Vec<Value>,
    train_filenames: Option<Vec<String>>,
    #[serde(default)]
    test_filenames: Vec<String>,
    #[serde(default)]
    label_names: BTreeMap<u8, String>,
    /// A hint alone, so that any value passes.
    #[serde(default)]
    applied_transform: Value,
    light_frame: Option<Value>,
    exposure: Option<Value>,
    #[serde(flatten)]
    shared: Shared,
}

impl Transforms {
    /// Parses the content of the file in the capture folder `root`; the error is the reason alone.
    pub fn parse(root: &Path, bytes: &[u8]) -> Result<Self, String> {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let file: File = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        let frames = frames(&file)?;
        require_all_or_none(frames.iter().map(|(path, frame)| (path.as_str(), frame.has_light())))?;
        let light_frame = LightFrame::parse(file.light_frame.as_ref())?;
        let paths = |paths: &[String]| paths.iter().map(|path| plain(path)).collect::<Vec<_>>();
        let test = paths(&file.test_filenames);
        let train = match &file.train_filenames {
            Some(names) if names.is_empty() => {
                return Err(
                    "train_filenames is empty; name at least one picture, or drop the list to \
                     train on all frames"
                        .to_owned(),
                );
            }
            Some(names) => paths(names),
            None => {
                let all = frames.iter().map(|(path, _)| path.clone());
                all.filter(|path| !test.contains(path)).collect()
            }
        };
        if train.is_empty() {
            return Err("has no frame to train on; add frames".to_owned());
        }
        let mut names = HashSet::new();
        let mut pick = |list: &str, paths: &[String], purpose: Use| -> Result<Vec<Frame>, String> {
            let frame = |path: &String| {
                let found = frames.iter().find(|(file_path, _)| file_path == path);
                let (_, found) = found.ok_or_else(|| {
                    format!("{list}: no frame has file_path {path}; add it or drop the name")
                })?;
                let frame = found
                    .resolve(root, path, &file.shared, purpose)
                    .map_err(|reason| format!("frame {path}: {reason}"))?;
                if !names.insert(frame.camera.name.clone()) {
                    let name = &frame.camera.name;
                    return Err(format!(
                        "{list}: frame {name:?} is listed twice; a frame is either for training \
                         or withheld, and has a name of its own"
                    ));
                }
                Ok(frame)
            };
            paths.iter().map(frame).collect()
        };
        let train = pick("train_filenames", &train, Use::Train)?;
        let withheld = pick("test_filenames", &test, Use::Withhold)?;
        let all = train.iter().chain(&withheld);
        let of_frames: Vec<_> = all.map(|frame| (&frame.camera, frame.light.as_deref())).collect();
        let lights = FrameLights::new(light_frame, &of_frames, withheld.len())?;
        let has_unknown_exposure = is_unknown(file.exposure.as_ref())?;
        if let (true, Some(moves)) = (has_unknown_exposure, lights.beyond_one_still_light()) {
            return Err(format!(
                "exposure is \"unknown\", but {moves}; a change of light cannot be told from one of \
                 exposure, so fix the camera's exposure and white balance and drop the key"
            ));
        }
        let mesh_path = match &file.mesh {
            Some(mesh) => inside(root, &plain(mesh)).map_err(|reason| format!("mesh: {reason}"))?,
            None if root.join(MESH).is_file() => root.join(MESH),
            None => {
                return Err(format!(
                    "names no mesh; add \"mesh\": \"{MESH}\" and the file, an OBJ with texture \
                     coordinates"
                ));
            }
        };
        if let Some(name) = file.label_names.get(&0) {
            return Err(format!(
                "label_names: 0 is not a label, but has the name {name:?}; drop it"
            ));
        }
        let applied = Vec::<Vec<f64>>::deserialize(&file.applied_transform).ok();
        let applied = applied.and_then(|rows| matrix(&rows).ok());
        Ok(Self {
            mesh_path,
            train,
            withheld,
            label_names: file.label_names,
            applied,
            lights,
            has_unknown_exposure,
        })
    }
}

/// Parses the value of `exposure`; the error is the reason alone.
fn is_unknown(value: Option<&Value>) -> Result<bool, String> {
    match value {
        None => Ok(false),
        Some(Value::String(text)) if text == "known" => Ok(false),
        Some(Value::String(text)) if text == "unknown" => Ok(true),
        Some(other) => Err(format!(
            "exposure is {other}; write \"unknown\" if exposure and white balance differ between \
             frames by unknown factors, else \"known\""
        )),
    }
}

/// All frames with their pictures' paths.
fn frames(file: &File) -> Result<Vec<(String, FileFrame)>, String> {
    let frame = |(index, value): (usize, &Value)| {
        let shown = match value.get("file_path").and_then(Value::as_str) {
            Some(path) => path.to_owned(),
            None => format!("{} of the list", index + 1),
        };
        let frame = FileFrame::deserialize(value);
        let frame = frame.map_err(|error| format!("frame {shown}: {error}"))?;
        let path = plain(&frame.file_path);
        Ok((if path.contains('.') { path } else { path + ".exr" }, frame))
    };
    file.frames.iter().enumerate().map(frame).collect()
}
