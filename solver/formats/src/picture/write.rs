//! Writes EXR and PNG files: whole or not at all; the same picture gives the same bytes.

use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, Layer,
    LayerAttributes, LineOrder, SmallVec, WritableImage, f16,
};

use super::{GrayImage, Picture, PictureError};
use crate::{atomic, cancel};

fn write_error(path: &Path, reason: impl ToString) -> PictureError {
    PictureError::Write { path: path.to_path_buf(), reason: reason.to_string() }
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
    cancel::check();
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
