//! Plain loops, compiled for wide vectors.

// Bodies are `for` loops: a closure handed to the standard library may be compiled apart, without the
// wide vectors.

/// Defines a function whose body the compiler vectorises with AVX-512 or AVX2 where the machine has it.
/// Products and sums are rounded one by one on every machine (no contraction to fused operations), so
/// that results do not depend on it.
macro_rules! widened {
    ($(#[$meta:meta])* $vis:vis fn $name:ident$(<const $n:ident: usize>)?($($arg:ident: $type:ty),* $(,)?) $(-> $out:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name$(<const $n: usize>)?($($arg: $type),*) $(-> $out)? {
            #[inline(always)]
            fn body$(<const $n: usize>)?($($arg: $type),*) $(-> $out)? $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
                fn avx512$(<const $n: usize>)?($($arg: $type),*) $(-> $out)? {
                    body$(::<$n>)?($($arg),*)
                }
                #[target_feature(enable = "avx2")]
                fn avx2$(<const $n: usize>)?($($arg: $type),*) $(-> $out)? {
                    body$(::<$n>)?($($arg),*)
                }
                if $crate::simd::has_avx512() {
                    // SAFETY: all of AVX-512 that is enabled was just found.
                    return unsafe { avx512$(::<$n>)?($($arg),*) };
                }
                if is_x86_feature_detected!("avx2") {
                    // SAFETY: AVX2 was just found.
                    return unsafe { avx2$(::<$n>)?($($arg),*) };
                }
            }
            body$(::<$n>)?($($arg),*)
        }
    };
}

/// Whether the machine has what every processor with AVX-512 has had but the first.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

pub(crate) use widened;
