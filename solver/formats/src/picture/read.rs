//! The readers by path.

use std::path::Path;

use super::exr_file::{Content, ExrFile};
use super::radiance::read_radiance_bytes;
use super::{Picture, PictureError, kind};

const RGB: [&str; 3] = ["R", "G", "B"];

/// The names by which [`read_exr`] finds the channels of an EXR file, from its header alone.
pub fn exr_channel_names(path: &Path) -> Result<Vec<String>, PictureError> {
    Ok(ExrFile::open(path)?.channel_names())
}

/// Reads the channels `names`, in that order, as they are in the file; finite.
pub fn read_exr(path: &Path, names: &[&str]) -> Result<Picture, PictureError> {
    finite(read_exr_unchecked(path, names, Content::Data)?, path, names)
}

/// Reads the channels `names`, in that order, of which R, G, B and each `layer.R`, `.G`, `.B` are
/// a colour: converted to linear Rec.709; finite.
pub fn read_exr_colour(path: &Path, names: &[&str]) -> Result<Picture, PictureError> {
    finite(read_exr_unchecked(path, names, Content::Colour)?, path, names)
}

/// [`read_exr`] or [`read_exr_colour`] that accepts NaN and infinities.
pub fn read_exr_unchecked(
    path: &Path,
    names: &[&str],
    content: Content,
) -> Result<Picture, PictureError> {
    ExrFile::open(path)?.read(names, content)
}

/// Reads R, G and B of an EXR as linear Rec.709; finite.
pub fn read_exr_rgb(path: &Path) -> Result<Picture, PictureError> {
    read_exr_colour(path, &RGB)
}

/// Reads an EXR or Radiance file as linear Rec.709, three channels; finite.
pub fn read_colour(path: &Path) -> Result<Picture, PictureError> {
    finite(read_colour_unchecked(path)?, path, &RGB)
}

/// [`read_colour`] that accepts NaN and infinities.
pub fn read_colour_unchecked(path: &Path) -> Result<Picture, PictureError> {
    let bytes = kind::bytes_of(path)?;
    if kind::is_radiance(&bytes) {
        return read_radiance_bytes(path, &bytes);
    }
    ExrFile::from_bytes(path, bytes)?.read(&RGB, Content::Colour)
}

fn finite(picture: Picture, path: &Path, names: &[&str]) -> Result<Picture, PictureError> {
    picture.require_finite(path, names).map(|()| picture)
}
