//! Float pictures as the 8-bit files of a report: exact sRGB, stated exposures and
//! scales, errors in false colour.

use std::path::Path;

use formats::picture::{self, Picture, PictureError};

use scoring::metrics::srgb;

/// The longest side of a picture in a report; larger ones are averaged down.
const LONGEST_SIDE: usize = 512;

/// Colour outside the scored region of an error picture; no colour of the map.
pub(super) const OUTSIDE: [u8; 3] = [118, 122, 128];

/// An 8-bit sRGB picture, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// R, G, B of every pixel.
    pub bytes: Vec<u8>,
}

impl Raster {
    fn from_pixels(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [u8; 3]) -> Self {
        let bytes = (0..width * height).flat_map(|i| pixel(i % width, i / width)).collect();
        Self { width, height, bytes }
    }

    pub(super) fn save(&self, path: &Path) -> Result<(), PictureError> {
        picture::write_png_rgb(path, &self.bytes, self.width, self.height)
    }
}

/// A scalar per pixel; NaN where nothing is compared.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub width: usize,
    pub height: usize,
    pub values: Vec<f32>,
}

/// The 8-bit code of a value in [0, 1]; others are clipped.
fn byte(display: f32) -> u8 {
    (display.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// The 8-bit sRGB code of a linear value.
fn srgb_byte(linear: f32) -> u8 {
    byte(srgb(f64::from(linear)) as f32)
}

/// Linear colour times `exposure`, through the sRGB curve.
pub fn colour(picture: &Picture, exposure: f32) -> Raster {
    let small = shrink(picture, LONGEST_SIDE);
    Raster::from_pixels(small.width, small.height, |x, y| {
        let pixel = small.pixel(x, y);
        std::array::from_fn(|c| srgb_byte(pixel[c.min(pixel.len() - 1)] * exposure))
    })
}

/// The first channel from 0 (black) to `white`, without a transfer curve.
pub fn grey(picture: &Picture, white: f32) -> Raster {
    let small = shrink(picture, LONGEST_SIDE);
    Raster::from_pixels(small.width, small.height, |x, y| [byte(small.pixel(x, y)[0] / white); 3])
}

/// Unit vectors as `n * 0.5 + 0.5`, without a transfer curve; a zero vector is left grey.
pub fn normals(picture: &Picture) -> Raster {
    let small = shrink(picture, LONGEST_SIDE);
    Raster::from_pixels(small.width, small.height, |x, y| {
        let pixel = small.pixel(x, y);
        std::array::from_fn(|c| byte(pixel[c] * 0.5 + 0.5))
    })
}

/// An error field from 0 to `top`, in the colours of [`heat`]; larger values take the last one.
pub(super) fn false_colour(field: &Field, top: f32) -> Raster {
    let factor = field.width.max(field.height).div_ceil(LONGEST_SIDE);
    let (width, height) = (field.width / factor, field.height / factor);
    Raster::from_pixels(width, height, |x, y| {
        let value = field.values[y * factor * field.width + x * factor];
        if value.is_nan() { OUTSIDE } else { heat(value / top) }
    })
}

/// Black through violet and orange to pale yellow: the ten anchors of the public domain
/// map "magma" (S. van der Walt, N. Smith, 2015), whose lightness rises evenly with the error.
pub(super) fn heat(value: f32) -> [u8; 3] {
    const ANCHORS: [[u8; 3]; 10] = [
        [0, 0, 4],
        [24, 15, 61],
        [68, 15, 118],
        [114, 31, 129],
        [158, 47, 127],
        [205, 64, 113],
        [241, 96, 93],
        [253, 150, 104],
        [254, 202, 141],
        [252, 253, 191],
    ];
    let place = value.clamp(0.0, 1.0) * (ANCHORS.len() - 1) as f32;
    let low = (place as usize).min(ANCHORS.len() - 2);
    let part = place - low as f32;
    std::array::from_fn(|c| {
        let (a, b) = (f32::from(ANCHORS[low][c]), f32::from(ANCHORS[low + 1][c]));
        (a + (b - a) * part).round() as u8
    })
}

/// The anchors of [`heat`] as a CSS gradient from left to right.
pub(super) fn heat_gradient() -> String {
    let stops: Vec<String> = (0..=18)
        .map(|i| {
            let [r, g, b] = heat(i as f32 / 18.0);
            format!("rgb({r},{g},{b})")
        })
        .collect();
    format!("linear-gradient(to right,{})", stops.join(","))
}

/// Averages whole blocks of pixels until no side is longer than `longest`.
pub(super) fn shrink(picture: &Picture, longest: usize) -> Picture {
    let factor = picture.width.max(picture.height).div_ceil(longest).max(1);
    if factor == 1 {
        return picture.clone();
    }
    let (width, height) = (picture.width / factor, picture.height / factor);
    let mut small = Picture::new(width, height, picture.channels);
    let weight = 1.0 / (factor * factor) as f32;
    for y in 0..height * factor {
        for x in 0..width * factor {
            let target = small.pixel_mut(x / factor, y / factor);
            for (sum, value) in target.iter_mut().zip(picture.pixel(x, y)) {
                *sum += value * weight;
            }
        }
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mid_grey_takes_the_code_of_the_standard() {
        // Half the display's range is 21.4 % of its light.
        assert_eq!((srgb_byte(0.2130), srgb_byte(0.2159)), (127, 128));
        assert_eq!((srgb_byte(-1.0), srgb_byte(7.0)), (0, 255));
    }

    #[test]
    fn the_error_map_grows_lighter_everywhere_and_never_shows_the_outside_colour() {
        let luma = |[r, g, b]: [u8; 3]| {
            0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b)
        };
        let colours: Vec<_> = (0..=255).map(|i| heat(i as f32 / 255.0)).collect();
        assert!(colours.windows(2).all(|pair| luma(pair[1]) >= luma(pair[0])));
        assert!(!colours.contains(&OUTSIDE));
        assert_eq!(heat(9.0), heat(1.0));
    }

    #[test]
    fn shrinking_keeps_the_mean() {
        let mut picture = Picture::new(6, 4, 2);
        for (i, value) in picture.data.iter_mut().enumerate() {
            *value = i as f32;
        }
        let small = shrink(&picture, 3);
        assert_eq!((small.width, small.height), (3, 2));
        let mean = |p: &Picture| p.data.iter().sum::<f32>() / p.data.len() as f32;
        assert!((mean(&picture) - mean(&small)).abs() < 1e-4);
    }

    #[test]
    fn pixels_that_are_not_compared_are_left_out_of_the_colours() {
        let field = Field { width: 2, height: 1, values: vec![f32::NAN, 0.0] };
        assert_eq!(false_colour(&field, 1.0).bytes, [&OUTSIDE[..], &heat(0.0)[..]].concat());
    }
}
