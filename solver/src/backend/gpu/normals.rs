//! Specular albedo and deviation, with frozen networks.

use super::blurs::{blurring, pyramid};
use super::computing::Gpu;
use super::device::Device;
use super::direction_gradient::DirectionGradient;
use super::layout::Layout;
use super::pass::Pass;
use super::pieces::{DeviceTaps, Pieces};
use super::program::{Moved, Program};
use crate::backend::DIRECTION_ROWS;
use crate::backend::resident::NormalsJob;
use crate::model::deviation::Deviation;

/// Rows of sampled deviations, and of directions.
const DIRECTIONS: usize = 6;

/// The stage of normals and specular albedo.
pub(super) fn program<'a>(gpu: &'a Gpu, job: &NormalsJob) -> Program<'a> {
    let device = &gpu.device;
    let NormalsJob { samples, deviation, networks, light, albedo } = *job;
    let layout = Layout::new(&networks.shape);
    let pieces = Pieces::new(device, samples.len(), networks.outputs());
    let taps = DeviceTaps::new(device, &pieces, &samples.taps);
    let size = samples.taps.size();
    let count = 3 * size * size;
    let by_deviation = Moved::new(device, "deviation", count);
    let by_specular = Moved::new(device, "specular albedo", size * size);
    let texture = |name| device.floats(name, count);
    let [sharp, blurred, by_sharp, by_blurred] =
        ["deviation", "blurred deviation", "by deviation", "by its blur"].map(texture);
    let bent = pieces.zeros(device, "sampled deviation", DIRECTIONS);
    let surface = pieces.upload(device, "surface", &[&samples.normal, &samples.view]);
    let directions = pieces.zeros(device, "directions", DIRECTIONS);
    let albedo = pieces.upload(device, "albedos", &[albedo]);
    let kernels = DirectionGradient::new(device, pieces, samples, light);
    let weights = device.filled("networks", &layout.pack(&networks.parameters));

    let chart = Chart { device, deviation, count };
    let mut passes = chart.forth(&by_deviation.values, &sharp);
    passes.extend(pyramid(device, deviation.parts().blur, &sharp, &blurred, false));
    passes.extend(taps.sample(device, &sharp, 3, &bent, [0, DIRECTIONS]));
    passes.extend(taps.sample(device, &blurred, 3, &bent, [3, DIRECTIONS]));
    passes.extend(taps.sample(device, &by_specular.values, 1, &albedo, [3, 4]));
    let turn = |what: u32, vectors: &[wgpu::Buffer]| -> Vec<Pass> {
        let source = include_str!("wgsl/directions.wgsl");
        let kernel = device.kernel("directions", source, &[("WHAT", what)], "urrw");
        let one = |(at, piece): (usize, &std::ops::Range<usize>)| {
            let scale = &deviation.scale;
            let scales = [scale.normal.to_bits(), scale.reflection.to_bits()];
            let parameters = device.uniform(&[piece.len() as u32, scales[0], scales[1]]);
            let buffers = [&parameters, &bent[at], &surface[at], &vectors[at]];
            let values = 3 * DIRECTIONS + what as usize * DIRECTIONS;
            Pass::over(device, &kernel, &buffers, piece.len()).doing(piece.len(), 60, values)
        };
        kernels.pieces.0.iter().enumerate().map(one).collect()
    };
    passes.extend(turn(0, &directions));
    passes.extend(kernels.passes(device, &layout, &weights, &directions, &albedo));
    passes.extend(turn(1, &kernels.gradient));
    let by_sample = &kernels.gradient;
    for (row, gradient, channels) in
        [(0, &by_sharp, 3), (3, &by_blurred, 3), (6, &by_specular.gradient, 1)]
    {
        passes.extend(taps.gather(
            device,
            by_sample,
            [row, DIRECTION_ROWS],
            gradient,
            channels,
            false,
        ));
    }
    passes.extend(chart.back(&sharp, &by_sharp, &by_blurred, &by_deviation.gradient));
    let losses = [(kernels.losses, kernels.groups)];
    Program::new(gpu, passes, &losses, vec![by_deviation, by_specular])
}

/// The deviation texture and its blurs.
struct Chart<'a> {
    device: &'a Device,
    deviation: &'a Deviation,
    /// Values of a texture.
    count: usize,
}

impl Chart<'_> {
    /// The passes from the texture to the deviation d.
    fn forth(&self, texture: &wgpu::Buffer, d: &wgpu::Buffer) -> Vec<Pass> {
        let parts = self.deviation.parts();
        let band = self.device.floats("band", self.count);
        let mut passes = Vec::from(blurring(self.device, parts.narrow, texture, &band, false));
        let coarse = self.device.floats("coarse", self.count);
        if let Some(wide) = parts.wide {
            passes.extend(blurring(self.device, wide, texture, &coarse, false));
        }
        passes.push(self.value_by_value(0, [&band, &coarse, &coarse], d));
        passes
    }

    /// The adjoint passes: from the gradients with respect to d and its blur to the gradient with respect to the texture.
    fn back(
        &self,
        d: &wgpu::Buffer,
        by_d: &wgpu::Buffer,
        by_blur: &wgpu::Buffer,
        gradient: &wgpu::Buffer,
    ) -> Vec<Pass> {
        let parts = self.deviation.parts();
        let texture = |name| self.device.floats(name, self.count);
        let [unblurred, by_band, narrow, coarse] =
            ["unblurred", "by band", "by narrow blur", "by wide blur"].map(texture);
        let mut passes = pyramid(self.device, parts.blur, by_blur, &unblurred, true);
        passes.push(self.value_by_value(1, [&unblurred, by_d, d], &by_band));
        passes.extend(blurring(self.device, parts.narrow, &by_band, &narrow, true));
        if let Some(wide) = parts.wide {
            passes.extend(blurring(self.device, wide, &by_band, &coarse, true));
        }
        passes.push(self.value_by_value(2, [&narrow, &coarse, d], gradient));
        passes
    }

    fn value_by_value(&self, what: u32, inputs: [&wgpu::Buffer; 3], out: &wgpu::Buffer) -> Pass {
        let parts = self.deviation.parts();
        let constants = [("WHAT", what), ("BAND", u32::from(parts.wide.is_some()))];
        let source = include_str!("wgsl/deviation.wgsl");
        let kernel = self.device.kernel("deviation", source, &constants, "urrrw");
        let range = parts.range.to_bits();
        let parameters = self.device.uniform(&[self.count as u32, range]);
        let [a, b, d] = inputs;
        let pass = Pass::over(self.device, &kernel, &[&parameters, a, b, d, out], self.count);
        pass.doing(self.count, 10, 3)
    }
}
