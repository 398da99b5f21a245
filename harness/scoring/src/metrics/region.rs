//! The pixels at which a metric is evaluated.

use formats::picture::{GrayImage, Picture};

use super::MetricError;

/// Side of the square that erodes a mask, pixels (the protocol of Stanford-ORB).
const EROSION: usize = 5;

/// A set of pixels with a name; never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    name: String,
    width: usize,
    height: usize,
    /// Row-major indices, ascending.
    pixels: Vec<usize>,
}

impl Region {
    /// Every pixel of a `width` x `height` picture.
    pub fn whole(width: usize, height: usize) -> Result<Self, MetricError> {
        Self::new("whole", width, height, |_| true)
    }

    /// The foreground (above 127) of a mask.
    pub fn of_mask(name: &str, mask: &GrayImage) -> Result<Self, MetricError> {
        Self::new(name, mask.width, mask.height, |i| foreground(mask, i))
    }

    /// The foreground of a mask, eroded once by 5x5; beyond the border is background.
    pub fn eroded(name: &str, mask: &GrayImage) -> Result<Self, MetricError> {
        let (width, height, reach) = (mask.width, mask.height, EROSION / 2);
        let run = |centre: usize, length: usize| {
            (centre >= reach && centre + reach < length).then(|| centre - reach..=centre + reach)
        };
        let rows: Vec<bool> = (0..width * height)
            .map(|i| {
                let row = i / width * width;
                run(i % width, width)
                    .is_some_and(|mut columns| columns.all(|x| foreground(mask, row + x)))
            })
            .collect();
        Self::new(name, width, height, |i| {
            run(i / width, height).is_some_and(|mut ys| ys.all(|y| rows[y * width + i % width]))
        })
    }

    /// The rim that erosion takes from a mask: the foreground within two pixels of its edge.
    pub fn rim(name: &str, mask: &GrayImage) -> Result<Self, MetricError> {
        let kept = Self::eroded(name, mask)?.pixels;
        Self::new(name, mask.width, mask.height, |i| {
            foreground(mask, i) && kept.binary_search(&i).is_err()
        })
    }

    /// The part of this region where `keep` holds of the row-major pixel index.
    pub fn part(&self, name: &str, keep: impl Fn(usize) -> bool) -> Result<Self, MetricError> {
        let pixels: Vec<usize> = self.pixels.iter().copied().filter(|i| keep(*i)).collect();
        Self::of_pixels(name, self.width, self.height, pixels)
    }

    /// The name, as a row of the scores carries it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Columns and rows of the pictures it belongs to.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Row-major indices of its pixels, ascending.
    pub fn pixels(&self) -> &[usize] {
        &self.pixels
    }

    /// For each of its pixels the square of `side` pixels that it lies in, numbered row-major.
    pub fn blocks(&self, side: usize) -> impl Iterator<Item = usize> {
        let (width, per_row) = (self.width, self.width.div_ceil(side));
        self.pixels.iter().map(move |i| i / width / side * per_row + i % width / side)
    }

    fn new(
        name: &str,
        width: usize,
        height: usize,
        inside: impl Fn(usize) -> bool,
    ) -> Result<Self, MetricError> {
        let pixels = (0..width * height).filter(|i| inside(*i)).collect();
        Self::of_pixels(name, width, height, pixels)
    }

    fn of_pixels(
        name: &str,
        width: usize,
        height: usize,
        pixels: Vec<usize>,
    ) -> Result<Self, MetricError> {
        if pixels.is_empty() {
            return Err(MetricError::EmptyRegion { region: name.to_owned() });
        }
        Ok(Self { name: name.to_owned(), width, height, pixels })
    }
}

/// The picture with everything outside the mask's foreground black, so that metrics which look
/// at a neighbourhood (`ssim`, `flip`) do not depend on what a method leaves there.
pub fn black_outside(picture: &Picture, mask: &GrayImage) -> Picture {
    let mut masked = picture.clone();
    for (i, pixel) in masked.data.chunks_exact_mut(picture.channels.max(1)).enumerate() {
        if !foreground(mask, i) {
            pixel.fill(0.0);
        }
    }
    masked
}

fn foreground(mask: &GrayImage, index: usize) -> bool {
    mask.data[index] > 127
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn erosion_takes_two_pixels_from_every_side_and_the_border_is_outside() {
        let full = GrayImage { width: 9, height: 7, data: vec![255; 63] };
        let region = Region::eroded("e", &full).unwrap();
        assert_eq!(region.pixels().len(), 5 * 3);
        assert_eq!(region.pixels()[0], 2 * 9 + 2);
        let rim = Region::rim("r", &full).unwrap();
        assert_eq!(rim.pixels().len(), 63 - 15);
        assert!(rim.pixels().iter().all(|i| region.pixels().binary_search(i).is_err()));
        let mut hole = full;
        hole.data[3 * 9 + 4] = 0;
        assert_eq!(
            Region::eroded("holed", &hole),
            Err(MetricError::EmptyRegion { region: "holed".to_owned() })
        );
    }

    #[test]
    fn blocks_are_numbered_row_by_row() {
        let region = Region::whole(5, 3).unwrap();
        let blocks: Vec<_> = region.blocks(2).collect();
        assert_eq!(blocks, [0, 0, 1, 1, 2, 0, 0, 1, 1, 2, 3, 3, 4, 4, 5]);
    }
}
