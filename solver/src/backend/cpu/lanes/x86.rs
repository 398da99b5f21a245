//! Vectors of x86-64.

use std::arch::x86_64::*;

use super::intrinsics::{check, memory, values};
use super::{LaneSum, Lanes, Row, SUMS};

/// 16 lanes; AVX-512 F.
#[derive(Clone, Copy)]
pub struct Avx512(__m512);

/// 8 lanes; AVX2 and FMA.
#[derive(Clone, Copy)]
pub struct Avx2(__m256);

impl Lanes for Avx512 {
    memory!(16, _mm512_set1_ps, _mm512_loadu_ps, _mm512_storeu_ps);
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
        where_positive_else(a, gate, other) = _mm512_mask_blend_ps(
            _mm512_cmp_ps_mask::<_CMP_GT_OQ>(gate, _mm512_setzero_ps()), other, a);
    }
}

impl Lanes for Avx2 {
    memory!(8, _mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps);
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
