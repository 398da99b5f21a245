//! `transforms.json`: cameras and file names, nerfstudio style.

use std::collections::{BTreeMap, HashSet};
use std::path::{Component, Path, PathBuf};

use glam::{Mat3, Mat4};
use serde::Deserialize;

use super::Camera;
use super::lens::Distortion;

/// How far `transform_matrix` may be from a rotation, per entry of RᵀR - 1: single precision and
/// six printed digits pass, a scale or a shear does not.
const RIGID_TOLERANCE: f32 = 1e-3;

/// One frame: a camera and its files, not opened.
pub(super) struct Frame {
    /// The camera once its lens is taken out.
    pub camera: Camera,
    /// The lens; `None` for a pinhole.
    pub distortion: Option<Distortion>,
    pub image_path: PathBuf,
    pub mask_path: PathBuf,
    pub label_path: Option<PathBuf>,
}

/// What `transforms.json` says.
pub(super) struct Transforms {
    pub mesh_path: PathBuf,
    pub train: Vec<Frame>,
    pub withheld: Vec<Frame>,
    pub label_names: BTreeMap<u8, String>,
}

#[derive(Deserialize)]
struct File {
    camera_model: String,
    mesh: PathBuf,
    frames: Vec<FileFrame>,
    train_filenames: Vec<PathBuf>,
    #[serde(default)]
    test_filenames: Vec<PathBuf>,
    #[serde(default)]
    label_names: BTreeMap<u8, String>,
    #[serde(flatten)]
    lens: LensTerms,
}

/// Terms of the lens as nerfstudio writes them; those that are absent are zero.
#[derive(Default, Deserialize)]
#[serde(default)]
struct LensTerms {
    k1: f64,
    k2: f64,
    k3: f64,
    k4: f64,
    p1: f64,
    p2: f64,
}

#[derive(Deserialize)]
struct FileFrame {
    name: Option<String>,
    file_path: PathBuf,
    mask_path: PathBuf,
    label_path: Option<PathBuf>,
    w: usize,
    h: usize,
    fl_x: f32,
    fl_y: f32,
    cx: f32,
    cy: f32,
    #[serde(flatten)]
    lens: LensTerms,
    transform_matrix: [[f32; 4]; 4],
}

impl Transforms {
    /// Parses the content of the file in the capture folder `root`; the error is the reason alone.
    pub fn parse(root: &Path, bytes: &[u8]) -> Result<Self, String> {
        let file: File = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        let distorted = match file.camera_model.as_str() {
            "PINHOLE" => false,
            "OPENCV" => true,
            model => {
                return Err(format!(
                    "camera model {model:?}; undistort to PINHOLE first, or state OPENCV with k1, \
                     k2, p1, p2"
                ));
            }
        };
        if file.lens.any() {
            return Err("k1 to p2 stand beside the frames; write them into every frame".to_owned());
        }
        if file.train_filenames.is_empty() {
            return Err("train_filenames is empty; name at least one picture".to_owned());
        }
        let mut names = HashSet::new();
        let mut pick = |list: &str, paths: &[PathBuf]| -> Result<Vec<Frame>, String> {
            let frame = |path: &PathBuf| {
                let shown = path.display();
                let found = file.frames.iter().find(|frame| frame.file_path == *path);
                let found = found.ok_or_else(|| {
                    format!("{list}: no frame has file_path {shown}; add it or drop the name")
                })?;
                let frame = found
                    .resolve(root, distorted)
                    .map_err(|reason| format!("frame {shown}: {reason}"))?;
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
        let train = pick("train_filenames", &file.train_filenames)?;
        let withheld = pick("test_filenames", &file.test_filenames)?;
        let mesh_path = inside(root, &file.mesh).map_err(|reason| format!("mesh: {reason}"))?;
        if let Some(name) = file.label_names.get(&0) {
            return Err(format!("label_names: 0 is no label, but has the name {name:?}; drop it"));
        }
        Ok(Self { mesh_path, train, withheld, label_names: file.label_names })
    }
}

impl FileFrame {
    fn resolve(&self, root: &Path, distorted: bool) -> Result<Frame, String> {
        if self.lens.any() && !distorted {
            return Err("has lens distortion, but camera_model is PINHOLE; state OPENCV, or drop \
                        k1 to p2"
                .to_owned());
        }
        Ok(Frame {
            camera: self.camera()?,
            distortion: self.lens.distortion()?,
            image_path: inside(root, &self.file_path)?,
            mask_path: inside(root, &self.mask_path)?,
            label_path: self.label_path.as_ref().map(|path| inside(root, path)).transpose()?,
        })
    }

    fn camera(&self) -> Result<Camera, String> {
        let stem = || self.file_path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let name = self.name.clone().or_else(stem).unwrap_or_default();
        if name.is_empty() || name.starts_with('.') || name.contains(['/', '\\']) {
            return Err(format!("name {name:?} cannot be a file name; rename the frame"));
        }
        if self.w == 0 || self.h == 0 {
            return Err(format!("size {}x{} is empty; mend w, h", self.w, self.h));
        }
        let lens = [self.fl_x, self.fl_y, self.cx, self.cy];
        if !lens.iter().all(|value| value.is_finite()) || self.fl_x <= 0.0 || self.fl_y <= 0.0 {
            return Err("fl_x and fl_y must be positive, cx and cy finite; mend them".to_owned());
        }
        let matrix = Mat4::from_cols_array_2d(&self.transform_matrix).transpose();
        let rotation = Mat3::from_mat4(matrix);
        let deviation = rotation.transpose() * rotation - Mat3::IDENTITY;
        let orthonormal = deviation.to_cols_array().iter().all(|e| e.abs() < RIGID_TOLERANCE);
        let affine = self.transform_matrix[3] == [0.0, 0.0, 0.0, 1.0];
        if !(matrix.is_finite() && orthonormal && rotation.determinant() > 0.0 && affine) {
            return Err("transform_matrix is not rigid; it must be a rotation and a translation, \
                        camera to world"
                .to_owned());
        }
        Ok(Camera {
            name,
            width: self.w,
            height: self.h,
            focal: [self.fl_x, self.fl_y],
            centre: [self.cx, self.cy],
            camera_to_world: matrix,
        })
    }
}

impl LensTerms {
    fn any(&self) -> bool {
        [self.k1, self.k2, self.k3, self.k4, self.p1, self.p2].iter().any(|term| *term != 0.0)
    }

    fn distortion(&self) -> Result<Option<Distortion>, String> {
        if self.k3 != 0.0 || self.k4 != 0.0 {
            return Err("k3 and k4 are not supported; undistort to PINHOLE first".to_owned());
        }
        let Self { k1, k2, p1, p2, .. } = *self;
        Ok(self.any().then_some(Distortion { k1, k2, p1, p2 }))
    }
}

/// `path` below `root`, refused if it leads out of it (or into the truth).
fn inside(root: &Path, path: &Path) -> Result<PathBuf, String> {
    let shown = path.display();
    let mut parts = path.components().peekable();
    if parts.peek().is_some_and(|first| first.as_os_str() == "truth") {
        return Err(format!("{shown} is part of the truth; a solver must not see it"));
    }
    if !parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(format!("{shown} leads out of the capture folder; copy the file into it"));
    }
    Ok(root.join(path))
}
