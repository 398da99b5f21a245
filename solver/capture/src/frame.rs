//! One frame of `transforms.json`.

use std::path::{Path, PathBuf};

use glam::{Mat3, Mat4};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use super::Camera;
use super::frame_lights::light_name;
use super::lens::Distortion;
use super::paths::{inside, plain};

/// The tolerated distance of `transform_matrix` from a rotation, per entry of RᵀR - 1: single precision and
/// six printed digits pass, a scale or a shear does not.
const RIGID_TOLERANCE: f32 = 1e-3;
/// Pixels along an edge, at most: no sensor has more, and larger numbers are mistakes.
const LARGEST: f64 = 65535.0;

/// One frame: a camera and its files, not opened.
pub(super) struct Frame {
    /// The camera once its lens is taken out.
    pub camera: Camera,
    /// The lens; `None` for a pinhole.
    pub distortion: Option<Distortion>,
    pub image_path: PathBuf,
    pub mask_path: PathBuf,
    pub label_path: Option<PathBuf>,
    /// The name of the light, which other frames may share.
    pub light: Option<String>,
}

/// Purpose of a frame.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// Opens the files of the frame.
    Train,
    /// Only its camera counts.
    Withhold,
}

/// Keys of a frame, or those beside the frames that hold for all frames without their own.
#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct Shared {
    camera_model: Option<String>,
    is_fisheye: bool,
    #[serde(deserialize_with = "number")]
    w: Option<f64>,
    #[serde(deserialize_with = "number")]
    h: Option<f64>,
    #[serde(deserialize_with = "number")]
    fl_x: Option<f64>,
    #[serde(deserialize_with = "number")]
    fl_y: Option<f64>,
    #[serde(deserialize_with = "number")]
    cx: Option<f64>,
    #[serde(deserialize_with = "number")]
    cy: Option<f64>,
    /// Fields of view, radians, where a writer gives them for focal lengths.
    #[serde(deserialize_with = "number")]
    camera_angle_x: Option<f64>,
    #[serde(deserialize_with = "number")]
    camera_angle_y: Option<f64>,
    #[serde(deserialize_with = "number")]
    k1: Option<f64>,
    #[serde(deserialize_with = "number")]
    k2: Option<f64>,
    #[serde(deserialize_with = "number")]
    k3: Option<f64>,
    #[serde(deserialize_with = "number")]
    k4: Option<f64>,
    #[serde(deserialize_with = "number")]
    p1: Option<f64>,
    #[serde(deserialize_with = "number")]
    p2: Option<f64>,
}

/// A number where there is one: null, as JSON writes NaN, is none.
fn number<'de, D: Deserializer<'de>>(value: D) -> Result<Option<f64>, D::Error> {
    f64::deserialize(value).map(Some)
}

#[derive(Deserialize)]
pub(super) struct FileFrame {
    name: Option<String>,
    pub file_path: String,
    mask_path: Option<String>,
    label_path: Option<String>,
    transform_matrix: Vec<Vec<f64>>,
    #[serde(default)]
    light: Value,
    #[serde(flatten)]
    own: Shared,
}

impl FileFrame {
    /// Whether the frame names its light.
    pub fn has_light(&self) -> bool {
        !self.light.is_null()
    }

    /// The frame whose picture has the plain path `file_path`, with what `shared` says of all.
    pub fn resolve(
        &self,
        root: &Path,
        file_path: &str,
        shared: &Shared,
        purpose: Use,
    ) -> Result<Frame, String> {
        let camera = self.camera(file_path, shared)?;
        let light = light_name(&self.light)?;
        let distortion = self.lens(shared)?;
        let image_path = inside(root, file_path)?;
        let mask_path = match &self.mask_path {
            Some(path) => inside(root, &plain(path))?,
            None => {
                let path = Path::new(file_path).with_extension("png");
                let path = root.join("masks").join(path.file_name().unwrap_or_default());
                if purpose == Use::Train && !path.is_file() {
                    return Err(
                        "has no mask_path; add a grey PNG that is 255 where the mesh is the first \
                         surface and 0 elsewhere, or put it into masks/ under the picture's name"
                            .to_owned(),
                    );
                }
                path
            }
        };
        if purpose == Use::Train
            && let Some(kind) = developed(&image_path)
        {
            let exr = image_path.with_extension("exr");
            let fix = match exr.is_file().then(|| exr.file_name()).flatten() {
                Some(name) => format!("name {} beside it", name.display()),
                None => "bring the folder in with `unshade import transforms`, or develop the raw \
                         files to linear Rec.709 without a tone curve, write them as EXR and name \
                         those"
                    .to_owned(),
            };
            return Err(format!("is a {kind}, but pictures are linear float EXR files; {fix}"));
        }
        let label_path = self.label_path.as_ref().map(|path| inside(root, &plain(path)));
        let label_path = label_path.transpose()?;
        Ok(Frame { camera, distortion, image_path, mask_path, label_path, light })
    }

    fn camera(&self, file_path: &str, shared: &Shared) -> Result<Camera, String> {
        let stem = || Path::new(file_path).file_stem().map(|stem| stem.to_string_lossy().into());
        let name: String = self.name.clone().or_else(stem).unwrap_or_default();
        if name.is_empty() || name.starts_with('.') || name.contains(['/', '\\']) {
            return Err(format!("name {name:?} cannot be a file name; rename the frame"));
        }
        let of = |field: fn(&Shared) -> Option<f64>| field(&self.own).or(field(shared));
        let side = |name: &str, value: Option<f64>| {
            let value = value.ok_or_else(|| {
                format!("has no {name}; state w and h, the picture's size in pixels")
            })?;
            if !(0.0..=LARGEST).contains(&value) || value.fract() != 0.0 {
                return Err(format!("{name} is {value}; it must be a whole number of pixels"));
            }
            Ok(value)
        };
        let (w, h) = (side("w", of(|s| s.w))?, side("h", of(|s| s.h))?);
        if w == 0.0 || h == 0.0 {
            return Err(format!("size {w}x{h} is empty; fix w, h"));
        }
        let by_angle =
            |side: f64, angle: Option<f64>| angle.map(|angle| side / 2.0 / (angle / 2.0).tan());
        // A focal length of the frame's own outdoes an angle for all.
        let focal = |s: &Shared| {
            let along = s.fl_x.or(by_angle(w, s.camera_angle_x));
            let across = s.fl_y.or(by_angle(h, s.camera_angle_y));
            Some((along.or(across)?, across.or(along)?))
        };
        let (fl_x, fl_y) = focal(&self.own).or_else(|| focal(shared)).ok_or_else(|| {
            "has no fl_x; state fl_x and fl_y, the focal length in pixels".to_owned()
        })?;
        let (cx, cy) = (of(|s| s.cx).unwrap_or(w / 2.0), of(|s| s.cy).unwrap_or(h / 2.0));
        let lens = [fl_x, fl_y, cx, cy].map(|value| value as f32);
        if !lens.iter().all(|value| value.is_finite()) || lens[0] <= 0.0 || lens[1] <= 0.0 {
            return Err("fl_x and fl_y must be positive, cx and cy finite; fix them".to_owned());
        }
        let matrix = matrix(&self.transform_matrix)
            .map_err(|reason| format!("transform_matrix {reason}"))?;
        let rotation = Mat3::from_mat4(matrix);
        let deviation = rotation.transpose() * rotation - Mat3::IDENTITY;
        let orthonormal = deviation.to_cols_array().iter().all(|e| e.abs() < RIGID_TOLERANCE);
        if !(matrix.is_finite() && orthonormal && rotation.determinant() > 0.0) {
            return Err("transform_matrix is not rigid; it must be a rotation and a translation, \
                        camera to world"
                .to_owned());
        }
        Ok(Camera {
            name,
            width: w as usize,
            height: h as usize,
            focal: [lens[0], lens[1]],
            centre: [lens[2], lens[3]],
            camera_to_world: matrix,
        })
    }

    fn lens(&self, shared: &Shared) -> Result<Option<Distortion>, String> {
        let of = |field: fn(&Shared) -> Option<f64>| field(&self.own).or(field(shared));
        let term = |field: fn(&Shared) -> Option<f64>| of(field).unwrap_or(0.0);
        let lens = Distortion {
            k1: term(|s| s.k1),
            k2: term(|s| s.k2),
            p1: term(|s| s.p1),
            p2: term(|s| s.p2),
        };
        let higher = term(|s| s.k3) != 0.0 || term(|s| s.k4) != 0.0;
        let any = higher || [lens.k1, lens.k2, lens.p1, lens.p2].iter().any(|term| *term != 0.0);
        let model = self.own.camera_model.as_deref().or(shared.camera_model.as_deref());
        let fisheye = self.own.is_fisheye || shared.is_fisheye;
        match model {
            _ if fisheye => Err("is_fisheye is true; undistort to PINHOLE first".to_owned()),
            Some("PINHOLE" | "SIMPLE_PINHOLE") if any => {
                Err("has lens distortion, but camera_model is PINHOLE; state OPENCV, or drop k1 \
                     to p2"
                    .to_owned())
            }
            None | Some("PINHOLE" | "SIMPLE_PINHOLE" | "OPENCV") if higher => {
                Err("k3 and k4 are not supported; undistort to PINHOLE first".to_owned())
            }
            None | Some("PINHOLE" | "SIMPLE_PINHOLE" | "OPENCV") => Ok(any.then_some(lens)),
            Some(model) => Err(format!(
                "camera_model is {model:?}; undistort to PINHOLE first, or state OPENCV with k1, \
                 k2, p1, p2"
            )),
        }
    }
}

/// Kind of a file that holds no radiance, by its ending; nothing for others.
fn developed(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    let known = [("jpg", "JPEG"), ("jpeg", "JPEG"), ("png", "PNG"), ("tif", "TIFF")];
    let known = known.into_iter().chain([("tiff", "TIFF"), ("webp", "WebP"), ("heic", "HEIC")]);
    known.into_iter().find(|(key, _)| *key == ending).map(|(_, kind)| kind)
}

/// A matrix of three or four rows of four numbers, the last 0, 0, 0, 1.
pub(super) fn matrix(rows: &[Vec<f64>]) -> Result<Mat4, String> {
    let mut entries = [[0.0, 0.0, 0.0, 1.0]; 4];
    let shaped = matches!(rows.len(), 3 | 4) && rows.iter().all(|row| row.len() == 4);
    if !shaped {
        return Err("has another shape than 4 x 4; write four rows of four numbers".to_owned());
    }
    for (entries, row) in entries.iter_mut().zip(rows) {
        for (entry, value) in entries.iter_mut().zip(row) {
            *entry = *value as f32;
        }
    }
    if entries[3] != [0.0, 0.0, 0.0, 1.0] {
        return Err("is not rigid; its last row must be 0, 0, 0, 1".to_owned());
    }
    Ok(Mat4::from_cols_array_2d(&entries).transpose())
}
