//! A mesh's silhouette beside a mask.

use formats::picture::GrayImage;

use crate::gbuffer::rasterise;
use crate::{Camera, Mesh};

/// Median overlap below which the cameras do not fit.
pub(super) const REFUSED: f64 = 0.6;
/// Size of a sound silhouette against its mask, or the other way round: hair and eyes may hide
/// half of the mesh, and a mask may show a neck that the mesh has not.
const HALF: f64 = 0.5;
/// Pixels along the larger side of a picture, at most.
const SIZE: usize = 256;
/// Fraction of a picture that a mask may cover and still say anything.
const MAX_FRACTION: f64 = 0.98;

/// Fraction of a picture that a mask must cover to say anything.
const MIN_FRACTION: f64 = 0.002;

/// Pixels of a small picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Comparison {
    /// Covered by the mesh, whichever side it shows.
    pub mesh: usize,
    /// Number of pixels in the mask.
    pub mask: usize,
    /// Number of pixels in both.
    pub both: usize,
    /// True if the mask is the whole picture: it then tells only that the mesh is visible.
    pub unmasked: bool,
}

impl Comparison {
    /// 0 to 1: how far the smaller one lies in the larger. Occluders take a part of the mesh away
    /// (hair, eyes), so that a mask may be much smaller than the silhouette; one that is less
    /// than half as large or more than twice as large makes the value smaller.
    pub fn overlap(&self) -> f64 {
        let (smaller, larger) = (self.mesh.min(self.mask), self.mesh.max(self.mask));
        if smaller == 0 {
            return 0.0;
        }
        if self.unmasked {
            return 1.0;
        }
        let within = self.both as f64 / smaller as f64;
        let size = smaller as f64 / larger as f64 / HALF;
        // What is hidden is no fault of the cameras': a doubt at most.
        let size = if self.mask < self.mesh { size.max(REFUSED) } else { size };
        within.min(size)
    }

    /// Intersection over union.
    pub fn union(&self) -> f64 {
        self.both as f64 / (self.mesh + self.mask - self.both).max(1) as f64
    }
}

/// Compares the mesh as `camera` sees it with a mask of the camera's size; `None` for a mask
/// of next to nothing.
pub(super) fn compare(mesh: &Mesh, camera: &Camera, mask: &GrayImage) -> Option<Comparison> {
    if !mask.data.contains(&255) {
        return None;
    }
    let (small, every) = reduced(camera, SIZE);
    let mut found = Comparison { mesh: 0, mask: 0, both: 0, unmasked: false };
    for (pixel, hit) in rasterise(mesh, &small).hits.iter().enumerate() {
        let (row, column) = (pixel / small.width, pixel % small.width);
        let row = (row * every + every / 2).min(mask.height - 1);
        let column = (column * every + every / 2).min(mask.width - 1);
        let masked = mask.data[row * mask.width + column] == 255;
        found.mesh += usize::from(hit.is_some());
        found.mask += usize::from(masked);
        found.both += usize::from(masked && hit.is_some());
    }
    let fraction = found.mask as f64 / (small.width * small.height) as f64;
    found.unmasked = fraction > MAX_FRACTION;
    (fraction > MIN_FRACTION).then_some(found)
}

/// A camera with pictures of at most `size` pixels, and how many pixels of the given camera are
/// one of them.
fn reduced(camera: &Camera, size: usize) -> (Camera, usize) {
    let every = camera.width.max(camera.height).div_ceil(size).max(1);
    let by = every as f32;
    let small = Camera {
        name: camera.name.clone(),
        width: (camera.width / every).max(1),
        height: (camera.height / every).max(1),
        focal: camera.focal.map(|value| value / by),
        centre: camera.centre.map(|value| value / by),
        camera_to_world: camera.camera_to_world,
    };
    (small, every)
}

/// The middle value; 0 of none.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
