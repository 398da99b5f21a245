//! Rows of texels at half their width and back. Four texels are one vector of AVX-512, which the compiler does
//! not make of loops over texels; what it makes of them is three times slower. Results are the same bits.

use super::halving::{CHANNELS, FAR, NEAR, Texel};
use crate::simd::widened;

/// Weighted means of four texels, of which two are in the next one too. The line begins a texel before the first
/// two that become one.
pub(super) fn halve_row(out: &mut [Texel], line: &[Texel]) {
    let done = wide::halve(out, line);
    halve(&mut out[done..], &line[2 * done..]);
}

/// The transpose: interpolates pairs of texels of a line which begins a texel before that of the first pair.
pub(super) fn double_row(out: &mut [Texel], line: &[Texel]) {
    let done = wide::double(out, line);
    double(&mut out[done..], &line[done / 2..]);
}

widened! {
    fn halve(out: &mut [Texel], line: &[Texel]) {
        for (k, out) in out.iter_mut().enumerate() {
            let Some([a, b, c, d]) = line[2 * k..].first_chunk() else { return };
            for k in 0..CHANNELS {
                out[k] = FAR * (a[k] + d[k]) + NEAR * (b[k] + c[k]);
            }
        }
    }
}

widened! {
    fn double(out: &mut [Texel], line: &[Texel]) {
        for (k, out) in out.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let Some([a, b, c]) = line[k..].first_chunk() else { return };
            for k in 0..CHANNELS {
                out[0][k] = FAR * a[k] + NEAR * b[k];
                out[1][k] = NEAR * b[k] + FAR * c[k];
            }
        }
    }
}

/// As many texels as AVX-512 does, and their number.
#[cfg(target_arch = "x86_64")]
mod wide {
    use std::arch::x86_64::*;

    use super::{FAR, NEAR, Texel};
    use crate::simd::has_avx512;

    const QUAD: usize = 4;

    pub fn halve(out: &mut [Texel], line: &[Texel]) -> usize {
        #[target_feature(enable = "avx512f")]
        fn quads(out: &mut [[Texel; QUAD]], line: &[Texel]) {
            for (k, out) in out.iter_mut().enumerate() {
                // From every second texel on, beginning with the first and with the third.
                let Some(texels) = line[2 * QUAD * k..].first_chunk::<{ 2 * QUAD + 2 }>() else {
                    return;
                };
                let [first, third] = [0, 2].map(|at| {
                    let [low, high] =
                        [at, at + QUAD].map(|at| load(texels[at..].first_chunk().unwrap()));
                    [
                        _mm512_shuffle_f32x4::<0b10_00_10_00>(low, high),
                        _mm512_shuffle_f32x4::<0b11_01_11_01>(low, high),
                    ]
                });
                let (far, near) =
                    (_mm512_add_ps(first[0], third[1]), _mm512_add_ps(first[1], third[0]));
                store(out, mean(far, near));
            }
        }
        // SAFETY: AVX-512 was just found.
        run(out, |out| unsafe { quads(out, line) })
    }

    pub fn double(out: &mut [Texel], line: &[Texel]) -> usize {
        #[target_feature(enable = "avx512f")]
        fn quads(out: &mut [[Texel; QUAD]], line: &[Texel]) {
            for (k, out) in out.iter_mut().enumerate() {
                let Some(texels) = line[QUAD / 2 * k..].first_chunk() else { return };
                let texels = load(texels);
                let near = _mm512_shuffle_f32x4::<0b10_10_01_01>(texels, texels);
                let far = _mm512_shuffle_f32x4::<0b11_01_10_00>(texels, texels);
                store(out, mean(far, near));
            }
        }
        // SAFETY: AVX-512 was just found.
        run(out, |out| unsafe { quads(out, line) })
    }

    fn run(out: &mut [Texel], quads: impl FnOnce(&mut [[Texel; QUAD]])) -> usize {
        if !has_avx512() {
            return 0;
        }
        let out = out.as_chunks_mut().0;
        quads(out);
        QUAD * out.len()
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn mean(far: __m512, near: __m512) -> __m512 {
        _mm512_add_ps(
            _mm512_mul_ps(_mm512_set1_ps(FAR), far),
            _mm512_mul_ps(_mm512_set1_ps(NEAR), near),
        )
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn load(texels: &[Texel; QUAD]) -> __m512 {
        // SAFETY: it reads the sixteen floats of the array, wherever they lie.
        unsafe { _mm512_loadu_ps(texels.as_ptr().cast()) }
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn store(texels: &mut [Texel; QUAD], values: __m512) {
        // SAFETY: it writes the sixteen floats of the array, wherever they lie.
        unsafe { _mm512_storeu_ps(texels.as_mut_ptr().cast(), values) }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod wide {
    use super::Texel;

    pub fn halve(_: &mut [Texel], _: &[Texel]) -> usize {
        0
    }

    pub fn double(_: &mut [Texel], _: &[Texel]) -> usize {
        0
    }
}
