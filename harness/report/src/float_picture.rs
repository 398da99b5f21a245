//! Float pictures for the page's viewer: a page from disk may load a script, but neither fetch a file nor read
//! the pixels of a picture, so the values stand in a script of their own that is loaded when asked for.

use std::io::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use formats::picture::Picture;
use half::f16;

use super::error::ReportError;
use super::save::write_file;
use super::tone;

/// The longest side of a float picture, pixels; larger ones are averaged down.
const LONGEST_SIDE: usize = 512;

/// Writes `picture` as the script `path`: a call of `unshadeFloat` with the script's name below the report,
/// width, height, channels, and the values as zlib in base64.
pub(super) fn write(path: &Path, name: &str, picture: &Picture) -> Result<(), ReportError> {
    let failed = |error| ReportError::write(path, error);
    let small = tone::shrink(picture, LONGEST_SIDE);
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&planes(&small)).map_err(failed)?;
    let values = STANDARD.encode(encoder.finish().map_err(failed)?);
    let Picture { width, height, channels, .. } = small;
    let script = format!("unshadeFloat(\"{name}\",{width},{height},{channels},\"{values}\");\n");
    write_file(path, script)
}

/// Channel by channel the low bytes, then the high bytes, of half floats, each less its left neighbour: what
/// differs little compresses well.
fn planes(picture: &Picture) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(2 * picture.data.len());
    for channel in 0..picture.channels {
        let code = |x, y| f16::from_f32(picture.pixel(x, y)[channel]).to_bits();
        let steps: Vec<u16> = (0..picture.width * picture.height)
            .map(|i| {
                let (x, y) = (i % picture.width, i / picture.width);
                code(x, y).wrapping_sub(if x > 0 { code(x - 1, y) } else { 0 })
            })
            .collect();
        bytes.extend(steps.iter().map(|step| *step as u8));
        bytes.extend(steps.iter().map(|step| (step >> 8) as u8));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_steps_of_half_floats_in_planes() {
        // 1, 2 and 0.5 are 0x3c00, 0x4000 and 0x3800 as half floats.
        let picture = Picture { width: 3, height: 1, channels: 1, data: vec![1.0, 2.0, 0.5] };
        assert_eq!(planes(&picture), [0x00, 0x00, 0x00, 0x3c, 0x04, 0xf8]);
    }
}
