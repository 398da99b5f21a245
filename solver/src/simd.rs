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
                if $crate::simd::has_avx2() {
                    // SAFETY: AVX2 was just found.
                    return unsafe { avx2$(::<$n>)?($($arg),*) };
                }
            }
            body$(::<$n>)?($($arg),*)
        }
    };
}

/// Asks memory for a value before it is needed; beyond the end it is harmless, and elsewhere than on x86-64
/// it does nothing.
#[inline(always)]
pub(crate) fn prefetch<T>(address: *const T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: it loads nothing into the program and cannot fault, whatever the address.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(address.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = address;
}

/// Whether the machine has AVX-512 F, BW, DQ and VL: all that have any, but for Xeon Phi.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn has_avx512() -> bool {
    #[cfg(test)]
    if tests::widest() < 2 {
        return false;
    }
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

/// Whether the machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn has_avx2() -> bool {
    #[cfg(test)]
    if tests::widest() < 1 {
        return false;
    }
    is_x86_feature_detected!("avx2")
}

pub(crate) use widened;

#[cfg(test)]
#[cfg(target_arch = "x86_64")]
mod tests {
    use std::cell::Cell;

    use crate::fit::adam::Adam;
    use crate::model::blur::Blur;
    use crate::model::prior::albedo_prior;
    use crate::model::pyramid::Pyramid;
    use crate::model::taps::Taps;

    thread_local! {
        static WIDEST: Cell<u8> = const { Cell::new(2) };
    }

    /// 0: no wide vectors; 1: AVX2; 2: AVX-512.
    pub fn widest() -> u8 {
        WIDEST.get()
    }

    /// Results of some of the loops on noise, on this thread alone.
    fn results(widest: u8) -> Vec<f32> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
        let pool = pool.start_handler(move |_| WIDEST.set(widest)).build().unwrap();
        let noise =
            |count: usize| -> Vec<f32> { (0..count).map(|i| (i as f32 * 12.9898).sin()).collect() };
        pool.install(|| {
            let (side, texture) = (37, noise(3 * 37 * 37));
            let mut all = Blur::new(side, 3, 2.0).apply(&texture);
            let mut gradient = all.clone();
            all.push(albedo_prior(&texture, side, 0.3, &mut gradient) as f32);
            let mut adam = Adam::new(&crate::config::AdamConfig::default(), 0.1, texture.len());
            let mut moved = texture.clone();
            adam.step(&mut moved, &gradient, 1.0, 0.0);
            let uvs: Vec<_> = (0..999).map(|i| glam::Vec2::splat(i as f32 / 999.0)).collect();
            let taps = Taps::sorted(side, &uvs).0;
            all.extend(taps.gather::<3>(&taps.sample::<3>(&moved), 0));
            all.extend(Pyramid::new(36, 4.2).apply(&noise(4 * 36 * 36)));
            all.extend(gradient);
            all
        })
    }

    #[test]
    fn the_width_of_vectors_changes_no_bit() {
        let bits = |widest| results(widest).iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let plain = bits(0);
        assert_eq!(bits(1), plain);
        assert_eq!(bits(2), plain);
    }
}
