//! Vectors of x86-64.

use std::arch::x86_64::*;

use super::intrinsics::{check, memory, values};
use super::{Lanes, Row, Task};

/// 16 lanes; AVX-512 F.
#[derive(Clone, Copy)]
pub struct Avx512(__m512);

/// 8 lanes; AVX2 and FMA.
#[derive(Clone, Copy)]
pub struct Avx2(__m256);

/// Both halves added.
#[inline]
#[target_feature(enable = "avx2")]
fn four(halves: __m256) -> [f32; 4] {
    let sums = _mm_add_ps(_mm256_castps256_ps128(halves), _mm256_extractf128_ps::<1>(halves));
    let mut out = [0.0; 4];
    // SAFETY: it writes the four floats of the array.
    unsafe { _mm_storeu_ps(out.as_mut_ptr(), sums) };
    out
}

impl Lanes for Avx512 {
    memory!(16, "avx512f", _mm512_set1_ps, _mm512_loadu_ps, _mm512_storeu_ps);
    #[inline(always)]
    fn sums([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        // SAFETY: as of `splat`.
        unsafe {
            let ab = _mm512_add_ps(_mm512_unpacklo_ps(a.0, b.0), _mm512_unpackhi_ps(a.0, b.0));
            let cd = _mm512_add_ps(_mm512_unpacklo_ps(c.0, d.0), _mm512_unpackhi_ps(c.0, d.0));
            let even = _mm512_shuffle_ps::<0b01_00_01_00>(ab, cd);
            let quarters = _mm512_add_ps(even, _mm512_shuffle_ps::<0b11_10_11_10>(ab, cd));
            let upper = _mm512_extractf64x4_pd::<1>(_mm512_castps_pd(quarters));
            let halves = _mm256_add_ps(_mm512_castps512_ps256(quarters), _mm256_castpd_ps(upper));
            four(halves)
        }
    }
    values! {
        add(a, b) = _mm512_add_ps(a, b);
        sub(a, b) = _mm512_sub_ps(a, b);
        mul(a, b) = _mm512_mul_ps(a, b);
        reciprocal(a) = {
            // 14 bits, doubled by one step of Newton's method.
            let y = _mm512_rcp14_ps(a);
            _mm512_fmadd_ps(_mm512_fnmadd_ps(a, y, _mm512_set1_ps(1.0)), y, y)
        };
        reciprocal_root(a) = {
            let y = _mm512_rsqrt14_ps(a);
            let error = _mm512_fnmadd_ps(_mm512_mul_ps(a, y), y, _mm512_set1_ps(1.0));
            _mm512_fmadd_ps(_mm512_mul_ps(error, _mm512_set1_ps(0.5)), y, y)
        };
        mul_add(a, b, c) = _mm512_fmadd_ps(a, b, c);
        max(a, b) = _mm512_max_ps(a, b);
        min(a, b) = _mm512_min_ps(a, b);
        abs(a) = _mm512_abs_ps(a);
        round(a) = _mm512_roundscale_ps::<0>(a);
        scale(a, n) = _mm512_scalef_ps(a, n);
        where_positive(a, gate) = _mm512_maskz_mov_ps(
            _mm512_cmp_ps_mask::<_CMP_GT_OQ>(gate, _mm512_setzero_ps()), a);
        mul_add_where(a, b, c, gate) = _mm512_maskz_fmadd_ps(
            _mm512_cmp_ps_mask::<_CMP_GT_OQ>(gate, _mm512_setzero_ps()), a, b, c);
        where_positive_else(a, gate, other) = _mm512_mask_blend_ps(
            _mm512_cmp_ps_mask::<_CMP_GT_OQ>(gate, _mm512_setzero_ps()), other, a);
    }
}

impl Lanes for Avx2 {
    memory!(8, "avx2,fma", _mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps);
    #[inline(always)]
    fn sums([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        // SAFETY: as of `splat`.
        unsafe { four(_mm256_hadd_ps(_mm256_hadd_ps(a.0, b.0), _mm256_hadd_ps(c.0, d.0))) }
    }
    values! {
        add(a, b) = _mm256_add_ps(a, b);
        sub(a, b) = _mm256_sub_ps(a, b);
        mul(a, b) = _mm256_mul_ps(a, b);
        reciprocal(a) = _mm256_div_ps(_mm256_set1_ps(1.0), a);
        reciprocal_root(a) = _mm256_div_ps(_mm256_set1_ps(1.0), _mm256_sqrt_ps(a));
        mul_add(a, b, c) = _mm256_fmadd_ps(a, b, c);
        max(a, b) = _mm256_max_ps(a, b);
        min(a, b) = _mm256_min_ps(a, b);
        abs(a) = _mm256_andnot_ps(_mm256_set1_ps(-0.0), a);
        round(a) = _mm256_round_ps::<8>(a);
        scale(a, n) = _mm256_mul_ps(a, _mm256_castsi256_ps(_mm256_slli_epi32::<23>(
            _mm256_add_epi32(_mm256_cvtps_epi32(n), _mm256_set1_epi32(127)))));
        where_positive(a, gate) = _mm256_and_ps(
            _mm256_cmp_ps::<_CMP_GT_OQ>(gate, _mm256_setzero_ps()), a);
        where_positive_else(a, gate, other) = _mm256_blendv_ps(
            other, a, _mm256_cmp_ps::<_CMP_GT_OQ>(gate, _mm256_setzero_ps()));
    }
}
