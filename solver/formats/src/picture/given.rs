//! Pictures as other programs give them: float EXR as it is, PNG by the code that is usual.

use std::path::Path;

use super::{Picture, PictureError, Png, read_exr_colour, read_exr_unchecked};
use crate::picture::Content;

const RGB: [&str; 3] = ["R", "G", "B"];

/// Content of a picture that is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// Linear Rec.709 in an EXR, sRGB codes in a PNG.
    Colour,
    /// Vectors in an EXR, n/2 + 1/2 in a PNG.
    Normals,
}

impl Given {
    /// Reads `<name>.exr`, else `<name>.png`, of a folder; none if it has neither. Three channels.
    pub fn read(self, folder: &Path, name: &str) -> Result<Option<Picture>, PictureError> {
        let exr = folder.join(format!("{name}.exr"));
        if exr.is_file() {
            return match self {
                Self::Colour => read_exr_colour(&exr, &RGB),
                Self::Normals => read_exr_unchecked(&exr, &RGB, Content::Data),
            }
            .map(Some);
        }
        let png = folder.join(format!("{name}.png"));
        if !png.is_file() {
            return Ok(None);
        }
        let codes = Png::open(&png)?.picture(&png)?;
        let decode = |code: f32| match self {
            Self::Colour => linear(code),
            Self::Normals => 2.0 * code - 1.0,
        };
        let spread = 3 / codes.channels;
        let values = codes.data.iter().flat_map(|code| std::iter::repeat_n(decode(*code), spread));
        Ok(Some(Picture { channels: 3, data: values.collect(), ..codes }))
    }
}

/// The linear value of an sRGB code from 0 to 1 (IEC 61966-2-1).
fn linear(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{GrayImage, write_exr_rgb, write_png_gray};

    #[test]
    fn an_exr_is_taken_as_it_is_and_a_png_by_its_code() {
        let root = tempfile::tempdir().unwrap();
        let gray = GrayImage { width: 2, height: 1, data: vec![0, 188] };
        write_png_gray(&root.path().join("a.png"), &gray).unwrap();
        let colour = Given::Colour.read(root.path(), "a").unwrap().unwrap();
        // sRGB 188 is .5029 linear.
        assert!((colour.pixel(1, 0)[2] - 0.5029).abs() < 1e-4 && colour.channels == 3);
        let normals = Given::Normals.read(root.path(), "a").unwrap().unwrap();
        assert_eq!(normals.pixel(0, 0), [-1.0; 3]);
        let picture = Picture { width: 1, height: 1, channels: 3, data: vec![-0.5, 2.0, 0.25] };
        write_exr_rgb(&root.path().join("a.exr"), &picture).unwrap();
        assert_eq!(Given::Normals.read(root.path(), "a").unwrap(), Some(picture));
        assert_eq!(Given::Colour.read(root.path(), "b").unwrap(), None);
    }
}
