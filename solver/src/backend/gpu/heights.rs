//! The conjugate gradients of the height solve.

use glam::Vec3;

use super::blurs::blurring;
use super::computing::Gpu;
use super::device::Device;
use super::pass::{Pass, THREADS};
use super::pieces::{DeviceTaps, Pieces};
use crate::backend::resident::{Descent, DeviceError, NormalEquations};

/// Rows of the sampled unknowns, and of slopes and weight.
const UNKNOWNS: usize = 9;
const SLOPES: usize = 16;

/// The problem on the device.
pub(super) struct Heights<'a> {
    gpu: &'a Gpu,
    x: wgpu::Buffer,
    step: Vec<Pass>,
}

impl<'a> Heights<'a> {
    /// Uploads everything and takes the first look at what is left of the goal.
    pub fn new(gpu: &'a Gpu, problem: &NormalEquations) -> Result<Self, DeviceError> {
        let device = &gpu.device;
        let count = problem.x.len();
        let goal: f64 = problem.goal.iter().map(|goal| f64::from(*goal).powi(2)).sum();
        let vectors = Vectors {
            device,
            count,
            scalars: device.filled("scalars", &[0.0, (problem.enough * goal) as f32, 0.0, 0.0]),
            parts: device.floats("parts", count.div_ceil(THREADS)),
            x: device.filled("unknowns", problem.x),
            rest: device.filled("rest", problem.goal),
            direction: device.filled("direction", problem.x),
            image: device.floats("image", count),
        };
        let image = image(device, problem, &vectors.direction, &vectors.image);
        let Vectors { rest, direction, image: imaged, .. } = &vectors;
        let mut step = image;
        let begin = step.len();
        step.push(vectors.update(0));
        step.extend(vectors.product(0, rest, rest));
        // Everything up to here happens once, on the unknowns in the direction's place.
        device.submit(&step, None, 1);
        step.truncate(begin);
        step.extend(vectors.product(1, direction, imaged));
        step.push(vectors.update(1));
        step.extend(vectors.product(2, rest, rest));
        step.push(vectors.update(2));
        device.check()?;
        Ok(Self { gpu, x: vectors.x, step })
    }
}

impl Descent for Heights<'_> {
    fn steps(&mut self, count: usize) -> Result<(), DeviceError> {
        let device = &self.gpu.device;
        device.submit(&self.step, None, count);
        device.wait().inspect_err(|error| self.gpu.falls(error))
    }

    fn unknowns(&mut self) -> Result<Vec<f32>, DeviceError> {
        let read = self.gpu.device.read(&[&self.x]).inspect_err(|error| self.gpu.falls(error));
        Ok(read?.swap_remove(0))
    }
}

/// The vectors of the conjugate gradients, all of the unknowns' length.
struct Vectors<'a> {
    device: &'a Device,
    count: usize,
    scalars: wgpu::Buffer,
    parts: wgpu::Buffer,
    x: wgpu::Buffer,
    rest: wgpu::Buffer,
    direction: wgpu::Buffer,
    image: wgpu::Buffer,
}

impl Vectors<'_> {
    fn product(&self, what: u32, a: &wgpu::Buffer, b: &wgpu::Buffer) -> [Pass; 2] {
        let kernel = self.device.kernel("product", include_str!("wgsl/dot.wgsl"), &[], "urrw");
        let parameters = self.device.uniform(&[self.count as u32]);
        let parts = Pass::over(self.device, &kernel, &[&parameters, a, b, &self.parts], self.count);
        let source = include_str!("wgsl/descent.wgsl");
        let kernel = self.device.kernel("descent", source, &[("WHAT", what)], "urw");
        let parameters = self.device.uniform(&[self.count.div_ceil(THREADS) as u32]);
        let buffers = [&parameters, &self.parts, &self.scalars];
        [parts, Pass::new(self.device, &kernel, &buffers, 1)]
    }

    fn update(&self, what: u32) -> Pass {
        let source = include_str!("wgsl/step.wgsl");
        let kernel = self.device.kernel("vectors", source, &[("WHAT", what)], "urrwww");
        let parameters = self.device.uniform(&[self.count as u32]);
        let buffers =
            [&parameters, &self.scalars, &self.image, &self.x, &self.rest, &self.direction];
        Pass::over(self.device, &kernel, &buffers, self.count)
    }
}

/// The product of the normal equations' matrix with `from`.
fn image(
    device: &Device,
    problem: &NormalEquations,
    from: &wgpu::Buffer,
    to: &wgpu::Buffer,
) -> Vec<Pass> {
    let size = problem.taps.size();
    let texels = size * size;
    let rows = problem.slopes.rows() + 1;
    debug_assert_eq!(rows, SLOPES);
    let pieces = Pieces::new(device, problem.slopes.len(), rows);
    let taps = DeviceTaps::new(device, &pieces, problem.taps);
    let slopes = pieces.upload(device, "slopes", &[problem.slopes, problem.weight]);
    let unknowns = pieces.zeros(device, "sampled unknowns", UNKNOWNS);
    let texture = |name| device.floats(name, 3 * texels);
    let [deviation, soft, by_deviation, by_soft, unblurred] =
        ["deviation", "soft deviation", "by deviation", "by soft deviation", "unblurred"]
            .map(texture);
    let [right, down] = problem.basis;
    let flat = |(right, down): (&Vec3, &Vec3)| [right.to_array(), down.to_array()].concat();
    let basis: Vec<f32> = right.iter().zip(down).flat_map(flat).collect();
    let basis = device.filled("basis", &basis);

    let source = include_str!("wgsl/height_deviation.wgsl");
    let kernel = device.kernel("heights' deviation", source, &[], "urrw");
    let parameters = device.uniform(&[size as u32]);
    let mut passes =
        vec![Pass::over(device, &kernel, &[&parameters, &basis, from, &deviation], texels)];
    passes.extend(blurring(device, problem.blur, &deviation, &soft, false));
    for (row, texture, first) in [(0, &deviation, 0), (3, &soft, 0), (6, from, texels)] {
        passes.extend(taps.sample_from(device, (texture, first), 3, &unknowns, [row, UNKNOWNS]));
    }
    let kernel = device.kernel("normal equations", include_str!("wgsl/normal.wgsl"), &[], "urw");
    for (at, piece) in pieces.0.iter().enumerate() {
        let parameters = device.uniform(&[piece.len() as u32, problem.diffuse_share.to_bits()]);
        let buffers = [&parameters, &slopes[at], &unknowns[at]];
        passes.push(Pass::over(device, &kernel, &buffers, piece.len()));
    }
    for (row, gradient, first) in [(0, &by_deviation, 0), (3, &by_soft, 0), (6, to, texels)] {
        let gathered = (gradient, first);
        passes.extend(taps.gather_to(device, &unknowns, [row, UNKNOWNS], gathered, 3, false));
    }
    passes.extend(blurring(device, problem.blur, &by_soft, &unblurred, true));
    let kernel =
        device.kernel("deviation's penalty", include_str!("wgsl/penalty.wgsl"), &[], "urrw");
    let [flatness, smoothness] = [problem.flatness, problem.smoothness].map(f32::to_bits);
    let parameters = device.uniform(&[size as u32, flatness, smoothness]);
    passes.push(Pass::over(
        device,
        &kernel,
        &[&parameters, &deviation, &unblurred, &by_deviation],
        3 * texels,
    ));
    let source = include_str!("wgsl/height_adjoint.wgsl");
    let kernel = device.kernel("heights' adjoint", source, &[], "urrrw");
    let [rest, damping] = [problem.rest, problem.damping].map(f32::to_bits);
    let parameters = device.uniform(&[size as u32, rest, damping]);
    let buffers = [&parameters, &basis, &by_deviation, from, to];
    passes.push(Pass::over(device, &kernel, &buffers, 4 * texels));
    passes
}
