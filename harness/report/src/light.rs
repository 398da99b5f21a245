//! Environments, latitude over longitude, as pictures.

use std::f64::consts::PI;

use formats::picture::Picture;

use super::tone::{self, Raster};

/// Cells of a coarse environment are drawn as squares until it is this wide, pixels.
const NARROWEST: usize = 256;

/// The mean radiance in each of `width` x `height` cells, weighted by the solid angle; none if the
/// environment is coarser than the cells.
pub(super) fn in_cells(light: &Picture, width: usize, height: usize) -> Option<Picture> {
    if light.width < width || light.height < height {
        return None;
    }
    let mut sums = vec![[0.0; 4]; width * height];
    for y in 0..light.height {
        let weight = ((y as f64 + 0.5) / light.height as f64 * PI).sin();
        for x in 0..light.width {
            let cell = y * height / light.height * width + x * width / light.width;
            for (sum, value) in sums[cell].iter_mut().zip(light.pixel(x, y)) {
                *sum += weight * f64::from(*value);
            }
            sums[cell][3] += weight;
        }
    }
    let data = sums.iter().flat_map(|[r, g, b, w]| [r / w, g / w, b / w].map(|v| v as f32));
    Some(Picture { width, height, channels: 3, data: data.collect() })
}

/// Radiance L as L / (1 + L), which keeps lamps and their surroundings apart; the hue stays.
pub(super) fn raster(light: &Picture) -> Raster {
    let mut mapped = light.clone();
    for pixel in mapped.data.chunks_exact_mut(3) {
        let luminance = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
        pixel.iter_mut().for_each(|value| *value /= 1.0 + luminance.max(0.0));
    }
    tone::colour(&enlarged(&mapped), 1.0)
}

fn enlarged(picture: &Picture) -> Picture {
    let factor = NARROWEST.div_ceil(picture.width.max(1)).max(1);
    let (width, height) = (picture.width * factor, picture.height * factor);
    let mut large = Picture::new(width, height, picture.channels);
    for y in 0..height {
        for x in 0..width {
            large.pixel_mut(x, y).copy_from_slice(picture.pixel(x / factor, y / factor));
        }
    }
    large
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_stays_and_a_lamp_falls_into_its_cell() {
        let mut light = Picture::new(64, 32, 3);
        light.data.fill(0.5);
        assert!(in_cells(&light, 8, 4).unwrap().data.iter().all(|v| (v - 0.5).abs() < 1e-6));
        light.pixel_mut(41, 13)[1] = 100.0;
        let cells = in_cells(&light, 8, 4).unwrap();
        let bright: Vec<usize> = (0..32).filter(|cell| cells.data[3 * cell + 1] > 0.6).collect();
        assert_eq!(bright, [8 + 5]);
        assert!((cells.data[3 * 13] - 0.5).abs() < 1e-6, "its red is none of the lamp's");
        assert!(in_cells(&light, 128, 4).is_none());
    }

    #[test]
    fn cells_are_drawn_as_squares_and_the_brightest_is_not_clipped() {
        let data = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 4.0, 4.0, 4.0, 50.0, 50.0, 50.0];
        let raster = raster(&Picture { width: 4, height: 1, channels: 3, data });
        assert_eq!((raster.width, raster.height), (256, 64));
        let codes: Vec<u8> = (0..4).map(|cell| raster.bytes[3 * (cell * 64 + 32)]).collect();
        assert!(codes[0] == 0 && codes.windows(2).all(|pair| pair[0] < pair[1]), "{codes:?}");
        assert!(codes[3] < 255);
    }
}
