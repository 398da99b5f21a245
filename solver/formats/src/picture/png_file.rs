//! PNG files: 8-bit grey masks and labels, and pictures of 8 or 16 bits.

use std::io::Cursor;
use std::path::Path;

use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

use super::{GrayImage, Picture, PictureError, kind, limits};
use crate::cancel;

/// A PNG's samples as they are in the file: not scaled, not looked up in a palette.
pub struct Png {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples per pixel.
    pub channels: usize,
    /// Bits of a sample: 1, 2, 4, 8 or 16.
    pub bits: u8,
    /// Colour type of the samples: grey, RGB, with or without alpha.
    pub colour: ColorType,
    /// `height * width * channels` samples, row 0 on top.
    pub samples: Vec<u16>,
}

impl Png {
    /// Reads a file.
    pub fn open(path: &Path) -> Result<Self, PictureError> {
        Self::from_bytes(path, &kind::bytes_of(path)?)
    }

    /// Reads a file in memory; `path` is for messages.
    pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<Self, PictureError> {
        cancel::check();
        decode(bytes).map_err(|reason| PictureError::Read { path: path.to_path_buf(), reason })
    }

    /// Values from 0 to 1: one channel of a grey picture, else three; alpha is dropped. A palette
    /// is refused.
    pub fn picture(&self, path: &Path) -> Result<Picture, PictureError> {
        if self.colour == ColorType::Indexed {
            let reason = "has a palette; save it as RGB or grey PNG".to_owned();
            return Err(PictureError::Refused { path: path.to_path_buf(), reason });
        }
        let kept = if self.channels < 3 { 1 } else { 3 };
        let maximum = f32::from(((1u32 << self.bits) - 1) as u16);
        let pixels = self.samples.chunks_exact(self.channels);
        let data =
            pixels.flat_map(|pixel| &pixel[..kept]).map(|v| f32::from(*v) / maximum).collect();
        Ok(Picture { width: self.width, height: self.height, channels: kept, data })
    }

    /// One channel as it is: region ids, or indices of a palette.
    pub fn ids(self, path: &Path) -> Result<Self, PictureError> {
        if self.channels == 1 {
            return Ok(self);
        }
        let what = name(self.colour, self.bits);
        let reason = format!("labels are {what}; write one grey channel of region ids");
        Err(PictureError::Refused { path: path.to_path_buf(), reason })
    }
}

/// Reads an 8-bit grey PNG, or one of fewer bits with its values spread over 0 to 255; a PNG of
/// another kind is refused, since labels must not be converted.
pub fn read_png_gray(path: &Path) -> Result<GrayImage, PictureError> {
    let png = Png::open(path)?;
    if png.colour != ColorType::Grayscale || png.bits > 8 {
        let what = name(png.colour, png.bits);
        let reason = format!("expected 8-bit grey, found {what}; save it as 8-bit grey PNG");
        return Err(PictureError::Refused { path: path.to_path_buf(), reason });
    }
    let spread = 255 / ((1u16 << png.bits) - 1);
    let data = png.samples.iter().map(|value| (value * spread) as u8).collect();
    Ok(GrayImage { width: png.width, height: png.height, data })
}

fn name(colour: ColorType, bits: u8) -> String {
    let colour = match colour {
        ColorType::Grayscale => "grey",
        ColorType::GrayscaleAlpha => "grey with alpha",
        ColorType::Rgb => "RGB",
        ColorType::Rgba => "RGB with alpha",
        ColorType::Indexed => "a palette",
    };
    format!("{bits}-bit {colour}")
}

fn decode(bytes: &[u8]) -> Result<Png, String> {
    let wrong = |error: png::DecodingError| format!("{error}; save it as PNG again");
    if !bytes.starts_with(b"\x89PNG") {
        return Err("no PNG file; save it as PNG".to_owned());
    }
    // A second bound behind the check below: what the decoder takes besides the pixels.
    let limits = Limits { bytes: bytes.len() + (64 << 20) };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(wrong)?;
    let info = reader.info();
    let (width, height) = (info.width as usize, info.height as usize);
    let (colour, bits) = (info.color_type, info.bit_depth);
    let channels = colour.samples();
    limits::check(width as u64, height as u64, channels as u64, bytes.len())?;
    let size = reader.output_buffer_size().ok_or("is too large")?;
    let mut raw = vec![0; size];
    reader.next_frame(&mut raw).map_err(wrong)?;
    let samples = match bits {
        BitDepth::Sixteen => {
            raw.as_chunks::<2>().0.iter().map(|b| u16::from_be_bytes(*b)).collect()
        }
        BitDepth::Eight => raw.into_iter().map(u16::from).collect(),
        BitDepth::One | BitDepth::Two | BitDepth::Four => {
            unpacked(&raw, width * channels, height, bits as u8)
        }
    };
    Ok(Png { width, height, channels, bits: bits as u8, colour, samples })
}

/// Samples of fewer than 8 bits, whose rows begin at whole bytes.
fn unpacked(raw: &[u8], across: usize, height: usize, bits: u8) -> Vec<u16> {
    let per_byte = usize::from(8 / bits);
    let mask = (1u8 << bits) - 1;
    let rows = raw.chunks_exact(across.div_ceil(per_byte)).take(height);
    let sample = |row: &[u8], index: usize| {
        let shift = 8 - bits * (index % per_byte + 1) as u8;
        u16::from(row[index / per_byte] >> shift & mask)
    };
    rows.flat_map(|row| (0..across).map(move |index| sample(row, index))).collect()
}
