//! Blurs of textures of 3 channels, and their adjoints.

use super::device::Device;
use super::pass::Pass;
use crate::model::blur::Blur;
use crate::model::pyramid::Pyramid;

/// A blur, or its adjoint.
pub(super) fn blurring(
    device: &Device,
    blur: &Blur,
    from: &wgpu::Buffer,
    to: &wgpu::Buffer,
    adjoint: bool,
) -> [Pass; 2] {
    let scaled = if adjoint { [1, 0] } else { [0, 2] };
    convolution(device, (blur.kernel(), blur.norms()), blur.norms().len(), scaled, from, to)
}

/// A blur by a pyramid.
pub(super) fn pyramid(
    device: &Device,
    pyramid: &Pyramid,
    from: &wgpu::Buffer,
    to: &wgpu::Buffer,
    adjoint: bool,
) -> Vec<Pass> {
    let (size, weights) = (pyramid.size(), (pyramid.kernel(), pyramid.norms()));
    let levels = pyramid.levels();
    if levels == 0 {
        let scaled = if adjoint { [1, 0] } else { [0, 2] };
        return convolution(device, weights, size, scaled, from, to).into();
    }
    let texture = |level: usize| device.floats("level", 3 * (size >> level).pow(2));
    let halves: Vec<_> = (1..=levels).map(texture).collect();
    let doubles: Vec<_> = (1..=levels).map(texture).collect();
    let norms = device.filled("pyramid's sums", pyramid.norms());
    let step = |level: usize, double: bool, from: &wgpu::Buffer, to: &wgpu::Buffer| {
        let scaled = level == 0 && double != adjoint;
        let constants = [("DOUBLE", u32::from(double)), ("SCALED", u32::from(scaled))];
        let kernel =
            device.kernel("pyramid", include_str!("wgsl/pyramid.wgsl"), &constants, "urrw");
        let (fine, coarse) = (3 * (size >> level).pow(2), 3 * (size >> (level + 1)).pow(2));
        let count = if double { fine } else { coarse };
        let parameters = device.uniform(&[(size >> level) as u32]);
        let pass = Pass::over(device, &kernel, &[&parameters, &norms, from, to], count);
        pass.doing(fine, 12, 1)
    };
    let mut passes = vec![];
    for level in 0..levels {
        passes.push(step(
            level,
            false,
            if level == 0 { from } else { &halves[level - 1] },
            &halves[level],
        ));
    }
    let (coarse, side) = (levels - 1, size >> levels);
    passes.extend(convolution(device, weights, side, [0, 0], &halves[coarse], &doubles[coarse]));
    for level in (0..levels).rev() {
        passes.push(step(
            level,
            true,
            &doubles[level],
            if level == 0 { to } else { &doubles[level - 1] },
        ));
    }
    passes
}

/// Along columns, then along rows; `scaled` as blur.wgsl has it.
fn convolution(
    device: &Device,
    (weights, norms): (&[f32], &[f32]),
    size: usize,
    scaled: [u32; 2],
    from: &wgpu::Buffer,
    to: &wgpu::Buffer,
) -> [Pass; 2] {
    let count = 3 * size * size;
    let between = device.floats("half blurred", count);
    let (kernel, sums) = (device.filled("blur", weights), device.filled("blur's sums", norms));
    let axis = |vertical: u32, scaled: u32, from: &wgpu::Buffer, to: &wgpu::Buffer| {
        let constants = [("VERTICAL", vertical), ("SCALED", scaled)];
        let program = device.kernel("blur", include_str!("wgsl/blur.wgsl"), &constants, "urrrw");
        let parameters = device.uniform(&[size as u32, weights.len() as u32 - 1]);
        let pass = Pass::over(device, &program, &[&parameters, &kernel, &sums, from, to], count);
        pass.doing(count, 2 * (2 * weights.len() - 1), 2)
    };
    // With the result scaled, columns come last.
    let first = u32::from(scaled[1] != 2);
    [axis(first, scaled[0], from, &between), axis(1 - first, scaled[1], &between, to)]
}
