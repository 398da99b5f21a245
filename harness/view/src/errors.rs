//! The error of each texel of a method's maps against the truth, and the patches where it is largest.

use formats::Maps;
use formats::picture::{GrayImage, Picture};
use scoring::metrics::{MetricError, Pair, Region, Scale, ciede2000, lab, resample};
use serde::Serialize;

use crate::sources::Source;

/// Patches along a side of the texture.
const PATCHES: usize = 32;

/// The number of worst patches that are kept.
const WORST: usize = 10;

/// The share of a scale's values that its colours tell apart.
const SHARE: f64 = 0.98;

/// A measured error: its name in the page, and its values at the texels of the truth's region.
pub(crate) struct TexelErrors {
    pub measure: &'static str,
    values: Vec<f64>,
    /// Each error over the deviation that the method states there.
    over_stated: Option<Vec<f64>>,
}

/// A patch of the texture with a large error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Patch {
    measure: &'static str,
    /// Mean error over the patch, in the measure's unit.
    value: f64,
    /// The mean of the error over the stated deviation.
    over_stated: Option<f64>,
    /// Texture coordinates of the worst texel, u right, v up.
    uv: [f64; 2],
    /// The texel's label, 0 for none.
    label: u8,
}

/// The texels of the truth that are compared.
pub(crate) struct Compared<'a> {
    truth: &'a Source,
    labels: Option<&'a GrayImage>,
    region: Region,
}

impl<'a> Compared<'a> {
    /// The truth's coverage, eroded as for scores.
    pub fn new(truth: &'a Source, labels: Option<&'a GrayImage>) -> Result<Self, MetricError> {
        let coverage = truth.coverage().unwrap_or_else(|| GrayImage::new(0, 0));
        let region = Region::eroded("coverage-e5", &coverage)?;
        Ok(Self { truth, labels, region })
    }

    /// The factor on a method's diffuse albedo that minimises its squared error; none if none does.
    pub fn factor(&self, method: &Maps) -> Option<f64> {
        let (found, truth) =
            (method.diffuse_albedo.as_ref()?, self.truth.maps.diffuse_albedo.as_ref()?);
        let found = resample(found, truth.width, truth.height);
        let pair = Pair::new(&found, truth, &self.region).ok()?;
        Scale::fit(&pair).ok().map(|scale| scale.global)
    }

    /// The errors of the maps that both have, of the albedo after its factor.
    pub fn errors(&self, method: &Source, factor: f64) -> Vec<TexelErrors> {
        let (found, truth) = (&method.maps, &self.truth.maps);
        let measured = [
            ("diffuse_albedo", &found.diffuse_albedo, &truth.diffuse_albedo),
            ("specular_albedo", &found.specular_albedo, &truth.specular_albedo),
            ("diffuse_normal", &found.diffuse_normal, &truth.diffuse_normal),
            ("specular_normal", &found.specular_normal, &truth.specular_normal),
        ];
        measured
            .into_iter()
            .filter_map(|(measure, found, truth)| {
                let (found, truth) = (found.as_ref()?, truth.as_ref()?);
                let found = resample(found, truth.width, truth.height);
                let stated = method.deviations.iter().find(|(name, _)| *name == measure);
                let stated = stated.map(|(_, map)| resample(map, truth.width, truth.height));
                let pixels = self.region.pixels();
                let error = |at: &usize| {
                    let at = (at % truth.width, at / truth.width);
                    error(measure, found.pixel(at.0, at.1), truth.pixel(at.0, at.1), factor)
                };
                let over = |stated: &Picture| {
                    let over = |at: &usize| {
                        let (x, y) = (at % truth.width, at / truth.width);
                        let (p, g) = (found.pixel(x, y), truth.pixel(x, y));
                        in_deviations(measure, p, g, stated.pixel(x, y))
                    };
                    pixels.iter().map(over).collect()
                };
                Some(TexelErrors {
                    measure,
                    values: pixels.iter().map(error).collect(),
                    over_stated: stated.as_ref().map(over),
                })
            })
            .collect()
    }

    /// The ten patches with the largest mean error, the worst first; no two touch.
    pub fn worst(&self, errors: &TexelErrors) -> Vec<Patch> {
        let (width, height) = self.region.size();
        let side = width.div_ceil(PATCHES).max(1);
        let across = width.div_ceil(side);
        let mut patches = vec![Gathered::default(); across * height.div_ceil(side)];
        for (i, block) in self.region.blocks(side).enumerate() {
            let stated = errors.over_stated.as_ref().map_or(0.0, |over| over[i]);
            patches[block].add(i, errors.values[i], stated);
        }
        let least = side * side / 2;
        let mut order: Vec<usize> =
            (0..patches.len()).filter(|i| patches[*i].count >= least).collect();
        let rank = |i: &usize| patches[*i].sum / patches[*i].count as f64;
        order.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
        let mut kept: Vec<usize> = Vec::new();
        for i in order {
            let apart = |other: &usize| {
                (i % across).abs_diff(other % across) > 1
                    || (i / across).abs_diff(other / across) > 1
            };
            if kept.len() < WORST && kept.iter().all(apart) {
                kept.push(i);
            }
        }
        let patch = |i: usize| {
            let found = &patches[i];
            let at = self.region.pixels()[found.worst.0];
            let (x, y) = ((at % width) as f64 + 0.5, (at / width) as f64 + 0.5);
            let label = self.labels.filter(|labels| labels.data.len() == width * height);
            Patch {
                measure: errors.measure,
                value: found.sum / found.count as f64,
                over_stated: errors.over_stated.as_ref().map(|_| found.over / found.count as f64),
                uv: [x / width as f64, 1.0 - y / height as f64],
                label: label.map_or(0, |labels| labels.data[at]),
            }
        };
        kept.into_iter().map(patch).collect()
    }
}

impl TexelErrors {
    /// The value below which 98 % of the errors lie.
    pub fn top(&self) -> f64 {
        top(self.values.clone())
    }
}

/// The value below which 98 % of the positive values of a map's channel lie.
pub(crate) fn top_of(map: &Picture, channel: usize) -> f64 {
    let values = map.data.iter().skip(channel).step_by(map.channels);
    top(values.filter(|value| **value > 0.0).map(|value| f64::from(*value)).collect())
}

/// The value below which 98 % of the values lie.
fn top(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values.get((SHARE * last as f64).round() as usize).copied().unwrap_or(0.0)
}

#[derive(Clone, Default)]
struct Gathered {
    count: usize,
    sum: f64,
    over: f64,
    /// Place in the region of the texel with the largest value, and the value.
    worst: (usize, f64),
}

impl Gathered {
    fn add(&mut self, i: usize, value: f64, over: f64) {
        if self.count == 0 || value > self.worst.1 {
            self.worst = (i, value);
        }
        self.count += 1;
        self.sum += value;
        self.over += over;
    }
}

fn triple(values: &[f32]) -> [f64; 3] {
    std::array::from_fn(|c| f64::from(values[c]))
}

/// CIEDE2000 of albedos, degrees between normals, the distance of reflectances.
fn error(measure: &str, found: &[f32], truth: &[f32], factor: f64) -> f64 {
    match measure {
        "diffuse_albedo" => {
            ciede2000(lab(triple(found).map(|value| value * factor)), lab(triple(truth)))
        }
        "specular_albedo" => f64::from((found[0] - truth[0]).abs()),
        _ => angle(found, truth).to_degrees(),
    }
}

/// The error of a map as it is, over its stated standard deviation: the root mean square over channels.
fn in_deviations(measure: &str, found: &[f32], truth: &[f32], stated: &[f32]) -> f64 {
    const LEAST: f64 = 1e-6;
    if measure.ends_with("normal") {
        return angle(found, truth) / f64::from(stated[0]).max(LEAST);
    }
    let each = found.iter().zip(truth).enumerate().map(|(c, (p, g))| {
        (f64::from(p - g) / f64::from(stated[c.min(stated.len() - 1)]).max(LEAST)).powi(2)
    });
    (each.sum::<f64>() / found.len() as f64).sqrt()
}

/// The angle between two vectors, radians; a right one where one of them has no length.
fn angle(found: &[f32], truth: &[f32]) -> f64 {
    let (a, b) = (triple(found), triple(truth));
    let (a, b) = (glam::DVec3::from_array(a), glam::DVec3::from_array(b));
    if a.length_squared() == 0.0 || b.length_squared() == 0.0 {
        return std::f64::consts::FRAC_PI_2;
    }
    a.cross(b).length().atan2(a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: f32) -> Source {
        let data = vec![value; 3 * 128 * 128];
        let picture = Picture { width: 128, height: 128, channels: 3, data };
        let maps = Maps { diffuse_albedo: Some(picture), ..Maps::default() };
        Source { maps, deviations: Vec::new(), light: None }
    }

    #[test]
    fn the_worst_patch_is_where_the_albedo_is_wrong_and_its_neighbours_are_left_out() {
        let truth = flat(0.5);
        let mut method = flat(0.25);
        let albedo = method.maps.diffuse_albedo.as_mut().unwrap();
        for y in 40..52 {
            for x in 80..92 {
                albedo.pixel_mut(x, y).copy_from_slice(&[0.9, 0.1, 0.1]);
            }
        }
        let compared = Compared::new(&truth, None).unwrap();
        let factor = compared.factor(&method.maps).unwrap();
        assert!((factor - 2.0).abs() < 0.2, "{factor}");
        let errors = compared.errors(&method, factor);
        let found = compared.worst(&errors[0]);
        assert_eq!(found.len(), WORST);
        let inside = |patch: &&Patch| {
            let [x, y] = [patch.uv[0] * 128.0, (1.0 - patch.uv[1]) * 128.0];
            (80.0..92.0).contains(&x) && (40.0..52.0).contains(&y)
        };
        assert!(inside(&&found[0]) && found[0].value > 20.0, "{:?}", found[0]);
        assert!(found.iter().filter(inside).count() <= 4, "patches of 4 texels do not touch");
        // 144 of 15,376 texels are less than two per cent: the scale is that of the rest.
        assert!(errors[0].top() < 10.0);
    }
}
