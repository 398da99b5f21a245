//! Float pictures and label images, read by one rule wherever they come from.
//!
//! Row 0 is the top row; values are linear. EXR channels are found by name and placed in the
//! display window; pictures that are colours are linear Rec.709, whatever their file states.
//! Every reader checks what it hands out: a NaN or an infinity is reported with its place, and a
//! damaged file ends in an error.

mod colour;
mod error;
mod exr_channels;
mod exr_dwa;
mod exr_file;
mod given;
mod kind;
mod light;
mod limits;
mod png_file;
mod radiance;
mod read;
#[cfg(test)]
mod tests;
mod write;

use std::path::Path;

pub use error::PictureError;
pub use exr_file::{Content, ExrFile};
pub use given::Given;
pub use light::read_light;
pub use png_file::{Png, read_png_gray};
pub use radiance::read_radiance_bytes;
pub use read::{
    exr_channel_names, read_colour, read_colour_unchecked, read_exr, read_exr_colour, read_exr_rgb,
    read_exr_unchecked,
};
pub use write::{write_exr, write_exr_half, write_exr_rgb, write_png_gray, write_png_rgb};

/// An interleaved float picture, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Values per pixel.
    pub channels: usize,
    /// `height * width * channels` values.
    pub data: Vec<f32>,
}

impl Picture {
    /// A picture of zeros.
    pub fn new(width: usize, height: usize, channels: usize) -> Self {
        Self { width, height, channels, data: vec![0.0; width * height * channels] }
    }

    /// The values of one pixel.
    pub fn pixel(&self, x: usize, y: usize) -> &[f32] {
        let start = (y * self.width + x) * self.channels;
        &self.data[start..start + self.channels]
    }

    /// Sets the pixels outside that are NaN or infinite to 0, in all their channels.
    pub fn blacken_not_finite(&mut self, outside: impl Fn(usize) -> bool) {
        for (index, pixel) in self.data.chunks_exact_mut(self.channels.max(1)).enumerate() {
            if outside(index) && !pixel.iter().all(|value| value.is_finite()) {
                pixel.fill(0.0);
            }
        }
    }

    /// Refuses NaN and infinities, with the first one's place in the file `path`; `names` are the
    /// channels'.
    pub fn require_finite(&self, path: &Path, names: &[&str]) -> Result<(), PictureError> {
        match self.data.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(index) => {
                let (pixel, channel) = (index / self.channels, index % self.channels);
                Err(PictureError::NotFinite {
                    path: path.to_path_buf(),
                    value: self.data[index],
                    x: pixel % self.width,
                    y: pixel / self.width,
                    channel: names.get(channel).map_or_else(String::new, ToString::to_string),
                })
            }
        }
    }

    /// The values of one pixel, to write.
    pub fn pixel_mut(&mut self, x: usize, y: usize) -> &mut [f32] {
        let start = (y * self.width + x) * self.channels;
        &mut self.data[start..start + self.channels]
    }
}

/// An 8-bit grey image (mask, coverage or labels), row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GrayImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `height * width` values.
    pub data: Vec<u8>,
}

impl GrayImage {
    /// An image of zeros.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, data: vec![0; width * height] }
    }
}
