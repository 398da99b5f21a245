//! Lights: latitude-longitude pictures of the whole sphere, no other layout.

use std::path::Path;

use super::exr_file::{Content, ExrFile};
use super::radiance::read_radiance_bytes;
use super::{Picture, PictureError, kind};

/// Texels, and share of the width, by which the sides may miss 2 : 1 (crops and odd sizes).
const SLACK: (usize, usize) = (2, 100);

const FIX: &str = "convert it to a lat-long picture of 2 : 1 (cmft, or oiiotool and Blender's \
                    equirectangular camera)";

/// Reads a light, EXR or Radiance, as linear Rec.709, three channels, finite; a cube map, a cross,
/// a light probe and whatever is not 2 : 1 is refused by name.
pub fn read_light(path: &Path) -> Result<Picture, PictureError> {
    let refused = |reason: String| PictureError::Refused { path: path.to_path_buf(), reason };
    let bytes = kind::bytes_of(path)?;
    let picture = if kind::is_radiance(&bytes) {
        read_radiance_bytes(path, &bytes)?
    } else {
        let file = ExrFile::from_bytes(path, bytes)?;
        if file.is_cube_map() {
            return Err(refused(format!("is a cube map (envmap = cube); {FIX}")));
        }
        file.read(&["R", "G", "B"], Content::Colour)?
    };
    let (width, height) = (picture.width, picture.height);
    if width.abs_diff(2 * height) > SLACK.0.max(width / SLACK.1) {
        let what = layout(width, height);
        return Err(refused(format!("is {width} x {height}, {what}, no lat-long picture; {FIX}")));
    }
    picture.require_finite(path, &["R", "G", "B"])?;
    Ok(picture)
}

/// Likely layout of an environment picture with these sides.
fn layout(width: usize, height: usize) -> &'static str {
    let is = |across: usize, down: usize| width * down == height * across;
    if is(1, 1) {
        "the shape of a light probe (mirror ball or angular map)"
    } else if is(6, 1) || is(1, 6) {
        "the shape of a cube map's six sides in a row"
    } else if is(4, 3) || is(3, 4) {
        "the shape of a cube map's cross"
    } else if is(3, 2) || is(2, 3) {
        "the shape of a cube map's sides in two rows"
    } else {
        "not 2 : 1"
    }
}
