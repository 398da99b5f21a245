//! Float pictures and label images: EXR with channels found by name, 8-bit grey PNG.
//!
//! Row 0 is the top row; values are linear. Every reader checks what it hands out:
//! a NaN or an infinity is reported with its place.

use std::path::{Path, PathBuf};

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, Layer,
    LayerAttributes, LineOrder, ReadChannels, ReadLayers, SmallVec, WritableImage, f16, read,
};

use crate::atomic;

/// What can be wrong with a picture file.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The file cannot be read or is not of its kind.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        reason: String,
    },
    /// The file cannot be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
        reason: String,
    },
    /// A named channel is absent.
    #[error("{path}: has no channel {channel:?}; it has {present}")]
    MissingChannel {
        /// The file.
        path: PathBuf,
        /// The channel asked for.
        channel: String,
        /// The channels there are, comma separated.
        present: String,
    },
    /// A value is NaN or infinite.
    #[error("{path}: {value} at column {x}, row {y}, channel {channel}; mend or mask the pixel")]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// NaN, inf or -inf.
        value: f32,
        /// Column from the left.
        x: usize,
        /// Row from the top.
        y: usize,
        /// Channel name.
        channel: String,
    },
}

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

fn read_error(path: &Path, reason: impl ToString) -> PictureError {
    PictureError::Read { path: path.to_path_buf(), reason: reason.to_string() }
}

fn write_error(path: &Path, reason: impl ToString) -> PictureError {
    PictureError::Write { path: path.to_path_buf(), reason: reason.to_string() }
}

fn read_layer(path: &Path) -> Result<Layer<AnyChannels<FlatSamples>>, PictureError> {
    read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map(|image| image.layer_data)
        .map_err(|error| read_error(path, error))
}

/// The channel names of an EXR file, in the file's (alphabetical) order.
pub fn exr_channel_names(path: &Path) -> Result<Vec<String>, PictureError> {
    Ok(read_layer(path)?.channel_data.list.iter().map(|c| c.name.to_string()).collect())
}

/// Reads the channels `names`, in that order, as 32-bit floats.
pub fn read_exr(path: &Path, names: &[&str]) -> Result<Picture, PictureError> {
    let picture = read_exr_unchecked(path, names)?;
    match picture.data.iter().position(|value| !value.is_finite()) {
        None => Ok(picture),
        Some(index) => {
            let (pixel, slot) = (index / picture.channels, index % picture.channels);
            Err(PictureError::NotFinite {
                path: path.to_path_buf(),
                value: picture.data[index],
                x: pixel % picture.width,
                y: pixel / picture.width,
                channel: names[slot].to_owned(),
            })
        }
    }
}

/// As [`read_exr`], for those who look for faults: NaN and infinities are handed out.
pub fn read_exr_unchecked(path: &Path, names: &[&str]) -> Result<Picture, PictureError> {
    let layer = read_layer(path)?;
    let (width, height) = (layer.size.0, layer.size.1);
    let mut picture = Picture::new(width, height, names.len());
    for (slot, name) in names.iter().enumerate() {
        let channel =
            layer.channel_data.list.iter().find(|c| c.name.eq(name)).ok_or_else(|| {
                let present: Vec<_> =
                    layer.channel_data.list.iter().map(|c| c.name.to_string()).collect();
                PictureError::MissingChannel {
                    path: path.to_path_buf(),
                    channel: (*name).to_owned(),
                    present: present.join(", "),
                }
            })?;
        for (index, value) in channel.sample_data.values_as_f32().enumerate() {
            picture.data[index * names.len() + slot] = value;
        }
    }
    Ok(picture)
}

/// Reads the channels R, G and B.
pub fn read_exr_rgb(path: &Path) -> Result<Picture, PictureError> {
    read_exr(path, &["R", "G", "B"])
}

/// Writes 32-bit float channels named `names`; the same picture gives the same bytes.
pub fn write_exr(path: &Path, picture: &Picture, names: &[&str]) -> Result<(), PictureError> {
    write_channels(path, picture, names, FlatSamples::F32)
}

/// Writes 16-bit float channels, for pictures that are looked at; what they cannot hold is clamped.
pub fn write_exr_half(path: &Path, picture: &Picture, names: &[&str]) -> Result<(), PictureError> {
    let largest = f16::MAX.to_f32();
    let half = |value: f32| f16::from_f32(value.clamp(-largest, largest));
    write_channels(path, picture, names, |values| {
        FlatSamples::F16(values.into_iter().map(half).collect())
    })
}

fn write_channels(
    path: &Path,
    picture: &Picture,
    names: &[&str],
    samples: impl Fn(Vec<f32>) -> FlatSamples,
) -> Result<(), PictureError> {
    if names.len() != picture.channels {
        return Err(write_error(
            path,
            format!("{} channel names for {} channels", names.len(), picture.channels),
        ));
    }
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = names
        .iter()
        .enumerate()
        .map(|(slot, name)| {
            let values = picture.data.iter().skip(slot).step_by(picture.channels.max(1));
            AnyChannel::new(*name, samples(values.copied().collect()))
        })
        .collect();
    let layer = Layer::new(
        (picture.width, picture.height),
        LayerAttributes::default(),
        Encoding {
            compression: Compression::ZIP16,
            blocks: Blocks::ScanLines,
            line_order: LineOrder::Increasing,
        },
        AnyChannels::sort(list),
    );
    let partial = atomic::partial_path(path);
    ExrImage::from_layer(layer)
        .write()
        .to_file(&partial)
        .map_err(|error| write_error(path, error))?;
    std::fs::rename(&partial, path).map_err(|error| write_error(path, error))
}

/// Writes the channels R, G and B.
pub fn write_exr_rgb(path: &Path, picture: &Picture) -> Result<(), PictureError> {
    write_exr(path, picture, &["R", "G", "B"])
}

/// Reads an 8-bit grey PNG; a PNG of another kind is refused, since labels must not be converted.
pub fn read_png_gray(path: &Path) -> Result<GrayImage, PictureError> {
    let bytes = std::fs::read(path).map_err(|error| read_error(path, error))?;
    match image::load_from_memory_with_format(&bytes, image::ImageFormat::Png) {
        Ok(image::DynamicImage::ImageLuma8(gray)) => Ok(GrayImage {
            width: gray.width() as usize,
            height: gray.height() as usize,
            data: gray.into_raw(),
        }),
        Ok(other) => Err(read_error(
            path,
            format!("expected 8-bit grey, found {:?}; save it as 8-bit grey PNG", other.color()),
        )),
        Err(error) => Err(read_error(path, error)),
    }
}

/// Writes an 8-bit grey PNG.
pub fn write_png_gray(path: &Path, gray: &GrayImage) -> Result<(), PictureError> {
    write_png(path, &gray.data, gray.width, gray.height, image::ExtendedColorType::L8)
}

/// Writes an 8-bit sRGB PNG from interleaved bytes.
pub fn write_png_rgb(
    path: &Path,
    bytes: &[u8],
    width: usize,
    height: usize,
) -> Result<(), PictureError> {
    write_png(path, bytes, width, height, image::ExtendedColorType::Rgb8)
}

fn write_png(
    path: &Path,
    bytes: &[u8],
    width: usize,
    height: usize,
    kind: image::ExtendedColorType,
) -> Result<(), PictureError> {
    use image::ImageEncoder;
    let mut encoded = Vec::new();
    image::codecs::png::PngEncoder::new(&mut encoded)
        .write_image(bytes, width as u32, height as u32, kind)
        .map_err(|error| write_error(path, error))?;
    atomic::write_file(path, &encoded).map_err(|error| write_error(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Picture {
        let mut picture = Picture::new(5, 3, 3);
        for (index, value) in picture.data.iter_mut().enumerate() {
            *value = index as f32 * 0.25 - 1.0;
        }
        picture
    }

    #[test]
    fn channels_come_back_by_name_whatever_the_order_in_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("layers.exr");
        write_exr(&path, &gradient(), &["specular.R", "diffuse.R", "B"]).unwrap();
        let back = read_exr(&path, &["specular.R", "diffuse.R", "B"]).unwrap();
        assert_eq!(back, gradient());
        let error = read_exr(&path, &["G"]).unwrap_err().to_string();
        assert!(error.contains("\"G\"") && error.contains("diffuse.R"), "{error}");
    }

    #[test]
    fn halves_come_back_within_their_precision_and_stay_finite() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("half.exr");
        let mut picture = gradient();
        picture.data[0] = 1e9;
        picture.data[1] = 0.1;
        write_exr_half(&path, &picture, &["R", "G", "B"]).unwrap();
        let back = read_exr_rgb(&path).unwrap();
        assert_eq!(back.data[0], 65504.0);
        for (value, half) in picture.data[1..].iter().zip(&back.data[1..]) {
            assert!((value - half).abs() <= 1e-3 * value.abs(), "{value} {half}");
        }
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a.exr"), folder.path().join("b.exr"));
        write_exr_rgb(&a, &gradient()).unwrap();
        write_exr_rgb(&b, &gradient()).unwrap();
        assert_eq!(std::fs::read(a).unwrap(), std::fs::read(b).unwrap());
    }

    #[test]
    fn a_nan_is_reported_with_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nan.exr");
        let mut picture = gradient();
        picture.pixel_mut(3, 2)[1] = f32::NAN;
        write_exr_rgb(&path, &picture).unwrap();
        let error = read_exr_rgb(&path).unwrap_err().to_string();
        assert!(error.contains("column 3, row 2, channel G"), "{error}");
    }
}
