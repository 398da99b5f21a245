//! The conjugate gradients of the height problem, on a device.

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
    /// Uploads the problem and computes the initial residual.
    pub fn new(gpu: &'a Gpu, problem: &NormalEquations) -> Result<Self, DeviceError> {
        let device = &gpu.device;
        let count = problem.x.len();
        let norm2: f64 = problem.right_hand_side.iter().map(|b| f64::from(*b).powi(2)).sum();
        let tolerance = (problem.tolerance * norm2) as f32;
        let vectors = Vectors {
            device,
            count,
            scalars: device.filled("scalars", &[0.0, tolerance, 0.0, 0.0]),
            parts: device.floats("parts", count.div_ceil(THREADS)),
            x: device.filled("unknowns", problem.x),
            residual: device.filled("residual", problem.right_hand_side),
            direction: device.filled("direction", problem.x),
            a_direction: device.floats("product with direction", count),
        };
        let mut step =
            product_with_matrix(device, problem, &vectors.direction, &vectors.a_direction);
        let Vectors { residual, direction, a_direction, .. } = &vectors;
        let begin = step.len();
        step.push(vectors.update(0));
        step.extend(vectors.dot(0, residual, residual));
        // The passes so far run once, with the unknowns in place of the direction.
        device.submit(&step, None, 1);
        step.truncate(begin);
        step.extend(vectors.dot(1, direction, a_direction));
        step.push(vectors.update(1));
        step.extend(vectors.dot(2, residual, residual));
        step.push(vectors.update(2));
        device.check()?;
        Ok(Self { gpu, x: vectors.x, step })
    }
}

impl Descent for Heights<'_> {
    fn steps(&mut self, count: usize) -> Result<(), DeviceError> {
        let device = &self.gpu.device;
        device.submit(&self.step, None, count);
        device.wait().inspect_err(|error| self.gpu.mark_failed(error))
    }

    fn unknowns(&mut self) -> Result<Vec<f32>, DeviceError> {
        let read =
            self.gpu.device.read(&[&self.x]).inspect_err(|error| self.gpu.mark_failed(error));
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
    residual: wgpu::Buffer,
    direction: wgpu::Buffer,
    a_direction: wgpu::Buffer,
}

impl Vectors<'_> {
    fn dot(&self, what: u32, a: &wgpu::Buffer, b: &wgpu::Buffer) -> [Pass; 2] {
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
        let Self { scalars, a_direction, x, residual, direction, .. } = self;
        let buffers = [&parameters, scalars, a_direction, x, residual, direction];
        Pass::over(self.device, &kernel, &buffers, self.count)
    }
}

/// The product of the normal equations' matrix with `from`.
fn product_with_matrix(
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
    let dampings = [problem.height_damping, problem.albedo_damping].map(f32::to_bits);
    let parameters = device.uniform(&[size as u32, dampings[0], dampings[1]]);
    let buffers = [&parameters, &basis, &by_deviation, from, to];
    passes.push(Pass::over(device, &kernel, &buffers, 4 * texels));
    passes
}
