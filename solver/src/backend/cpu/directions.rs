//! Directions from deviations and the adjoint, as in [`crate::model::normals`], with the vectors of the passes.

use super::lanes::Lanes;
use crate::model::deviation_textures::BLURRED;
use crate::model::normals::{DIRECTIONS, DirectionScale};
use crate::model::planes::{BLOCK, Row};

/// Three rows at the same lanes.
type Vector<S> = [S; 3];

/// The inverse lengths of the bent normals, specular and diffuse.
pub type Lengths = [Row; 2];

#[inline(always)]
fn load<S: Lanes>(rows: &[Row], first: usize, at: usize) -> Vector<S> {
    [S::load(&rows[first], at), S::load(&rows[first + 1], at), S::load(&rows[first + 2], at)]
}

#[inline(always)]
fn store<S: Lanes>(vector: Vector<S>, rows: &mut [Row], first: usize, at: usize) {
    for (k, value) in vector.into_iter().enumerate() {
        value.store(&mut rows[first + k], at);
    }
}

#[inline(always)]
fn dot<S: Lanes>(a: Vector<S>, b: Vector<S>) -> S {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2].mul(b[2])))
}

#[inline(always)]
fn sum<S: Lanes>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0].add(b[0]), a[1].add(b[1]), a[2].add(b[2])]
}

#[inline(always)]
fn times<S: Lanes>(a: Vector<S>, factor: S) -> Vector<S> {
    [a[0].mul(factor), a[1].mul(factor), a[2].mul(factor)]
}

/// a x factor + b.
#[inline(always)]
fn times_plus<S: Lanes>(a: Vector<S>, factor: S, b: Vector<S>) -> Vector<S> {
    [a[0].mul_add(factor, b[0]), a[1].mul_add(factor, b[1]), a[2].mul_add(factor, b[2])]
}

/// The directions of a block's samples with the deviations d and blur(d).
#[inline(always)]
pub fn deviate<S: Lanes>(
    scale: &DirectionScale,
    [normal, view]: [&[Row]; 2],
    deviation: &[Row],
    lengths: &mut Lengths,
    out: &mut [Row; DIRECTIONS],
) {
    let zero = S::splat(0.0);
    let mut at = 0;
    while at < BLOCK {
        let (normal, view) = (load::<S>(normal, 0, at), load::<S>(view, 0, at));
        let specular = sum(normal, load(deviation, 0, at));
        let diffuse = sum(normal, load(deviation, BLURRED, at));
        let by_specular = dot(specular, specular).reciprocal_root();
        let by_diffuse = dot(diffuse, diffuse).reciprocal_root();
        by_specular.store(&mut lengths[0], at);
        by_diffuse.store(&mut lengths[1], at);
        let specular = times(specular, by_specular);
        let towards = dot(specular, view);
        let behind = times(view, zero.sub(S::splat(1.0)));
        let reflected = times_plus(specular, towards.add(towards), behind);
        store(times(diffuse, by_diffuse.mul(S::splat(scale.normal))), out, 0, at);
        store(times(reflected, S::splat(scale.reflection)), out, 3, at);
        at += S::WIDTH;
    }
}

/// The gradients with respect to both deviations, from those with respect to the directions (the first six rows of
/// `gradient`, times the diffuse and the specular row of `factors`).
#[inline(always)]
pub fn adjoint<S: Lanes>(
    scale: &DirectionScale,
    [normal, view]: [&[Row]; 2],
    deviation: &[Row],
    lengths: &Lengths,
    gradient: &[Row],
    [to_diffuse, to_specular]: &[Row; 2],
    out: &mut [Row],
) {
    let mut at = 0;
    while at < BLOCK {
        let (normal, view) = (load::<S>(normal, 0, at), load::<S>(view, 0, at));
        let [by_specular, by_diffuse] = [S::load(&lengths[0], at), S::load(&lengths[1], at)];
        let specular = times(sum(normal, load(deviation, 0, at)), by_specular);
        let diffuse = times(sum(normal, load(deviation, BLURRED, at)), by_diffuse);
        let factor = S::load(to_specular, at).mul(S::splat(2.0 * scale.reflection));
        let twice = times(load(gradient, 3, at), factor);
        let by_normal = times_plus(view, dot(specular, twice), times(twice, dot(specular, view)));
        store(across(specular, by_normal, by_specular), out, 0, at);
        let factor = S::load(to_diffuse, at).mul(S::splat(scale.normal));
        let by_normal = times(load(gradient, 0, at), factor);
        store(across(diffuse, by_normal, by_diffuse), out, BLURRED, at);
        at += S::WIDTH;
    }
}

/// The component of a gradient orthogonal to a unit vector, over the vector's length before normalisation.
#[inline(always)]
fn across<S: Lanes>(unit: Vector<S>, gradient: Vector<S>, over_length: S) -> Vector<S> {
    let along = S::splat(0.0).sub(dot(unit, gradient));
    times(times_plus(unit, along, gradient), over_length)
}
