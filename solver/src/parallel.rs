//! Vectors that all threads make together.

use std::mem::MaybeUninit;

use rayon::prelude::*;

/// `count` values in parts of `part`, which `fill(number of the part, values)` finds zero; and its
/// results, in order. A part is cleared by the thread that fills it, in its cache: a vector of zeros
/// would be cleared by one thread, through memory.
pub fn from_parts<T: Send>(
    count: usize,
    part: usize,
    fill: impl Fn(usize, &mut [f32]) -> T + Sync,
) -> (Vec<f32>, Vec<T>) {
    let mut values = Vec::with_capacity(count);
    let task = |(number, part): (usize, &mut [MaybeUninit<f32>])| {
        part.iter_mut().for_each(|value| _ = value.write(0.0));
        let (start, length) = (part.as_mut_ptr().cast::<f32>(), part.len());
        // SAFETY: all of the part was just written, and nothing else refers to it meanwhile.
        fill(number, unsafe { std::slice::from_raw_parts_mut(start, length) })
    };
    let parts = values.spare_capacity_mut()[..count].par_chunks_mut(part.max(1));
    let results = parts.enumerate().map(task).collect();
    // SAFETY: the tasks have written every one of the values.
    unsafe { values.set_len(count) };
    (values, results)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_zero_at_first_and_come_in_order() {
        let fill = |number: usize, part: &mut [f32]| {
            assert!(part.iter().all(|value| *value == 0.0));
            part.fill(number as f32);
            part.len()
        };
        let (values, lengths) = from_parts(7, 3, fill);
        assert_eq!(values, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0]);
        assert_eq!(lengths, [3, 3, 1]);
        assert!(from_parts(0, 0, |_, _| ()).0.is_empty());
    }
}
