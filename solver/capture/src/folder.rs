//! A capture folder: opened and checked here, once, for everyone.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

use crate::camera::Camera;
use crate::error::CaptureError;
use crate::first_look;
use crate::frame_lights::FrameLights;
use crate::mesh::Mesh;
use crate::orientation::{self, Flipped};
use crate::transforms::Transforms;
use crate::truth::{Truth, TruthPart};
use crate::uv_layout::{self, Layout, LayoutFault, Parts};
use crate::view::View;

const TRANSFORMS: &str = "transforms.json";

/// Everything a solver may see: the mesh, the training views, and where the withheld cameras stand.
///
/// Pictures of withheld frames are never opened, the folder `truth` only by [`Capture::with_truth`].
#[derive(Clone, Debug)]
pub struct Capture {
    /// Path of the folder.
    pub folder: PathBuf,
    /// Positions in metres, and the UV chart that is the maps' layout.
    pub mesh: Mesh,
    /// The training views, in the order of `train_filenames`.
    pub train: Vec<View>,
    /// The withheld cameras, in the order of `test_filenames`; pinholes like all others, since
    /// lenses are taken out of the pictures when they are opened.
    pub withheld: Vec<Camera>,
    /// Names of the label pictures' ids, as far as the file has them.
    pub label_names: BTreeMap<u8, String>,
    /// The light of every frame, training views first, then withheld cameras.
    pub lights: FrameLights,
    /// Whether exposure and white balance differ between the frames by unknown factors.
    pub has_unknown_exposure: bool,
    /// The parts of the truth that a privileged solve holds fixed; none unless [`Capture::with_truth`] read them.
    pub truth: Truth,
    hash: String,
}

impl Capture {
    /// Opens and checks a capture folder (`transforms.json`, the mesh, pictures, masks, labels),
    /// and that its mesh is where its cameras look.
    pub fn open(folder: &Path) -> Result<Self, CaptureError> {
        Self::opened(folder, true)
    }

    /// Opens a folder again that has been solved: as [`Capture::open`], without the look at how
    /// mesh and cameras fit.
    pub fn reopen(folder: &Path) -> Result<Self, CaptureError> {
        Self::opened(folder, false)
    }

    /// The cameras of the content of `transforms.json` for the capture in `folder`, those of
    /// training views first; no picture is opened.
    pub fn cameras(folder: &Path, bytes: &[u8]) -> Result<Vec<Camera>, CaptureError> {
        let transforms = parsed(folder, bytes)?;
        let frames = transforms.train.into_iter().chain(transforms.withheld);
        Ok(frames.map(|frame| frame.camera).collect())
    }

    fn opened(folder: &Path, look: bool) -> Result<Self, CaptureError> {
        let bytes = read(&folder.join(TRANSFORMS))?;
        let transforms = parsed(folder, &bytes)?;
        let open = |frame| View::open(frame);
        let (mesh, train) = rayon::join(
            || Mesh::open_with_parts(&transforms.mesh_path),
            || transforms.train.par_iter().map(open).collect::<Result<Vec<_>, _>>(),
        );
        let ((mut mesh, parts), train) = (mesh?, train?);
        if look {
            check_layout(&transforms.mesh_path, &mesh, &parts)?;
            first_look::check(folder, &mesh, &train, transforms.applied)?;
        }
        let eyes: Vec<Vec3> = train.iter().map(|view| view.camera.position()).collect();
        let flipped = orientation::orient(&mut mesh, &eyes);
        if flipped != Default::default() {
            let (shown, Flipped { normals, triangles }) = (transforms.mesh_path.display(), flipped);
            tracing::warn!(
                "{shown}: flipped {normals} normals and {triangles} triangles towards the cameras"
            );
        }
        for (view, frame) in train.iter().zip(&transforms.train) {
            if !view.has_foreground() {
                let shown = frame.mask_path.display();
                tracing::warn!("{shown}: has no foreground (255), so the view adds nothing");
            }
        }
        if train.iter().any(View::has_foreground) && train.iter().all(View::is_black) {
            return Err(CaptureError::Black(folder.to_path_buf()));
        }
        let mut hasher = blake3::Hasher::new();
        hasher.update(&bytes).update(&read(&transforms.mesh_path)?);
        for frame in &transforms.train {
            let paths =
                [Some(&frame.image_path), Some(&frame.mask_path), frame.label_path.as_ref()];
            for path in paths.into_iter().flatten() {
                hasher.update(&read(path)?);
            }
        }
        Ok(Self {
            folder: folder.to_path_buf(),
            mesh,
            train,
            withheld: transforms.withheld.into_iter().map(|frame| frame.camera).collect(),
            label_names: transforms.label_names,
            lights: transforms.lights,
            has_unknown_exposure: transforms.has_unknown_exposure,
            truth: Truth::default(),
            hash: hasher.finalize().to_hex().to_string(),
        })
    }

    /// BLAKE3 of the inputs a solver sees, hexadecimal: `transforms.json`, the mesh, and the
    /// training views' pictures, masks and labels, as they were when the folder was opened.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Reads these parts of the truth, for a solve that holds them fixed. The [hash](Capture::hash) changes, so that no
    /// result of such a solve passes for one without.
    pub fn with_truth(mut self, parts: &[TruthPart]) -> Result<Self, CaptureError> {
        let truth =
            Truth::read(&self.folder.join("truth"), &self.train, &self.lights.names, parts)?;
        if !truth.parts.is_empty() {
            let mut hasher = blake3::Hasher::new();
            hasher.update(self.hash.as_bytes());
            for part in &truth.parts {
                hasher.update(part.to_string().as_bytes());
            }
            self.hash = hasher.finalize().to_hex().to_string();
        }
        self.truth = truth;
        Ok(self)
    }

    /// The ids of the labels with one of these names.
    pub fn labels_named(&self, names: &[String]) -> Vec<u8> {
        let named = self.label_names.iter().filter(|(_, name)| names.contains(name));
        named.map(|(id, _)| *id).collect()
    }

    /// The camera of a training or withheld frame.
    pub fn camera(&self, name: &str) -> Option<&Camera> {
        let train = self.train.iter().map(|view| &view.camera);
        train.chain(&self.withheld).find(|camera| camera.name == name)
    }
}

/// Refuses a capture's mesh whose texels stand for several places, and warns of many seams.
fn check_layout(path: &Path, mesh: &Mesh, parts: &Parts) -> Result<(), CaptureError> {
    let positions: Vec<DVec3> = mesh.positions.iter().map(|p| p.as_dvec3()).collect();
    let uvs: Vec<DVec2> = mesh.uvs.iter().map(|uv| uv.as_dvec2()).collect();
    let layout = Layout { positions: &positions, uvs: &uvs, triangles: &mesh.triangles, parts };
    match uv_layout::examine(&layout) {
        Ok(islands) => {
            if let Some(warning) = uv_layout::islands_warning(islands) {
                tracing::warn!("{}: {warning}", path.display());
            }
            Ok(())
        }
        // A surface without texels is not solved, which harms the rest of it little.
        Err(fault @ LayoutFault::Collapsed { .. }) => {
            tracing::warn!("{}: {fault}", path.display());
            Ok(())
        }
        Err(fault) => {
            Err(CaptureError::Mesh { path: path.to_path_buf(), reason: fault.to_string() })
        }
    }
}

fn parsed(folder: &Path, bytes: &[u8]) -> Result<Transforms, CaptureError> {
    Transforms::parse(folder, bytes).map_err(|reason| {
        // A name may hold a line's end; a message is one line.
        let reason = reason.replace(char::is_control, " ");
        CaptureError::Transforms { path: folder.join(TRANSFORMS), reason }
    })
}

fn read(path: &Path) -> Result<Vec<u8>, CaptureError> {
    std::fs::read(path)
        .map_err(|error| CaptureError::Read { path: path.to_path_buf(), reason: error.to_string() })
}
