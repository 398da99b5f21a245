//! Vectors of aarch64.

use std::arch::aarch64::*;

use super::intrinsics::{check, memory, values};
use super::{Lanes, Row, Task};

/// 4 lanes; every aarch64 has them.
#[derive(Clone, Copy)]
pub struct Neon(float32x4_t);

impl Lanes for Neon {
    memory!(4, "neon", vdupq_n_f32, vld1q_f32, vst1q_f32);
    #[inline(always)]
    fn sums([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        let mut out = [0.0; 4];
        // SAFETY: as of `splat`; the store writes the four floats of the array.
        unsafe {
            let sums = vpaddq_f32(vpaddq_f32(a.0, b.0), vpaddq_f32(c.0, d.0));
            vst1q_f32(out.as_mut_ptr(), sums);
        }
        out
    }
    values! {
        add(a, b) = vaddq_f32(a, b);
        sub(a, b) = vsubq_f32(a, b);
        mul(a, b) = vmulq_f32(a, b);
        reciprocal(a) = vdivq_f32(vdupq_n_f32(1.0), a);
        reciprocal_root(a) = vdivq_f32(vdupq_n_f32(1.0), vsqrtq_f32(a));
        mul_add(a, b, c) = vfmaq_f32(c, a, b);
        max(a, b) = vbslq_f32(vcgtq_f32(a, b), a, b);
        min(a, b) = vbslq_f32(vcltq_f32(a, b), a, b);
        abs(a) = vabsq_f32(a);
        round(a) = vrndnq_f32(a);
        scale(a, n) = vmulq_f32(a, vreinterpretq_f32_s32(vshlq_n_s32::<23>(
            vaddq_s32(vcvtq_s32_f32(n), vdupq_n_s32(127)))));
        where_positive(a, gate) = vreinterpretq_f32_u32(
            vandq_u32(vcgtzq_f32(gate), vreinterpretq_u32_f32(a)));
        where_positive_else(a, gate, other) = vbslq_f32(vcgtzq_f32(gate), a, other);
    }
}
