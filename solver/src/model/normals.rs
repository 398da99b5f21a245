//! Directions of the kernels from deviations, and the adjoint (section 4.3.2).
//!
//! n_s = normalize(n + d), r = 2 (n_s.v) n_s - v; n_d = normalize(n + blur(d)).

use glam::Vec3;

use super::planes::{BLOCK, Planes, Row, first_rows, first_rows_mut};
use super::samples::Samples;
use crate::config::NetworkConfig;
use crate::simd::widened;

/// Rows of the directions: scaled diffuse normal, then scaled reflected direction.
pub const DIRECTIONS: usize = 6;

/// Scales of the two directional inputs.
#[derive(Clone, Copy, Debug)]
pub struct DirectionScale {
    /// Scale of the diffuse normal.
    pub normal: f32,
    /// Scale of the reflected direction.
    pub reflection: f32,
}

impl From<&NetworkConfig> for DirectionScale {
    fn from(config: &NetworkConfig) -> Self {
        Self { normal: config.normal_scale, reflection: config.reflection_scale }
    }
}

impl DirectionScale {
    /// Directions of every sample ([`DIRECTIONS`] rows); without deviations, the mesh normal serves for both.
    pub fn directions(&self, samples: &Samples, deviations: Option<Deviations>) -> Planes {
        Planes::from_blocks(DIRECTIONS, samples.len(), |block, out| {
            let [sharp, blurred] = deviations.map_or([&STILL, &STILL], |d| d.block(block));
            let (normal, view) = (samples.normal.block(block), samples.view.block(block));
            deviate(self, normal, view, sharp, blurred, out);
        })
    }

    /// The adjoint of [`Self::directions`]: gradients with respect to d (3 rows) and blur(d) (3 rows), from those with
    /// respect to the directions (the first six rows of `gradient`).
    pub fn adjoint(&self, samples: &Samples, deviations: Deviations, gradient: &Planes) -> Planes {
        Planes::from_blocks(DIRECTIONS, samples.len(), |block, out| {
            let [sharp, blurred] = deviations.block(block);
            let (normal, view) = (samples.normal.block(block), samples.view.block(block));
            bend_adjoint(self, normal, view, sharp, blurred, gradient.block(block), out);
        })
    }
}

/// Sampled deviations among other rows.
#[derive(Clone, Copy)]
pub struct Deviations<'a> {
    /// The rows, those of d first.
    pub planes: &'a Planes,
    /// The first row of blur(d).
    pub blurred: usize,
}

impl<'a> Deviations<'a> {
    /// d and blur(d) of a block's samples.
    fn block(self, block: usize) -> [&'a [Row; 3]; 2] {
        let rows = self.planes.block(block);
        [first_rows(rows), first_rows(&rows[self.blurred..])]
    }
}

/// No deviation.
static STILL: [Row; 3] = [Row::ZERO; 3];

widened! {
    fn deviate(
        scale: &DirectionScale,
        normal: &[Row],
        view: &[Row],
        sharp: &[Row; 3],
        blurred: &[Row; 3],
        out: &mut [Row],
    ) {
        let (normal, view) = (first_rows::<3>(normal), first_rows::<3>(view));
        let out = first_rows_mut::<DIRECTIONS>(out);
        for lane in 0..BLOCK {
            let (normal, view) = (vector(normal, 0, lane), vector(view, 0, lane));
            let specular = (normal + vector(sharp, 0, lane)).normalize();
            let reflected = 2.0 * specular.dot(view) * specular - view;
            let diffuse = (normal + vector(blurred, 0, lane)).normalize() * scale.normal;
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
        sharp: &[Row; 3],
        blurred: &[Row; 3],
        gradient: &[Row],
        out: &mut [Row],
    ) {
        let (normal, view) = (first_rows::<3>(normal), first_rows::<3>(view));
        let (gradient, out) = (first_rows::<DIRECTIONS>(gradient), first_rows_mut::<DIRECTIONS>(out));
        for lane in 0..BLOCK {
            let (normal, view) = (vector(normal, 0, lane), vector(view, 0, lane));
            let bent = normal + vector(sharp, 0, lane);
            let specular = bent.normalize();
            let g = vector(gradient, 3, lane) * scale.reflection;
            let by_specular = 2.0 * (specular.dot(g) * view + specular.dot(view) * g);
            let by_d = normalize_adjoint(bent, by_specular);
            let by_diffuse = vector(gradient, 0, lane) * scale.normal;
            let by_b = normalize_adjoint(normal + vector(blurred, 0, lane), by_diffuse);
            store(out, 0, lane, by_d);
            store(out, 3, lane, by_b);
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
