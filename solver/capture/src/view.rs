//! A training view: a camera with its picture, mask and labels.

use std::cmp::Reverse;
use std::path::Path;

use formats::picture::{self, Content, GrayImage, Picture};

use super::camera::Camera;
use super::error::CaptureError;
use super::frame::Frame;
use super::lens::Layers;

/// A training view.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// A pinhole of the pictures' size.
    pub camera: Camera,
    /// Linear radiance, three channels, finite.
    pub image: Picture,
    /// 255 where the mesh is the first surface, else 0.
    pub mask: GrayImage,
    /// Region ids, 0 = none.
    pub labels: Option<GrayImage>,
}

impl View {
    pub(super) fn open(frame: &Frame) -> Result<Self, CaptureError> {
        let Frame { camera, distortion, image_path, mask_path, label_path, .. } = frame;
        let check = |path: &Path, width: usize, height: usize| {
            if (width, height) == (camera.width, camera.height) {
                return Ok(());
            }
            let (w, h) = (camera.width, camera.height);
            let reason =
                format!("is {width}x{height}, but its camera says {w}x{h}; resize it or fix w, h");
            Err(CaptureError::Frame { path: path.to_path_buf(), reason })
        };
        let gray = |path: &Path| {
            let gray = picture::read_png_gray(path)?;
            check(path, gray.width, gray.height).map(|()| gray)
        };
        let channels = ["R", "G", "B"];
        let mut image = picture::read_exr_unchecked(image_path, &channels, Content::Colour)?;
        check(image_path, image.width, image.height)?;
        let mut mask = gray(mask_path)?;
        // Masks that were resized elsewhere have soft edges.
        for value in &mut mask.data {
            *value = if *value >= 128 { 255 } else { 0 };
        }
        // What lies outside the mask is no one's radiance.
        image.blacken_not_finite(|pixel| mask.data[pixel] == 0);
        image.require_finite(image_path, &channels)?;
        let labels = label_path.as_deref().map(gray).transpose()?;
        let taken = Layers { image, mask, labels };
        let Layers { image, mask, labels } = match distortion {
            Some(lens) => lens.undistort(camera, &taken),
            None => taken,
        };
        Ok(Self { camera: camera.clone(), image, mask, labels })
    }

    /// The label of a pixel; 0 for none.
    pub fn label(&self, pixel: usize) -> u8 {
        self.labels.as_ref().map_or(0, |labels| labels.data[pixel])
    }

    /// Returns whether any pixel shows the mesh.
    pub(super) fn has_foreground(&self) -> bool {
        self.mask.data.contains(&255)
    }

    /// Returns whether no pixel that shows the mesh has any light.
    pub(super) fn is_black(&self) -> bool {
        let pixels = self.image.data.chunks_exact(self.image.channels).zip(&self.mask.data);
        pixels.filter(|(_, mask)| **mask == 255).all(|(rgb, _)| rgb.iter().all(|v| *v <= 0.0))
    }

    /// The view at half resolution: the picture is averaged over 2 by 2 pixels, a pixel is valid
    /// only if all four are, a label is the most frequent of the four (the smaller id in a tie).
    /// An odd last row or column is dropped.
    pub fn half(&self) -> Self {
        let camera = self.camera.half();
        let (width, height, full) = (camera.width, camera.height, self.camera.width);
        let four = |index: usize| {
            let corner = index / width * 2 * full + index % width * 2;
            [corner, corner + 1, corner + full, corner + full + 1]
        };
        let channels = self.image.channels;
        let mut image = Picture::new(width, height, channels);
        for (index, value) in image.data.iter_mut().enumerate() {
            let sum =
                |sum: f32, pixel: usize| sum + self.image.data[pixel * channels + index % channels];
            *value = four(index / channels).into_iter().fold(0.0, sum) / 4.0;
        }
        let mut mask = GrayImage::new(width, height);
        for (index, value) in mask.data.iter_mut().enumerate() {
            let valid = four(index).iter().all(|pixel| self.mask.data[*pixel] == 255);
            *value = if valid { 255 } else { 0 };
        }
        let labels = self.labels.as_ref().map(|labels| {
            let data =
                (0..width * height).map(|index| majority(four(index).map(|p| labels.data[p])));
            GrayImage { width, height, data: data.collect() }
        });
        Self { camera, image, mask, labels }
    }
}

/// The most frequent id; the smaller one in a tie.
fn majority(ids: [u8; 4]) -> u8 {
    let count = |id: u8| ids.iter().filter(|other| **other == id).count();
    ids.into_iter().max_by_key(|id| (count(*id), Reverse(*id))).unwrap_or(0)
}
