//! A rendered picture with what it may carry: its layers and the variance of its noise.

use std::path::Path;

use formats::picture::{Content, ExrFile, GrayImage, Picture};

use super::ScoreError;
use super::truth::{check_size, size};
use crate::metrics::black_outside;

/// Prefixes of the parts' channel names.
const PARTS: [&str; 5] = ["", "diffuse.", "specular.", "variance.", "half."];

/// A picture; layers and variance where the file has them.
pub(super) struct Render {
    pub total: Option<Picture>,
    pub diffuse: Option<Picture>,
    pub specular: Option<Picture>,
    /// Variance of the mean of the total.
    pub variance: Option<Picture>,
    /// The total of one half of the samples, independent of the other.
    pub half: Option<Picture>,
}

impl Render {
    /// Reads `R, G, B` and the same below `diffuse.`, `specular.`, `variance.` and `half.`; a part
    /// counts as present if its red channel is, and must then be complete.
    pub fn read(path: &Path) -> Result<Self, ScoreError> {
        let mut render = Self::decode(path)?;
        render.require_finite(path)?;
        Ok(render)
    }

    fn decode(path: &Path) -> Result<Self, ScoreError> {
        let file = ExrFile::open(path)?;
        let found = file.channel_names();
        let present: Vec<&str> =
            PARTS.into_iter().filter(|part| found.contains(&format!("{part}R"))).collect();
        let names: Vec<String> = present
            .iter()
            .flat_map(|part| ["R", "G", "B"].map(|channel| format!("{part}{channel}")))
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let all = file.read(&names, Content::Colour)?;
        let part = |name: &str| {
            let first = 3 * present.iter().position(|part| *part == name)?;
            let pixels = all.data.chunks_exact(all.channels);
            let data = pixels.flat_map(|pixel| &pixel[first..first + 3]).copied().collect();
            Some(Picture { width: all.width, height: all.height, channels: 3, data })
        };
        let [total, diffuse, specular, variance, half] = PARTS.map(part);
        Ok(Self { total, diffuse, specular, variance, half })
    }

    /// Reads a picture of the mask's size and blackens it outside, where it may hold anything.
    pub fn read_masked(path: &Path, mask: &GrayImage) -> Result<Self, ScoreError> {
        let mut render = Self::decode(path)?;
        for part in render.parts() {
            check_size(path, size(part), (mask.width, mask.height))?;
            *part = black_outside(part, mask);
        }
        render.require_finite(path)?;
        Ok(render)
    }

    /// Multiplies each channel by the factor that fits the totals over `pixels` best: k = <p,g>/<p,p>.
    pub fn scale_to(&mut self, truth: &Self, pixels: &[usize]) {
        let (Some(found), Some(truth)) = (&self.total, &truth.total) else { return };
        let factor = |channel: usize| {
            let dot = |a: &Picture, b: &Picture| -> f64 {
                let at = |pixel: &usize| 3 * pixel + channel;
                pixels.iter().map(|p| f64::from(a.data[at(p)]) * f64::from(b.data[at(p)])).sum()
            };
            let own = dot(found, found);
            if own > 0.0 { (dot(found, truth) / own) as f32 } else { 1.0 }
        };
        let factors = [0, 1, 2].map(factor);
        for part in [&mut self.total, &mut self.diffuse, &mut self.specular, &mut self.half] {
            for pixel in part.iter_mut().flat_map(|part| part.data.chunks_exact_mut(3)) {
                pixel.iter_mut().zip(factors).for_each(|(value, factor)| *value *= factor);
            }
        }
        for pixel in self.variance.iter_mut().flat_map(|part| part.data.chunks_exact_mut(3)) {
            pixel.iter_mut().zip(factors).for_each(|(value, factor)| *value *= factor * factor);
        }
    }

    fn require_finite(&mut self, path: &Path) -> Result<(), ScoreError> {
        for part in self.parts() {
            part.require_finite(path, &["R", "G", "B"])?;
        }
        Ok(())
    }

    fn parts(&mut self) -> impl Iterator<Item = &mut Picture> {
        let Self { total, diffuse, specular, variance, half } = self;
        [total, diffuse, specular, variance, half].into_iter().flatten()
    }
}
