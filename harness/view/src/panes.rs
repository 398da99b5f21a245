//! The truth and the methods as panes of the page.

use std::path::Path;

use formats::fill;
use formats::picture::{GrayImage, Picture};
use serde::Serialize;

use crate::error::ViewError;
use crate::errors::Patch;
use crate::packed::{Array, Stored};
use crate::sources::Source;

/// The largest side of a map in a page, texels; larger maps are averaged down.
const LARGEST_SIDE: usize = 1024;

/// Steps of an albedo's square root per 1: errors below 0.00016 up to an albedo of 0.4, and below 0.1 CIEDE2000.
const ROOT_STEPS: f32 = 4096.0;

/// Steps of a folded direction per 1: errors of a normal's component below 0.0005, or 0.03 degrees.
const NORMAL_STEPS: f32 = 4096.0;

/// Steps of a GGX alpha, of a lobe's share, and of a confidence per 1.
const ROUGHNESS_STEPS: f32 = 4096.0;
const CONFIDENCE_STEPS: f32 = 256.0;

/// Texels around the coverage that keep a colour, so that filtered texture reads meet no black.
const RIM: u32 = 8;

/// A pane: the truth, or a method.
#[derive(Serialize)]
pub(crate) struct Pane {
    pub id: String,
    pub title: String,
    pub is_truth: bool,
    /// The maps that there are, by name; `<map>_std` for standard deviations.
    maps: Vec<(String, Stored)>,
    /// Texels of the file along a texel of the page.
    step: usize,
    /// The factor on the diffuse albedo that minimises its error; none without a truth.
    pub factor: Option<f64>,
    pub worst: Vec<Patch>,
    light: Option<StoredLight>,
}

/// A light as a lat-long picture.
#[derive(Serialize)]
pub(crate) struct StoredLight {
    picture: Stored,
    /// True if the first and the last row lie on the poles, false if rows are bands.
    poles: bool,
}

impl StoredLight {
    /// Writes a light as the array `name`; one of the truth has rows on the poles.
    pub fn write(
        light: &Picture,
        is_truth: bool,
        folder: &Path,
        name: &str,
    ) -> Result<Self, ViewError> {
        Ok(Self { picture: Array::half(light).write(folder, name)?, poles: is_truth })
    }
}

impl Pane {
    /// Writes the maps of a source.
    pub fn write(
        source: &Source,
        id: &str,
        title: &str,
        is_truth: bool,
        folder: &Path,
    ) -> Result<Self, ViewError> {
        let coverage = source.coverage();
        let maps = &source.maps;
        let named = [
            ("diffuse_albedo", &maps.diffuse_albedo),
            ("specular_albedo", &maps.specular_albedo),
            ("diffuse_normal", &maps.diffuse_normal),
            ("specular_normal", &maps.specular_normal),
            ("roughness", &maps.roughness),
            ("confidence", &maps.confidence),
        ];
        let named =
            named.into_iter().filter_map(|(name, map)| Some((name.to_owned(), map.as_ref()?)));
        let stated = source.deviations.iter().map(|(name, map)| (format!("{name}_std"), map));
        let side = maps.diffuse_albedo.as_ref().map_or(1, |map| map.width);
        let step = side.div_ceil(LARGEST_SIDE).max(1);
        let mut stored: Vec<(String, Stored)> = Vec::new();
        let mut arrays: Vec<Array> = Vec::new();
        for (name, map) in named.chain(stated) {
            let map = trimmed(map, coverage.as_ref());
            let map = averaged(&map, step);
            let array = match name.as_str() {
                "diffuse_albedo" => Array::root(&map, ROOT_STEPS),
                "diffuse_normal" | "specular_normal" => Array::octahedral(&map, NORMAL_STEPS),
                "roughness" => Array::steps(&map, ROUGHNESS_STEPS),
                "confidence" => Array::steps(&map, CONFIDENCE_STEPS),
                _ => None,
            };
            let array = array.unwrap_or_else(|| Array::half(&map));
            // Many methods have the same normals twice.
            let script = match arrays.iter().position(|other| *other == array) {
                Some(at) => stored[at].1.clone(),
                None => array.write(folder, &format!("{id}-{name}"))?,
            };
            arrays.push(array);
            stored.push((name, script));
        }
        let light = source
            .light
            .as_ref()
            .map(|light| StoredLight::write(light, is_truth, folder, &format!("{id}-light")));
        Ok(Self {
            id: id.to_owned(),
            title: title.to_owned(),
            is_truth,
            maps: stored,
            step,
            factor: None,
            worst: Vec::new(),
            light: light.transpose()?,
        })
    }
}

/// A map with 0 outside its coverage but for a rim, which has the nearest texel's values.
fn trimmed(map: &Picture, coverage: Option<&GrayImage>) -> Picture {
    let Some(coverage) = coverage.filter(|mask| mask.data.len() == map.width * map.height) else {
        return map.clone();
    };
    let known: Vec<bool> = coverage.data.iter().map(|value| *value > 127).collect();
    let nearest = fill::nearest_known(&known, map.width, map.height);
    let mut trimmed = Picture::new(map.width, map.height, map.channels);
    for (at, source) in nearest.into_iter().enumerate() {
        let source = source as usize;
        let (x, y) = (at % map.width, at / map.width);
        let (from_x, from_y) = (source % map.width, source / map.width);
        let distance = x.abs_diff(from_x).max(y.abs_diff(from_y));
        if known[source] && distance <= RIM as usize {
            trimmed.pixel_mut(x, y).copy_from_slice(map.pixel(from_x, from_y));
        }
    }
    trimmed
}

/// Means over squares of `step` texels.
fn averaged(map: &Picture, step: usize) -> Picture {
    if step == 1 {
        return map.clone();
    }
    let side = map.width / step;
    let mut small = Picture::new(side, side, map.channels);
    let share = 1.0 / (step * step) as f32;
    for y in 0..side * step {
        for x in 0..side * step {
            let target = small.pixel_mut(x / step, y / step);
            target.iter_mut().zip(map.pixel(x, y)).for_each(|(sum, value)| *sum += share * value);
        }
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_keeps_its_values_inside_a_rim_outside_and_nothing_beyond() {
        let data: Vec<f32> = (0..32 * 32).map(|i| i as f32).collect();
        let map = Picture { width: 32, height: 32, channels: 1, data };
        let mut coverage = GrayImage::new(32, 32);
        (0..32).for_each(|y| coverage.data[32 * y..32 * y + 4].fill(255));
        let found = trimmed(&map, Some(&coverage));
        assert_eq!(found.pixel(3, 9), map.pixel(3, 9));
        assert_eq!(found.pixel(3 + RIM as usize, 9), map.pixel(3, 9));
        assert_eq!(found.pixel(4 + RIM as usize, 9), [0.0]);
        assert_eq!(trimmed(&map, None), map);
    }

    #[test]
    fn squares_are_averaged() {
        let data =
            vec![1.0, 3.0, 0.0, 0.0, 5.0, 7.0, 0.0, 8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0];
        let map = Picture { width: 4, height: 4, channels: 1, data };
        assert_eq!(averaged(&map, 2).data, [4.0, 2.0, 0.0, 1.0]);
    }
}
