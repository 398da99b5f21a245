//! Vectors of floats with one meaning and several widths.
//!
//! A vector type is used only inside functions that are entered after its instruction set was detected (see
//! [`super::Level`]), which makes the intrinsics sound.

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod intrinsics;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(target_arch = "aarch64")]
pub use neon::Neon;
#[cfg(target_arch = "x86_64")]
pub use x86::{Avx2, Avx512};

use crate::model::planes::{BLOCK, Row};

/// A computation for vectors of any width.
pub trait Task {
    /// Runs the computation.
    fn run<S: Lanes>(self);
}

/// A vector of floats.
pub trait Lanes: Copy {
    /// Number of floats; divides the block's length.
    const WIDTH: usize;
    /// Runs a task in a separate function, where the compiler keeps a loop's sums in registers.
    fn out_of_line(task: impl Task);
    /// All lanes `x`.
    fn splat(x: f32) -> Self;
    /// Lanes `at..at + WIDTH` of a row.
    fn load(row: &Row, at: usize) -> Self;
    /// Writes lanes `at..at + WIDTH` of a row.
    fn store(self, row: &mut Row, at: usize);
    /// Sum of the lanes of each of four vectors.
    fn sums(four: [Self; 4]) -> [f32; 4];
    /// self + b.
    fn add(self, b: Self) -> Self;
    /// self - b.
    fn sub(self, b: Self) -> Self;
    /// self * b.
    fn mul(self, b: Self) -> Self;
    /// 1 / self, relative error at most 1e-7.
    fn reciprocal(self) -> Self;
    /// 1 / sqrt(self), relative error at most 3e-7.
    fn reciprocal_root(self) -> Self;
    /// self * b + c, rounded once where the hardware can.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// self * b + c where `gate` > 0, else 0.
    #[inline(always)]
    fn mul_add_where(self, b: Self, c: Self, gate: Self) -> Self {
        self.mul_add(b, c).where_positive(gate)
    }
    /// The larger one; `b` if either is NaN.
    fn max(self, b: Self) -> Self;
    /// The smaller one; `b` if either is NaN.
    fn min(self, b: Self) -> Self;
    /// The absolute value.
    fn abs(self) -> Self;
    /// Nearest integer.
    fn round(self) -> Self;
    /// self * 2^n for an integral n that keeps the result normal.
    fn scale(self, n: Self) -> Self;
    /// self where `gate` > 0, else 0.
    fn where_positive(self, gate: Self) -> Self;
    /// self where `gate` > 0, else `other`.
    fn where_positive_else(self, gate: Self, other: Self) -> Self;
}

/// e^x, relative error about 1e-7; x is clamped to [-40, 88].
#[inline(always)]
pub fn exp<S: Lanes, const N: usize>(mut x: [S; N]) -> [S; N] {
    for x in &mut x {
        // This order preserves a NaN, so that the loss of a diverged solve is NaN.
        *x = S::splat(88.0).min(*x);
    }
    exp_below(x)
}

/// [`exp`] in plain operations, which the compiler vectorises.
#[inline(always)]
pub fn exp_plain(x: f32) -> f32 {
    /// Its addition rounds to an integer, in the lowest bits.
    const SHIFT: f32 = 12_582_912.0;
    let x = x.clamp(LEAST, 88.0);
    let shifted = x * std::f32::consts::LOG2_E + SHIFT;
    let n = shifted - SHIFT;
    let r = n * REST_OF_LN_2 + (n * -LN_2 + x);
    let sum = EXP.into_iter().fold(EXP_FIRST, |sum, factor| sum * r + factor);
    f32::from_bits(sum.to_bits().wrapping_add(shifted.to_bits() << 23))
}

/// Least argument, with e^x = 4e-18: smaller values change no sum, but their products with gradients would be
/// subnormal, which take some processors a hundred times as long.
const LEAST: f32 = -40.0;
/// ln 2 in two parts; the first has few bits, so that its product with an exponent is exact.
const LN_2: f32 = 0.693_359_4;
const REST_OF_LN_2: f32 = 2.121_944_4e-4;
/// 1 + r + r^2 p(r) with the minimax polynomial p on |r| <= ln 2 / 2, with an error of 1.1e-8; the highest power first.
const EXP_FIRST: f32 = 0.001_394_111_3;
const EXP: [f32; 6] = [0.008_363_175, 0.041_666_374, 0.166_665_76, 0.5, 1.0, 1.0];

/// [`exp`] of arguments up to 88.
#[inline(always)]
fn exp_below<S: Lanes, const N: usize>(mut x: [S; N]) -> [S; N] {
    let mut n = x;
    for (x, n) in x.iter_mut().zip(&mut n) {
        *x = S::splat(LEAST).max(*x);
        *n = x.mul(S::splat(std::f32::consts::LOG2_E)).round();
    }
    for part in [-LN_2, REST_OF_LN_2] {
        for (r, n) in x.iter_mut().zip(&n) {
            *r = n.mul_add(S::splat(part), *r);
        }
    }
    let mut sums = [S::splat(EXP_FIRST); N];
    horner(&mut sums, &x, &EXP);
    for (sum, n) in sums.iter_mut().zip(n) {
        *sum = sum.scale(n);
    }
    sums
}

/// Horner's method: sum x + factor for every factor. Interleaved vectors hide the latency.
#[inline(always)]
fn horner<S: Lanes, const N: usize>(sums: &mut [S; N], x: &[S; N], factors: &[f32]) {
    for factor in factors {
        for (sum, x) in sums.iter_mut().zip(x) {
            *sum = sum.mul_add(*x, S::splat(*factor));
        }
    }
}

/// log(1 + e^x) and its derivative, the logistic function; relative error about 2e-7.
#[inline(always)]
pub fn softplus<S: Lanes, const N: usize>(x: [S; N]) -> ([S; N], [S; N]) {
    let one = S::splat(1.0);
    let zero = S::splat(0.0);
    let mut below = x;
    for x in &mut below {
        *x = zero.sub(x.abs());
    }
    let e = exp_below(below);
    let mut slopes = e;
    for slope in &mut slopes {
        *slope = one.add(*slope).reciprocal();
    }
    // log(1 + e) / e on 0 to 1, with a minimax relative error of 3.3e-8.
    let mut sums = [S::splat(0.005_364_822_7); N];
    let factors = [
        -0.030_065_786,
        0.079_204_52,
        -0.137_538_02,
        0.191_536_55,
        -0.248_571_63,
        0.333_213_24,
        -0.499_996_48,
        1.0,
    ];
    horner(&mut sums, &e, &factors);
    for k in 0..N {
        sums[k] = sums[k].mul_add(e[k], x[k].max(zero));
        slopes[k] = slopes[k].where_positive_else(x[k], e[k].mul(slopes[k]));
    }
    (sums, slopes)
}

/// Plain arrays, which the compiler vectorises.
#[derive(Clone, Copy)]
pub struct Portable(pub [f32; 8]);

#[inline(always)]
fn zip(mut a: Portable, b: Portable, f: impl Fn(f32, f32) -> f32) -> Portable {
    for (a, b) in a.0.iter_mut().zip(b.0) {
        *a = f(*a, b);
    }
    a
}

#[rustfmt::skip]
impl Lanes for Portable {
    const WIDTH: usize = 8;
    #[inline(never)] fn out_of_line(task: impl Task) { task.run::<Self>(); }
    #[inline(always)] fn splat(x: f32) -> Self { Self([x; 8]) }
    #[inline(always)] fn load(row: &Row, at: usize) -> Self {
        let mut out = [0.0; 8];
        out.copy_from_slice(&row.0[at..at + 8]);
        Self(out)
    }
    #[inline(always)] fn store(self, row: &mut Row, at: usize) { row.0[at..at + 8].copy_from_slice(&self.0); }
    #[inline(always)] fn sums(four: [Self; 4]) -> [f32; 4] {
        let mut sums = [0.0; 4];
        for quarter in 0..2 {
            for (sum, v) in sums.iter_mut().zip(four) {
                let [a, b] = [quarter, 2 + quarter].map(|lane| v.0[lane] + v.0[lane + 4]);
                *sum += a + b;
            }
        }
        sums
    }
    #[inline(always)] fn add(self, b: Self) -> Self { zip(self, b, |a, b| a + b) }
    #[inline(always)] fn sub(self, b: Self) -> Self { zip(self, b, |a, b| a - b) }
    #[inline(always)] fn mul(self, b: Self) -> Self { zip(self, b, |a, b| a * b) }
    #[inline(always)] fn reciprocal(self) -> Self { zip(self, self, |a, _| 1.0 / a) }
    #[inline(always)] fn reciprocal_root(self) -> Self { zip(self, self, |a, _| 1.0 / a.sqrt()) }
    #[inline(always)] fn mul_add(self, b: Self, c: Self) -> Self { self.mul(b).add(c) }
    #[inline(always)] fn max(self, b: Self) -> Self { zip(self, b, |a, b| if a > b { a } else { b }) }
    #[inline(always)] fn min(self, b: Self) -> Self { zip(self, b, |a, b| if a < b { a } else { b }) }
    #[inline(always)] fn abs(self) -> Self { zip(self, self, |a, _| a.abs()) }
    #[inline(always)] fn round(self) -> Self {
        // The addition of 1.5 * 2^23 rounds to an integer.
        zip(self, self, |a, _| (a + 12_582_912.0) - 12_582_912.0)
    }
    #[inline(always)] fn scale(self, n: Self) -> Self {
        zip(self, n, |a, n| a * f32::from_bits(((n as i32 + 127) as u32) << 23))
    }
    #[inline(always)] fn where_positive(self, gate: Self) -> Self { zip(self, gate, |a, g| if g > 0.0 { a } else { 0.0 }) }
    #[inline(always)] fn where_positive_else(mut self, gate: Self, other: Self) -> Self {
        for (lane, a) in self.0.iter_mut().enumerate() {
            *a = if gate.0[lane] > 0.0 { *a } else { other.0[lane] };
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Only portable lanes are tested here: the kernels of other widths are compared with them.
    #[test]
    fn exp_and_softplus_are_accurate_and_their_derivatives_match() {
        let (mut worst_exp, mut worst_softplus, mut worst_slope) = (0.0f64, 0.0f64, 0.0f64);
        for step in -4000..8000 {
            let x = step as f32 * 0.01;
            let exact = f64::from(x).exp();
            let relative = |got: f32, exact: f64| (f64::from(got) / exact - 1.0).abs();
            let [power] = exp([Portable::splat(x)]);
            worst_exp = worst_exp.max(relative(power.0[3], exact));
            assert_eq!(exp_plain(x), power.0[0], "{x}");
            let ([value], [slope]) = softplus([Portable::splat(x)]);
            worst_softplus = worst_softplus.max(relative(value.0[0], exact.ln_1p()));
            worst_slope = worst_slope.max(relative(slope.0[7], exact / (1.0 + exact)));
        }
        assert!(worst_exp < 3e-7, "{worst_exp}");
        assert!(worst_softplus < 5e-7, "{worst_softplus}");
        assert!(worst_slope < 5e-7, "{worst_slope}");
    }
}
