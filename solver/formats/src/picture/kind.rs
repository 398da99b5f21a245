//! Kind of a file by its first bytes, whatever its name says.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::PictureError;
use super::limits::MAX_BYTES;

/// The way from a file of a camera or a viewer to a picture.
const LINEAR: &str = "pictures are linear float EXR with channels R, G, B: develop the raw file \
                      without tone curve or sRGB coding (darktable or dcraw -4 -T, then oiiotool) \
                      and save it as EXR";

const OTHERS: [(&[u8], usize, &str); 10] = [
    (b"\xff\xd8\xff", 0, "a JPEG"),
    (b"\x89PNG", 0, "a PNG"),
    (b"II*\0", 0, "a TIFF or raw file"),
    (b"MM\0*", 0, "a TIFF or raw file"),
    (b"ftyp", 4, "a HEIC, AVIF or CR3 file"),
    (b"FUJIFILM", 0, "a raw file"),
    (b"IIRO", 0, "a raw file"),
    (b"IIU\0", 0, "a raw file"),
    (b"RIFF", 0, "a WebP"),
    (b"BM", 0, "a BMP"),
];

/// Returns whether the bytes begin as an EXR file.
pub(super) fn is_exr(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01])
}

/// Returns whether the bytes begin as a Radiance file.
pub(super) fn is_radiance(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#?")
}

/// The reason why bytes of another kind are not read; `None` for those of no known kind.
pub(super) fn why_not(bytes: &[u8]) -> Option<String> {
    let is = |(mark, at, _): &&(&[u8], usize, &str)| {
        bytes.get(*at..).is_some_and(|rest| rest.starts_with(mark))
    };
    if is_radiance(bytes) {
        return Some(
            "is a Radiance file, which is read as a light alone; save it as EXR".to_owned(),
        );
    }
    OTHERS.iter().find(is).map(|(_, _, what)| format!("is {what}; {LINEAR}"))
}

/// The bytes of a regular file of sane size.
pub(super) fn bytes_of(path: &Path) -> Result<Vec<u8>, PictureError> {
    let wrong = |reason: String| PictureError::Read { path: path.to_path_buf(), reason };
    let io = |error: std::io::Error| wrong(error.to_string());
    let state = std::fs::metadata(path).map_err(io)?;
    if !state.is_file() {
        return Err(wrong("is not a file; name a picture".to_owned()));
    }
    if state.len() > MAX_BYTES {
        return Err(wrong(format!("is {} bytes long, too long for a picture", state.len())));
    }
    // No more than was found, should the file grow.
    let mut bytes = Vec::new();
    File::open(path).map_err(io)?.take(state.len()).read_to_end(&mut bytes).map_err(io)?;
    Ok(bytes)
}
