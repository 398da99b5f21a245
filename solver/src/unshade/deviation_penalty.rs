//! The penalties on the deviation in the height problem.

use rayon::prelude::*;

use crate::simd::widened;

/// Returns `flatness` d + `smoothness` D^T D d, with the deviation d and its forward differences D d.
pub(super) fn deviation_penalty(
    deviation: &[f32],
    size: usize,
    flatness: f32,
    smoothness: f32,
) -> Vec<f32> {
    let line = 3 * size;
    let row = |y: usize| &deviation[y * line..][..line];
    let mut out = vec![0.0; deviation.len()];
    out.par_chunks_mut(line).enumerate().for_each(|(y, out)| {
        let here = row(y);
        scaled(out, here, flatness);
        let mut pull = |to: std::ops::Range<usize>, neighbour: &[f32]| {
            add_difference(&mut out[to.clone()], &here[to], neighbour, smoothness);
        };
        pull(3..line, here);
        pull(0..line - 3, &here[3..]);
        if y > 0 {
            pull(0..line, row(y - 1));
        }
        if y + 1 < size {
            pull(0..line, row(y + 1));
        }
    });
    out
}

widened! {
    fn scaled(out: &mut [f32], values: &[f32], factor: f32) {
        for (out, value) in out.iter_mut().zip(values) {
            *out = factor * value;
        }
    }
}

widened! {
    fn add_difference(sum: &mut [f32], a: &[f32], b: &[f32], factor: f32) {
        for (sum, (a, b)) in sum.iter_mut().zip(a.iter().zip(b)) {
            *sum += factor * (a - b);
        }
    }
}
