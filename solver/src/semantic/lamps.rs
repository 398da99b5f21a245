//! One lamp with uniform ambient light, which fits pictures with a flash by fewer unknowns than a sky.

use capture::Mesh;
use capture::gbuffer::Atlas;
use capture::rays::Occluder;
use glam::Vec3;
use rayon::prelude::*;

use super::chart::{Chart, luminance};
use super::settings::HairSettings;
use crate::transport::{RAY_OFFSET, Sky};

/// Rows of the sky whose cells are the first candidate directions.
const ROWS: usize = 8;
/// Candidate directions along each axis around the best of these.
const AROUND: usize = 5;
/// Rounds of weights towards L1, and of the skin's two reflectances.
const ROUNDS: [usize; 2] = [6, 3];
/// Residual, relative to the median, below which weights are constant.
const FLOOR: f32 = 0.1;
/// Shading, relative to the median, below which a texel carries no information on its reflectance.
const SHADED: f32 = 0.1;

/// Lamps next to the one with the least residual on skin.
pub(super) struct Lamps {
    /// The direct shading of the visible texels, lamp by lamp.
    direct: Vec<Vec<f32>>,
    /// The shading of ambient light of radiance 1.
    ambient: Vec<f32>,
    /// The skin that the best lamp lights.
    pub lit: Vec<bool>,
}

/// The fitted radiances of a lamp and of ambient light in one channel.
#[derive(Clone, Copy)]
struct LampFit {
    light: [f32; 2],
    /// The reflectance of the second part over that of the first.
    ratio: f32,
    /// The mean relative difference, at most 1 per texel.
    residual: f32,
}

impl Lamps {
    /// Fits the lamps to skin; `None` if ambient light alone has as small a residual.
    pub fn new(
        mesh: &Mesh,
        chart: &Chart,
        config: &HairSettings,
        is_skin: &[bool],
    ) -> Option<Self> {
        let lit_mesh = LitMesh::new(mesh, chart);
        let skin = Part::new(is_skin, chart, |_| false);
        let ambient = chart.uniform_shading();
        let best = |directions: &[Vec3]| {
            let lamps: Vec<(Vec3, f32)> = directions
                .iter()
                .flat_map(|direction| config.lamp_nearness.map(|nearness| (*direction, nearness)))
                .collect();
            let residual = |lamp: &(Vec3, f32)| {
                let direct = lit_mesh.direct(lamp.0, lamp.1);
                skin.fit(&skin.of(&direct), &skin.of(&ambient), &skin.luminance).residual
            };
            let residuals: Vec<f32> = lamps.par_iter().map(residual).collect();
            least(&residuals).map(|at| (lamps[at], lamps))
        };
        let ((first, _), _) = best(&Sky::lat_long(ROWS).centres())?;
        let ((direction, nearness), lamps) = best(&around(first))?;
        let direct: Vec<Vec<f32>> =
            lamps.par_iter().map(|lamp| lit_mesh.direct(lamp.0, lamp.1)).collect();
        let found = lit_mesh.direct(direction, nearness);
        if skin.fit(&skin.of(&found), &skin.of(&ambient), &skin.luminance).light[0] <= 0.0 {
            return None;
        }
        let mut sorted = skin.of(&found);
        sorted.sort_by(f32::total_cmp);
        let least = config.lit * sorted.get(sorted.len() * 19 / 20)?;
        let lit = found.iter().zip(is_skin).map(|(light, skin)| *skin && *light > least).collect();
        Some(Self { direct, ambient, lit })
    }

    /// The colours divided by the shading of the lamp with the least residual on the `counted` texels, with one
    /// reflectance for the `second` part and another for the rest.
    pub fn albedo(&self, chart: &Chart, counted: &[bool], second: &[bool]) -> Vec<Vec3> {
        let part = Part::new(counted, chart, |at| second[at]);
        let ambient = part.of(&self.ambient);
        let residual =
            |direct: &Vec<f32>| part.fit(&part.of(direct), &ambient, &part.luminance).residual;
        let residuals: Vec<f32> = self.direct.par_iter().map(residual).collect();
        let Some(best) = least(&residuals) else { return chart.colours.clone() };
        let direct = &self.direct[best];
        let light: [[f32; 2]; 3] = std::array::from_fn(|channel| {
            let wanted: Vec<f32> =
                part.texels.iter().map(|at| chart.colours[*at][channel]).collect();
            part.fit(&part.of(direct), &ambient, &wanted).light
        });
        let shading = direct.iter().zip(&self.ambient).map(|(direct, ambient)| {
            Vec3::from_array(light.map(|light| light[0] * direct + light[1] * ambient))
        });
        chart.divided(&shading.map(|s| s.max(Vec3::splat(f32::MIN_POSITIVE))).collect::<Vec<_>>())
    }
}

/// The texels of a fit.
struct Part {
    texels: Vec<usize>,
    /// Whether each has the second reflectance.
    second: Vec<bool>,
    luminance: Vec<f32>,
}

impl Part {
    fn new(counted: &[bool], chart: &Chart, second: impl Fn(usize) -> bool) -> Self {
        let texels: Vec<usize> = (0..counted.len()).filter(|at| counted[*at]).collect();
        let luminance = texels.iter().map(|at| luminance(&chart.colours[*at])).collect();
        Self { second: texels.iter().map(|at| second(*at)).collect(), texels, luminance }
    }

    fn of(&self, values: &[f32]) -> Vec<f32> {
        self.texels.iter().map(|at| values[*at]).collect()
    }

    fn fit(&self, direct: &[f32], ambient: &[f32], wanted: &[f32]) -> LampFit {
        let two = self.second.contains(&true);
        let mut fit = LampFit { light: [0.0; 2], ratio: 1.0, residual: f32::INFINITY };
        for _ in 0..if two { ROUNDS[1] } else { 1 } {
            let own = |second: &bool| if *second { fit.ratio } else { 1.0 };
            let bare: Vec<f32> = wanted.iter().zip(&self.second).map(|(w, s)| w / own(s)).collect();
            fit.light = least_absolute(direct, ambient, &bare);
            let [lamp, ambient_light] = fit.light;
            let shading: Vec<f32> =
                direct.iter().zip(ambient).map(|(d, e)| lamp * d + ambient_light * e).collect();
            let shaded = SHADED * median(shading.clone());
            let reflectance = |of: bool| {
                let lit =
                    (0..wanted.len()).filter(|i| self.second[*i] == of && shading[*i] > shaded);
                median(lit.map(|i| wanted[i] / shading[i]).collect())
            };
            let first = reflectance(false);
            if two {
                fit.ratio = (reflectance(true) / first).clamp(0.01, 100.0);
            }
            let explained =
                |i: usize| first * shading[i] * if self.second[i] { fit.ratio } else { 1.0 };
            let residual = |i: usize| (wanted[i] / explained(i) - 1.0).abs().min(1.0);
            fit.residual =
                (0..wanted.len()).map(residual).sum::<f32>() / wanted.len().max(1) as f32;
        }
        fit
    }
}

/// The visible texels and their occluder.
struct LitMesh {
    occluder: Occluder,
    /// The positions of the visible texels from the head's centre, metres.
    places: Vec<Vec3>,
    normals: Vec<Vec3>,
    centre: Vec3,
    lift: f32,
}

impl LitMesh {
    fn new(mesh: &Mesh, chart: &Chart) -> Self {
        let atlas = Atlas::new(mesh, chart.side);
        let (low, high) = mesh.bounds();
        let centre = 0.5 * (low + high);
        Self {
            occluder: Occluder::new(mesh),
            places: chart.seen.iter().map(|at| atlas.positions[*at] - centre).collect(),
            normals: chart.seen.iter().map(|at| atlas.normals[*at]).collect(),
            centre,
            lift: RAY_OFFSET * (high - low).max_element(),
        }
    }

    /// The direct shading by a lamp in a direction at a nearness per metre, which faces the head's centre: 1 for a
    /// texel at the centre that faces the lamp.
    fn direct(&self, direction: Vec3, nearness: f32) -> Vec<f32> {
        let texel = |(place, normal): (&Vec3, &Vec3)| {
            let towards = direction - nearness * *place;
            let (cosine, origin) =
                (normal.dot(towards), self.centre + *place + self.lift * *normal);
            match cosine > 0.0 && self.occluder.first_hit(origin, towards.normalize()).is_none() {
                true => {
                    (1.0 - nearness * direction.dot(*place)) * cosine
                        / towards.length_squared().powi(2)
                }
                false => 0.0,
            }
        };
        self.places.iter().zip(&self.normals).map(texel).collect()
    }
}

/// Directions around one, spaced by a quarter of a row of the first directions.
fn around(direction: Vec3) -> Vec<Vec3> {
    let step = std::f32::consts::PI / (2 * ROWS * (AROUND / 2)) as f32;
    let (across, up) = direction.any_orthonormal_pair();
    let offset = |i: usize| (step * (i as f32 - (AROUND / 2) as f32)).tan();
    let one = |i: usize| direction + offset(i / AROUND) * across + offset(i % AROUND) * up;
    (0..AROUND * AROUND).map(|i| one(i).normalize()).collect()
}

/// The non-negative factors of two shadings with the least absolute difference, by reweighted least squares.
fn least_absolute(direct: &[f32], ambient: &[f32], wanted: &[f32]) -> [f32; 2] {
    let floor = FLOOR * median(wanted.to_vec());
    let mut light = [0.0; 2];
    let mut weights = vec![1.0_f32; wanted.len()];
    for _ in 0..ROUNDS[0] {
        let mut sums = [0.0_f64; 5];
        for (((d, e), w), weight) in direct.iter().zip(ambient).zip(wanted).zip(&weights) {
            let [d, e, w, weight] = [*d, *e, *w, *weight].map(f64::from);
            let products = [d * d, d * e, e * e, d * w, e * w];
            sums.iter_mut().zip(products).for_each(|(sum, product)| *sum += weight * product);
        }
        let [dd, de, ee, dw, ew] = sums;
        let determinant = dd * ee - de * de;
        let both = [(ee * dw - de * ew) / determinant, (dd * ew - de * dw) / determinant];
        let found = match both {
            [lamp, ambient_light] if lamp >= 0.0 && ambient_light >= 0.0 => both,
            [_, ambient_light] if ambient_light < 0.0 && dd > 0.0 => [dw / dd, 0.0],
            _ if ee > 0.0 => [0.0, ew / ee],
            _ => [0.0; 2],
        };
        light = found.map(|x| x as f32);
        let residual = |((d, e), w): ((&f32, &f32), &f32)| (w - light[0] * d - light[1] * e).abs();
        let residuals = direct.iter().zip(ambient).zip(wanted).map(residual);
        weights =
            residuals.map(|residual| (residual + floor).max(f32::MIN_POSITIVE).recip()).collect();
    }
    light
}

/// The index of the least value, the first of equal ones; `None` without values.
fn least(values: &[f32]) -> Option<usize> {
    (0..values.len()).min_by(|a, b| values[*a].total_cmp(&values[*b]))
}

/// The upper median; 0 without values.
fn median(mut values: Vec<f32>) -> f32 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}

#[cfg(test)]
pub(super) mod testing {
    use glam::Vec3;

    /// The shading by one lamp 2.5 m from the dome's centre, at its side, with uniform ambient light: half of the dome
    /// is in the dark.
    pub fn lamp(p: Vec3) -> f32 {
        let (direction, place) = (Vec3::new(0.8, 0.3, 0.5).normalize(), p - 0.6 * Vec3::Z);
        let towards = direction - 0.4 * place;
        let facing = 1.0 - 0.4 * direction.dot(place);
        0.05 + facing * p.dot(towards).max(0.0) / towards.length_squared().powi(2)
    }
}
