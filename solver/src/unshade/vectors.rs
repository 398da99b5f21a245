//! Sums and products of long vectors, for conjugate gradients.

use rayon::prelude::*;

use crate::simd::widened;

/// Values per task.
const CHUNK: usize = 1 << 14;

/// `sum` += `values`.
pub(super) fn add(sum: &mut [f32], values: &[f32]) {
    add_scaled(sum, values, 1.0);
}

/// `sum` += `factor` x `values`.
pub(super) fn add_scaled(sum: &mut [f32], values: &[f32], factor: f32) {
    let values = values.par_chunks(CHUNK);
    sum.par_chunks_mut(CHUNK).zip(values).for_each(|(sum, values)| {
        add_scaled_part(sum, values, factor);
    });
}

widened! {
    fn add_scaled_part(sum: &mut [f32], values: &[f32], factor: f32) {
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum += factor * value;
        }
    }
}

/// The inner product, in f64 and in fixed chunks, so that the result does not depend on the number of threads.
pub(super) fn dot(a: &[f32], b: &[f32]) -> f64 {
    let parts: Vec<f64> =
        a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(|(a, b)| dot_part(a, b)).collect();
    parts.iter().sum()
}

widened! {
    fn dot_part(a: &[f32], b: &[f32]) -> f64 {
        let mut lanes = [0.0f64; 8];
        let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
        for (a, b) in a.iter().zip(b) {
            for lane in 0..8 {
                lanes[lane] += f64::from(a[lane]) * f64::from(b[lane]);
            }
        }
        let rest = a_rest.iter().zip(b_rest).map(|(a, b)| f64::from(*a) * f64::from(*b));
        lanes.iter().sum::<f64>() + rest.sum::<f64>()
    }
}
