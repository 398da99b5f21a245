//! Radiance files (.hdr, .pic): header, orientation and colour; the pixels are the decoder's.

use std::io::{Cursor, Read};
use std::path::Path;

use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;

use super::colour::{self, Chromaticities, XYZ};
use super::{Picture, PictureError, limits};

/// Header lines beyond which a file is no picture.
const MAX_LINES: usize = 4096;

/// Header of a Radiance file.
struct Header {
    /// Factors per channel that the values were multiplied with.
    factors: [f32; 3],
    space: Option<Chromaticities>,
    /// The two axes of the resolution line, slow one first.
    axes: [Axis; 2],
    /// The offset of the pixels.
    pixels: usize,
}

/// One axis of the resolution line, as `-Y 512`.
struct Axis {
    vertical: bool,
    /// Towards larger coordinates: up or to the right.
    rising: bool,
    count: usize,
}

/// Reads a Radiance file in memory as linear Rec.709, three channels, upright; EXPOSURE and
/// COLORCORR are divided out, PRIMARIES converted. `path` is for messages.
pub fn read_radiance_bytes(path: &Path, bytes: &[u8]) -> Result<Picture, PictureError> {
    decode(bytes).map_err(|reason| PictureError::Read { path: path.to_path_buf(), reason })
}

fn decode(bytes: &[u8]) -> Result<Picture, String> {
    let header = header(bytes)?;
    let [slow, fast] = &header.axes;
    limits::check(fast.count as u64, slow.count as u64, 3, bytes.len())?;
    // The decoder knows one orientation and no old programs' headers.
    let plain =
        format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", slow.count, fast.count);
    let stream = Cursor::new(plain.into_bytes()).chain(&bytes[header.pixels..]);
    let mut values = vec![0u8; fast.count * slow.count * 12];
    // Runs of runs may overflow inside the decoder.
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        HdrDecoder::new(stream).and_then(|decoder| decoder.read_image(&mut values))
    }))
    .map_err(|_| "is damaged; save it again".to_owned())?
    .map_err(|error| format!("{error}; save it again, or as float EXR"))?;
    let mut picture = upright(&header.axes, &values);
    for pixel in picture.data.chunks_exact_mut(3) {
        for (value, factor) in pixel.iter_mut().zip(header.factors) {
            *value /= factor;
        }
    }
    if let Some(matrix) = header.space.map(|space| colour::to_rec709(&space)).transpose()?.flatten()
    {
        colour::convert(&mut picture, [0, 1, 2], &matrix);
    }
    Ok(picture)
}

/// Row 0 on top, column 0 at the left.
fn upright([slow, fast]: &[Axis; 2], values: &[u8]) -> Picture {
    let (width, height) =
        if slow.vertical { (fast.count, slow.count) } else { (slow.count, fast.count) };
    let mut picture = Picture::new(width, height, 3);
    let place = |axis: &Axis, index: usize| {
        // Rows count from the top, against the axis.
        if axis.rising == axis.vertical { axis.count - 1 - index } else { index }
    };
    for (index, rgb) in values.as_chunks::<12>().0.iter().enumerate() {
        let (outer, inner) = (place(slow, index / fast.count), place(fast, index % fast.count));
        let (x, y) = if slow.vertical { (inner, outer) } else { (outer, inner) };
        for (value, four) in picture.pixel_mut(x, y).iter_mut().zip(rgb.as_chunks::<4>().0) {
            *value = f32::from_ne_bytes(*four);
        }
    }
    picture
}

fn header(bytes: &[u8]) -> Result<Header, String> {
    let mut at = 0;
    let mut line = || {
        let rest = bytes.get(at..)?;
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        at += end + 1;
        Some((String::from_utf8_lossy(&rest[..end]).trim().to_owned(), at))
    };
    let mut factors = [1.0f32; 3];
    let (mut space, mut is_xyz) = (None, false);
    for _ in 0..MAX_LINES {
        let Some((text, _)) = line() else { break };
        if text.is_empty() {
            let (text, pixels) = line().ok_or("ends before its resolution; save it again")?;
            let space = if is_xyz { Some(XYZ) } else { space };
            return Ok(Header { factors, space, axes: axes(&text)?, pixels });
        }
        let Some((key, value)) = text.split_once('=') else { continue };
        match key.trim() {
            "FORMAT" => match value.trim() {
                "32-bit_rle_rgbe" => is_xyz = false,
                "32-bit_rle_xyze" => is_xyz = true,
                other => return Err(format!("is of format {other:?}; save it as 32-bit_rle_rgbe")),
            },
            "EXPOSURE" => {
                let [exposure] = numbers(&text, value)?;
                factors = factors.map(|factor| factor * exposure);
            }
            "COLORCORR" => {
                for (factor, number) in factors.iter_mut().zip(numbers::<3>(&text, value)?) {
                    *factor *= number;
                }
            }
            "PRIMARIES" => {
                let xy: [f32; 8] = numbers(&text, value)?;
                space = Some([[xy[0], xy[1]], [xy[2], xy[3]], [xy[4], xy[5]], [xy[6], xy[7]]]);
            }
            _ => {}
        }
        let sound = |factor: &f32| factor.is_normal() && *factor > 0.0;
        if !factors.iter().all(sound) {
            return Err(format!("says {text:?}, which no value can be divided by; fix the line"));
        }
    }
    Err("its header has no end; save it again".to_owned())
}

fn numbers<const N: usize>(line: &str, text: &str) -> Result<[f32; N], String> {
    let numbers: Option<Vec<f32>> =
        text.split_whitespace().map(|number| number.parse().ok()).collect();
    numbers
        .and_then(|numbers| <[f32; N]>::try_from(numbers).ok())
        .ok_or_else(|| format!("says {line:?}, where {N} numbers belong; fix the line"))
}

fn axes(line: &str) -> Result<[Axis; 2], String> {
    let wrong = || format!("its resolution is {line:?}; write it as \"-Y height +X width\"");
    let words: Vec<&str> = line.split_whitespace().collect();
    let [slow, rows, fast, columns] = words[..] else { return Err(wrong()) };
    let axis = |name: &str, count: &str| {
        let (rising, vertical) = match name {
            "-Y" => (false, true),
            "+Y" => (true, true),
            "-X" => (false, false),
            "+X" => (true, false),
            _ => return None,
        };
        let count = count.parse::<u32>().ok()? as usize;
        Some(Axis { vertical, rising, count })
    };
    match (axis(slow, rows), axis(fast, columns)) {
        (Some(slow), Some(fast)) if slow.vertical != fast.vertical => Ok([slow, fast]),
        _ => Err(wrong()),
    }
}
