//! Rows of texels at half their width and back. Two texels are one vector of AVX2, which the compiler does not
//! make of loops over texels: what it makes of them is three to five times slower. Results are the same bits.

use super::halving::{CHANNELS, FAR, NEAR, Texel};

/// Weighted means of four texels, of which two are in the next one too. The line begins a texel before the first
/// two that become one.
pub(super) fn halve_row(out: &mut [Texel], line: &[Texel]) {
    let done = wide::halve(out, line);
    for (k, out) in out.iter_mut().enumerate().skip(done) {
        let Some([a, b, c, d]) = line[2 * k..].first_chunk() else { return };
        for k in 0..CHANNELS {
            out[k] = FAR * (a[k] + d[k]) + NEAR * (b[k] + c[k]);
        }
    }
}

/// The transpose: interpolates pairs of texels of a line which begins a texel before that of the first pair.
pub(super) fn double_row(out: &mut [Texel], line: &[Texel]) {
    if wide::double(out, line) {
        return;
    }
    for (k, out) in out.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let Some([a, b, c]) = line[k..].first_chunk() else { return };
        for k in 0..CHANNELS {
            out[0][k] = FAR * a[k] + NEAR * b[k];
            out[1][k] = NEAR * b[k] + FAR * c[k];
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod wide {
    use std::arch::x86_64::*;

    use super::{FAR, NEAR, Texel};
    use crate::simd::has_avx2;

    type Pair = [Texel; 2];

    /// As many as there are in pairs, and if there is AVX2; how many.
    pub fn halve(out: &mut [Texel], line: &[Texel]) -> usize {
        #[target_feature(enable = "avx2")]
        fn pairs(out: &mut [Pair], line: &[Texel]) {
            for (k, out) in out.iter_mut().enumerate() {
                let Some([a, b, c, d, e, f]) = line[4 * k..].first_chunk() else { return };
                let [ab, cd, ef] = [pair(a, b), pair(c, d), pair(e, f)];
                let far = _mm256_add_ps(
                    _mm256_permute2f128_ps::<0x20>(ab, cd),
                    _mm256_permute2f128_ps::<0x31>(cd, ef),
                );
                let near = _mm256_add_ps(
                    _mm256_permute2f128_ps::<0x31>(ab, cd),
                    _mm256_permute2f128_ps::<0x20>(cd, ef),
                );
                store(out, mean(far, near));
            }
        }
        if !has_avx2() {
            return 0;
        }
        let out = out.as_chunks_mut().0;
        // SAFETY: AVX2 was just found.
        unsafe { pairs(out, line) };
        2 * out.len()
    }

    /// If there is AVX2.
    pub fn double(out: &mut [Texel], line: &[Texel]) -> bool {
        #[target_feature(enable = "avx2")]
        fn pairs(out: &mut [Pair], line: &[Texel]) {
            for (k, out) in out.iter_mut().enumerate() {
                let Some([a, b, c]) = line[k..].first_chunk() else { return };
                store(out, mean(pair(a, c), pair(b, b)));
            }
        }
        let found = has_avx2();
        if found {
            // SAFETY: AVX2 was just found.
            unsafe { pairs(out.as_chunks_mut().0, line) };
        }
        found
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn mean(far: __m256, near: __m256) -> __m256 {
        let (far, near) =
            (_mm256_mul_ps(_mm256_set1_ps(FAR), far), _mm256_mul_ps(_mm256_set1_ps(NEAR), near));
        _mm256_add_ps(far, near)
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn pair(a: &Texel, b: &Texel) -> __m256 {
        // SAFETY: it reads the four floats of each array, wherever they lie.
        unsafe { _mm256_loadu2_m128(b.as_ptr(), a.as_ptr()) }
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn store(texels: &mut Pair, values: __m256) {
        // SAFETY: it writes the eight floats of the array, wherever they lie.
        unsafe { _mm256_storeu_ps(texels.as_mut_ptr().cast(), values) }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod wide {
    use super::Texel;

    pub fn halve(_: &mut [Texel], _: &[Texel]) -> usize {
        0
    }

    pub fn double(_: &mut [Texel], _: &[Texel]) -> bool {
        false
    }
}
