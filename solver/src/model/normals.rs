//! From deviations to the directions that the kernels see, and back (section 4.3.2).
//!
//! n_s = normalize(n + d), r = 2 (n_s.v) n_s - v; n_d = normalize(n + blur(d)).

use glam::Vec3;

use super::bend::{BLURRED, ROWS};
use super::planes::{BLOCK, Planes, Row, first_rows, first_rows_mut};
use super::samples::Samples;
use crate::config::NetworkConfig;
use crate::simd::widened;

/// Rows of the directions: scaled diffuse normal, then scaled reflected direction.
pub const DIRECTIONS: usize = 6;

/// Scales of the two directional inputs.
#[derive(Clone, Copy, Debug)]
pub struct DirectionScale {
    /// On the diffuse normal.
    pub normal: f32,
    /// On the reflected direction.
    pub reflection: f32,
}

impl From<&NetworkConfig> for DirectionScale {
    fn from(config: &NetworkConfig) -> Self {
        Self { normal: config.normal_scale, reflection: config.reflection_scale }
    }
}

impl DirectionScale {
    /// Directions of every sample. `deviation` has the rows of [`BentTextures::sample`](super::bend::BentTextures);
    /// without it, the mesh normal serves for both.
    pub fn directions(&self, samples: &Samples, deviation: Option<&Planes>) -> Planes {
        Planes::from_blocks(DIRECTIONS, samples.len(), |block, out| {
            let deviation = deviation.map_or(&STILL[..], |planes| planes.block(block));
            let (normal, view) = (samples.normal.block(block), samples.view.block(block));
            bend(self, normal, view, deviation, out);
        })
    }

    /// Carries gradients of the directions (the first six rows of `gradient`) to the deviation and
    /// its blur; the rows between them stay zero.
    pub fn adjoint(&self, samples: &Samples, deviation: &Planes, gradient: &Planes) -> Planes {
        Planes::from_blocks(ROWS, samples.len(), |block, out| {
            let (normal, view) = (samples.normal.block(block), samples.view.block(block));
            bend_adjoint(self, normal, view, deviation.block(block), gradient.block(block), out);
        })
    }
}

/// No deviation.
static STILL: [Row; ROWS] = [Row::ZERO; ROWS];

widened! {
    fn bend(scale: &DirectionScale, normal: &[Row], view: &[Row], deviation: &[Row], out: &mut [Row]) {
        let (normal, view) = (first_rows::<3>(normal), first_rows::<3>(view));
        let (deviation, out) = (first_rows::<ROWS>(deviation), first_rows_mut::<DIRECTIONS>(out));
        for lane in 0..BLOCK {
            let (normal, view) = (vector(normal, 0, lane), vector(view, 0, lane));
            let specular = (normal + vector(deviation, 0, lane)).normalize();
            let reflected = 2.0 * specular.dot(view) * specular - view;
            let diffuse = (normal + vector(deviation, BLURRED, lane)).normalize() * scale.normal;
            store(out, 0, lane, diffuse);
            store(out, 3, lane, reflected * scale.reflection);
        }
    }
}

widened! {
    fn bend_adjoint(
        scale: &DirectionScale,
        normal: &[Row],
        view: &[Row],
        deviation: &[Row],
        gradient: &[Row],
        out: &mut [Row],
    ) {
        let (normal, view) = (first_rows::<3>(normal), first_rows::<3>(view));
        let (deviation, gradient) = (first_rows::<ROWS>(deviation), first_rows::<DIRECTIONS>(gradient));
        let out = first_rows_mut::<ROWS>(out);
        for lane in 0..BLOCK {
            let (normal, view) = (vector(normal, 0, lane), vector(view, 0, lane));
            let bent = normal + vector(deviation, 0, lane);
            let specular = bent.normalize();
            let g = vector(gradient, 3, lane) * scale.reflection;
            let by_specular = 2.0 * (specular.dot(g) * view + specular.dot(view) * g);
            let by_d = normalize_adjoint(bent, by_specular);
            let by_diffuse = vector(gradient, 0, lane) * scale.normal;
            let by_b = normalize_adjoint(normal + vector(deviation, BLURRED, lane), by_diffuse);
            store(out, 0, lane, by_d);
            store(out, BLURRED, lane, by_b);
        }
    }
}

#[inline(always)]
fn vector<const R: usize>(rows: &[Row; R], first: usize, lane: usize) -> Vec3 {
    Vec3::new(rows[first].0[lane], rows[first + 1].0[lane], rows[first + 2].0[lane])
}

#[inline(always)]
fn store<const R: usize>(rows: &mut [Row; R], first: usize, lane: usize, vector: Vec3) {
    for (row, value) in rows[first..].iter_mut().zip(vector.to_array()) {
        row.0[lane] = value;
    }
}

#[inline(always)]
fn normalize_adjoint(vector: Vec3, gradient: Vec3) -> Vec3 {
    let length = vector.length();
    let unit = vector / length;
    (gradient - unit * unit.dot(gradient)) / length
}
