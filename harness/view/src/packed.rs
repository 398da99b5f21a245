//! Arrays inside scripts: a page from disk may load a script, but neither fetch a file nor read the pixels of a
//! picture.
//!
//! An array is stored channel by channel as differences from what its neighbours predict (the median edge detector of
//! LOCO-I: Weinberger, Seroussi and Sapiro 2000), signs folded, the low bytes of all codes first, then the higher ones;
//! then zlib, then 15 bits per UTF-16 code unit. A script in UTF-16 with a byte order mark is read alike by all
//! browsers, and is a fifth smaller than base64.

use std::io::Write;
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use formats::picture::{GrayImage, Picture};
use half::f16;
use rayon::prelude::*;
use serde::Serialize;

use crate::error::ViewError;

/// Code unit of the fifteen bits 0: what follows up to 0xafff holds no surrogate, quote or line end.
const FIRST_UNIT: u16 = 0x3000;

/// Both codes of a vector that is zero: beyond those of directions.
const NO_VECTOR: i64 = i16::MAX as i64;

/// The type of an array's elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Element {
    /// Unsigned, 8 bits.
    U8,
    /// Unsigned, 16 bits.
    U16,
    /// Unsigned, 32 bits.
    U32,
    /// Half floats.
    Half,
    /// Signed, 16 bits: numbers in steps of one over the array's scale.
    I16,
    /// Signed, 16 bits: two numbers, from which a unit vector is folded out (Meyer et al. 2010, octahedra), in steps of
    /// one over the array's scale; zero vectors have the code [`NO_VECTOR`].
    Octahedral,
    /// Signed, 16 bits: square roots of RGB in steps of one over the array's scale, red and blue as differences from
    /// green.
    Root,
}

impl Element {
    fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 | Self::Half | Self::I16 | Self::Octahedral | Self::Root => 2,
            Self::U32 => 4,
        }
    }
}

/// An array with its codes, row by row, channels interleaved.
#[derive(PartialEq)]
pub(crate) struct Array {
    pub width: usize,
    pub height: usize,
    pub channels: usize,
    pub element: Element,
    /// Codes of signed elements are numbers times this.
    pub scale: f32,
    /// As integers of the element's type.
    pub codes: Vec<i64>,
}

/// The header of an array; the page loads its values when they are shown.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Stored {
    /// The script's name in `data/`, without its ending.
    pub name: String,
    width: usize,
    height: usize,
    channels: usize,
    element: Element,
    scale: f32,
}

impl Array {
    /// Half floats of a picture; larger values become the largest.
    pub fn half(picture: &Picture) -> Self {
        let largest = f16::MAX.to_f32();
        let code = |value: &f32| i64::from(f16::from_f32(value.clamp(-largest, largest)).to_bits());
        let Picture { width, height, channels, .. } = *picture;
        let codes = picture.data.iter().map(code).collect();
        Self { width, height, channels, element: Element::Half, scale: 1.0, codes }
    }

    /// The numbers of a picture in steps of 1/`scale`, for maps whose small values need no finer ones; None if one is
    /// too large.
    pub fn steps(picture: &Picture, scale: f32) -> Option<Self> {
        if !picture.data.iter().all(|value| (value * scale).abs() < f32::from(i16::MAX)) {
            return None;
        }
        let code = |value: &f32| i64::from((value * scale).round() as i16);
        let Picture { width, height, channels, .. } = *picture;
        let codes = picture.data.iter().map(code).collect();
        Some(Self { width, height, channels, element: Element::I16, scale, codes })
    }

    /// Directions in steps of 1/`scale`; None if a vector is neither zero nor of unit length to a hundredth.
    pub fn octahedral(picture: &Picture, scale: f32) -> Option<Self> {
        let Picture { width, height, .. } = *picture;
        let mut codes = Vec::with_capacity(2 * width * height);
        for vector in picture.data.chunks_exact(3) {
            let (x, y, z) = (vector[0], vector[1], vector[2]);
            let length = (x * x + y * y + z * z).sqrt();
            if length == 0.0 {
                codes.extend([NO_VECTOR; 2]);
                continue;
            }
            // False for what is not a number, too.
            let is_unit = (length - 1.0).abs() < 0.01;
            if !is_unit {
                return None;
            }
            let sum = x.abs() + y.abs() + z.abs();
            let (x, y) = (x / sum, y / sum);
            let folded = |a: f32, b: f32| (1.0 - b.abs()).copysign(a);
            let (x, y) = if z < 0.0 { (folded(x, y), folded(y, x)) } else { (x, y) };
            codes.extend([x, y].map(|value| (value * scale).round() as i64));
        }
        Some(Self { width, height, channels: 2, element: Element::Octahedral, scale, codes })
    }

    /// Colours whose square roots have steps of 1/`scale`; None if one is negative or too large.
    pub fn root(picture: &Picture, scale: f32) -> Option<Self> {
        let Picture { width, height, channels, .. } = *picture;
        let largest = (f32::from(i16::MAX) / 2.0 / scale).powi(2);
        if channels != 3 || !picture.data.iter().all(|value| (0.0..largest).contains(value)) {
            return None;
        }
        let mut codes: Vec<i64> =
            picture.data.iter().map(|value| (value.sqrt() * scale).round() as i64).collect();
        for rgb in codes.chunks_exact_mut(3) {
            rgb[0] -= rgb[1];
            rgb[2] -= rgb[1];
        }
        Some(Self { width, height, channels, element: Element::Root, scale, codes })
    }

    /// The bytes of a grey image.
    pub fn gray(image: &GrayImage) -> Self {
        let codes = image.data.iter().map(|value| i64::from(*value)).collect();
        let GrayImage { width, height, .. } = *image;
        Self { width, height, channels: 1, element: Element::U8, scale: 1.0, codes }
    }

    /// One row of `channels` codes for each of the `codes.len() / channels` elements of a list.
    pub fn list(element: Element, channels: usize, codes: Vec<u32>) -> Self {
        let width = codes.len() / channels;
        let codes = codes.into_iter().map(i64::from).collect();
        Self { width, height: 1, channels, element, scale: 1.0, codes }
    }

    /// Writes the script `data/<name>.js` of the page in `folder`.
    pub fn write(&self, folder: &Path, name: &str) -> Result<Stored, ViewError> {
        let path = folder.join("data").join(format!("{name}.js"));
        let failed = |error| ViewError::write(&path, error);
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&self.planes()).map_err(failed)?;
        let packed = encoder.finish().map_err(failed)?;
        let head = format!("unshadeView.arrive(\"{name}\",{},\"", packed.len());
        let units = std::iter::once(0xfeff).chain(head.encode_utf16());
        let units = units.chain(fifteen_bits(&packed)).chain("\");\n".encode_utf16());
        let bytes: Vec<u8> = units.flat_map(u16::to_le_bytes).collect();
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(failed)?;
        }
        std::fs::write(&path, bytes).map_err(failed)?;
        let Self { width, height, channels, element, scale, .. } = *self;
        Ok(Stored { name: name.to_owned(), width, height, channels, element, scale })
    }

    fn planes(&self) -> Vec<u8> {
        let (bytes, unused) = (self.element.bytes(), 64 - 8 * self.element.bytes());
        let of_channel = |channel: usize| {
            let at =
                |x: usize, y: usize| self.codes[(y * self.width + x) * self.channels + channel];
            let difference = |i: usize| {
                let (x, y) = (i % self.width, i / self.width);
                let (left, up) = (x.checked_sub(1), y.checked_sub(1));
                let corner = left.zip(up).map_or(0, |(left, up)| at(left, up));
                let (left, up) = (left.map_or(0, |x| at(x, y)), up.map_or(0, |y| at(x, y)));
                // Within the element's width, which may wrap.
                let difference = (at(x, y) - predicted(left, up, corner)) << unused >> unused;
                ((difference << 1) ^ (difference >> 63)) as u64
            };
            let folded: Vec<u64> = (0..self.width * self.height).map(difference).collect();
            (0..bytes)
                .flat_map(|byte| folded.iter().map(|d| (d >> (8 * byte)) as u8).collect::<Vec<_>>())
                .collect::<Vec<_>>()
        };
        (0..self.channels).into_par_iter().flat_map_iter(of_channel).collect()
    }
}

/// The median of left, up, and left + up - corner.
fn predicted(left: i64, up: i64, corner: i64) -> i64 {
    (left + up - corner).clamp(left.min(up), left.max(up))
}

/// Bytes, the least significant bit first, as code units of fifteen bits; the last one is filled with zeros.
fn fifteen_bits(bytes: &[u8]) -> Vec<u16> {
    let (mut units, mut held, mut bits) = (Vec::with_capacity(bytes.len() * 8 / 15 + 1), 0u32, 0);
    let unit = |bits: u32| FIRST_UNIT + (bits & 0x7fff) as u16;
    for byte in bytes {
        held |= u32::from(*byte) << bits;
        bits += 8;
        if bits >= 15 {
            units.push(unit(held));
            held >>= 15;
            bits -= 15;
        }
    }
    if bits > 0 {
        units.push(unit(held));
    }
    units
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_folded_differences_by_channel_and_byte() {
        // 1, 2 and 0.5 are 0x3c00, 0x4000 and 0x3800 as half floats: differences 0x3c00, 0x400, -0x800.
        let picture = Picture { width: 3, height: 1, channels: 1, data: vec![1.0, 2.0, 0.5] };
        assert_eq!(Array::half(&picture).planes(), [0x00, 0x00, 0xff, 0x78, 0x08, 0x0f]);
        let pairs = Array::list(Element::U8, 2, vec![5, 9, 7, 8]);
        assert_eq!(pairs.planes(), [10, 4, 18, 1]);
        // A plane is predicted, so that its last code costs nothing.
        let data = vec![0.0, 0.25, 0.5, 0.75];
        let plane = Array::steps(&Picture { width: 2, height: 2, channels: 1, data }, 4.0).unwrap();
        assert_eq!(plane.planes(), [0, 2, 4, 2, 0, 0, 0, 0]);
    }

    #[test]
    fn directions_are_two_codes_and_colours_roots() {
        let data = vec![0.0, 0.0, 1.0, 0.6, 0.0, 0.8, 0.0, -0.6, -0.8, 0.0, 0.0, 0.0];
        let vectors = Picture { width: 4, height: 1, channels: 3, data };
        let none = NO_VECTOR;
        // 0.6 of 1.4; below the horizon the other axis' complement.
        let found = Array::octahedral(&vectors, 700.0).unwrap().codes;
        assert_eq!(found, [0, 0, 300, 0, 400, -700, none, none]);
        let long = Picture { width: 1, height: 1, channels: 3, data: vec![0.0, 0.0, 1.1] };
        assert!(Array::octahedral(&long, 700.0).is_none());
        let colours = |data| Picture { width: 1, height: 1, channels: 3, data };
        let found = Array::root(&colours(vec![0.36, 0.25, 0.04]), 10.0).unwrap().codes;
        assert_eq!(found, [1, 5, -3]);
        assert!(Array::root(&colours(vec![0.36, -0.01, 0.04]), 10.0).is_none());
    }

    #[test]
    fn code_units_hold_all_bits_and_are_safe_inside_quotes() {
        let bytes: Vec<u8> = (0..=255).rev().collect();
        let units = fifteen_bits(&bytes);
        assert_eq!(units.len(), (256 * 8usize).div_ceil(15));
        assert!(units.iter().all(|unit| (0x3000..0xb000).contains(unit)));
        let bit = |at: usize| (units[at / 15] - FIRST_UNIT) >> (at % 15) & 1;
        for (place, byte) in bytes.iter().enumerate() {
            let read: u16 = (0..8).map(|at| bit(8 * place + at) << at).sum();
            assert_eq!(read, u16::from(*byte));
        }
    }
}
