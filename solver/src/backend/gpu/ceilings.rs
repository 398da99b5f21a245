//! The device's ceilings: multiply-adds and bandwidth that its kernels are measured against.

use std::time::{Duration, Instant};

use super::device::Device;
use super::pass::Pass;
use crate::backend::resident::DeviceError;

/// Threads of the multiply-adds, enough for the largest device; operations of each.
const THREADS: usize = 1 << 19;
const ROUNDS: u32 = 512;
/// Four vectors of four, a multiply-add each.
const FLOPS_PER_ROUND: usize = 32;

/// See [`super::Gpu::ceilings`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ceilings {
    /// Multiply-adds as two operations, per second.
    pub flops: f64,
    /// Bytes from and to memory, per second.
    pub bytes: f64,
}

/// `bytes` of each of the three arrays, which no cache should hold; `budget` for either kernel.
pub(super) fn ceilings(
    device: &Device,
    bytes: usize,
    budget: Duration,
) -> Result<Ceilings, DeviceError> {
    let out = device.floats("sums", THREADS);
    let source = include_str!("wgsl/multiply_add.wgsl");
    let kernel = device.kernel("multiply-adds", source, &[("ROUNDS", ROUNDS)], "uw");
    let seeds = device.uniform(&[0.999f32, 1e-3].map(f32::to_bits));
    let pass = Pass::over(device, &kernel, &[&seeds, &out], THREADS);
    let flops = THREADS * ROUNDS as usize * FLOPS_PER_ROUND;
    let flops = flops as f64 / seconds(device, &pass, budget)?;

    let count = bytes / size_of::<[f32; 4]>();
    let arrays = ["a", "b", "c"].map(|name| device.floats(name, 4 * count));
    let kernel = device.kernel("triad", include_str!("wgsl/triad.wgsl"), &[], "urrw");
    let parameters = device.uniform(&[count as u32]);
    let [a, b, c] = &arrays;
    let pass = Pass::over(device, &kernel, &[&parameters, b, c, a], count);
    let bytes = (3 * count * size_of::<[f32; 4]>()) as f64 / seconds(device, &pass, budget)?;
    Ok(Ceilings { flops, bytes })
}

/// The shortest time of a pass within submissions that grow until they fill a quarter of the budget, so
/// that handing them over does not count.
fn seconds(device: &Device, pass: &Pass, budget: Duration) -> Result<f64, DeviceError> {
    let (begin, mut best, mut count) = (Instant::now(), f64::INFINITY, 1);
    device.submit(std::slice::from_ref(pass), None, 1);
    device.wait()?;
    loop {
        let start = Instant::now();
        device.submit(std::slice::from_ref(pass), None, count);
        device.wait()?;
        let taken = start.elapsed();
        best = best.min(taken.as_secs_f64() / count as f64);
        if begin.elapsed() >= budget {
            return Ok(best);
        }
        if taken < budget / 4 {
            count *= 2;
        }
    }
}
