//! Light, its nearness, albedos and networks under explicit transport.

use super::Gpu;
use super::device::Device;
use super::joint::Joint;
use super::kernel::{Pass, THREADS};
use super::layout::Layout;
use super::pieces::{DeviceTaps, Pieces};
use super::program::{Moved, Program, prior, total};
use crate::backend::ALBEDOS;
use crate::backend::resident::TransportedJob;
use crate::transport::{CHANNELS, Parts};

/// Rows of the matrix that one thread adds up.
const ROWS: usize = 256;

/// The stages of the light, and of light and albedo.
pub(super) fn program<'a>(gpu: &'a Gpu, layout: Layout, job: &TransportedJob) -> Program<'a> {
    let device = &gpu.device;
    let samples = job.samples;
    let size = samples.taps.size();
    let texels = CHANNELS * size * size;
    let parts = job.transport.parts();
    let matrix = Matrix::new(device, &parts);
    let channels = CHANNELS * parts.cells;
    let log_light = Moved::new(device, "light", channels);
    let nearness = Moved::new(device, "nearness", 1);
    let diffuse = Moved::new(device, "diffuse albedo", texels);
    let specular = Moved::new(device, "specular albedo", size * size);
    let weights = Moved::new(device, "networks", 4 * layout.vectors());
    let layer = device.floats("diffuse layer", texels);
    let by_layer = device.floats("by diffuse layer", texels);

    let pieces = Pieces::new(device, samples.len(), ALBEDOS);
    let taps = DeviceTaps::new(device, &pieces, &samples.taps);
    let albedo = pieces.zeros(device, "albedos", ALBEDOS);
    let joint = Joint::new(device, &layout, pieces, albedo).layered();

    let mut passes = matrix.shading(device, &log_light.values, &nearness.values);
    passes.push(matrix.lit(device, &diffuse.values, &layer, false));
    passes.extend(taps.sample(device, &layer, CHANNELS, &joint.albedo, [0, ALBEDOS]));
    passes.extend(taps.sample(device, &specular.values, 1, &joint.albedo, [3, ALBEDOS]));
    let (values, gradient) = (&weights.values, &weights.gradient);
    passes.extend(joint.passes(device, &layout, samples, job.directions, values, gradient));
    let by_albedo = &joint.by_albedo;
    passes.extend(taps.gather(device, by_albedo, [0, ALBEDOS], &by_layer, CHANNELS, false));
    passes.extend(taps.gather(device, by_albedo, [3, ALBEDOS], &specular.gradient, 1, false));
    let (prior_pass, prior_sums) = prior(device, &diffuse, size, job.prior).unzip();
    let add = prior_pass.is_some();
    passes.extend(prior_pass);
    passes.push(matrix.lit(device, &by_layer, &diffuse.gradient, add));
    let grey = [job.grey_mean, job.grey_texel];
    passes.extend(matrix.by_shading(device, [&by_layer, &diffuse.values], grey));
    passes.extend(matrix.by_light(device, &nearness.values, &log_light.gradient));
    let groups = matrix.groups();
    let (penalties, by_nearness) = ([0, groups], [groups, groups]);
    passes.extend(total(device, &matrix.partial, by_nearness, &nearness.gradient, false, false));

    let samples_loss = (joint.losses, joint.groups.iter().sum());
    let mut losses = vec![samples_loss, (matrix.partial, penalties[1])];
    losses.extend(prior_sums);
    let moved = vec![log_light, nearness, diffuse, specular, weights.in_layout(layout)];
    Program::new(gpu, passes, &losses, moved)
}

/// The transport's matrix and what is made with it.
struct Matrix {
    rows: usize,
    cells: usize,
    texels: usize,
    transport: wgpu::Buffer,
    gain: Option<wgpu::Buffer>,
    /// Of every texel, its row; and of every row, its texels.
    row: wgpu::Buffer,
    start: wgpu::Buffer,
    texel: wgpu::Buffer,
    light: wgpu::Buffer,
    shading: wgpu::Buffer,
    /// What the shading gains, then what `grey.wgsl` finds.
    gains: wgpu::Buffer,
    by_row: wgpu::Buffer,
    /// Of `rows.wgsl`.
    partial: wgpu::Buffer,
}

impl Matrix {
    fn new(device: &Device, parts: &Parts) -> Self {
        let rows = parts.matrix.len() / parts.cells.max(1);
        let mut start = vec![0u32; rows + 1];
        parts.row.iter().for_each(|row| start[*row as usize + 1] += 1);
        (0..rows).for_each(|row| start[row + 1] += start[row]);
        let mut texel: Vec<u32> = (0..parts.row.len() as u32).collect();
        texel.sort_by_key(|texel| (parts.row[*texel as usize], *texel));
        Self {
            rows,
            cells: parts.cells,
            texels: parts.row.len(),
            transport: device.filled("transport", parts.matrix),
            gain: parts.gain.map(|gain| device.filled("gain", gain)),
            row: device.filled("rows", parts.row),
            start: device.filled("first texels", &start),
            texel: device.filled("texels", &texel),
            light: device.floats("light", CHANNELS * parts.cells),
            shading: device.floats("shading", CHANNELS * rows),
            gains: device.floats("gains", CHANNELS * rows + 4),
            by_row: device.floats("by shading", CHANNELS * rows),
            partial: device.floats("penalties", 2 * rows.div_ceil(THREADS)),
        }
    }

    /// Workgroups of `rows.wgsl`.
    fn groups(&self) -> usize {
        self.rows.div_ceil(THREADS)
    }

    fn gained(&self) -> (&'static str, u32) {
        ("GAINED", u32::from(self.gain.is_some()))
    }

    /// The shading of every row.
    fn shading(&self, device: &Device, log: &wgpu::Buffer, nearness: &wgpu::Buffer) -> Vec<Pass> {
        let count = CHANNELS * self.cells;
        let kernel = device.kernel("light", include_str!("wgsl/light.wgsl"), &[], "urw");
        let parameters = device.uniform(&[count as u32]);
        let light = Pass::over(device, &kernel, &[&parameters, log, &self.light], count);
        let source = include_str!("wgsl/transport.wgsl");
        let kernel = device.kernel("transport", source, &[self.gained()], "urrrrww");
        let buffers = [
            &device.uniform(&[self.rows as u32, self.cells as u32]),
            &self.transport,
            self.gain.as_ref().unwrap_or(&self.transport),
            &self.light,
            nearness,
            &self.shading,
            &self.gains,
        ];
        vec![light, Pass::new(device, &kernel, &buffers, self.rows)]
    }

    /// A texture times the shading.
    fn lit(&self, device: &Device, from: &wgpu::Buffer, to: &wgpu::Buffer, add: bool) -> Pass {
        let constants = [("ADD", u32::from(add))];
        let kernel = device.kernel("lit", include_str!("wgsl/lit.wgsl"), &constants, "urrrw");
        let count = CHANNELS * self.texels;
        let parameters = device.uniform(&[count as u32]);
        let buffers = [&parameters, &self.row, &self.shading, from, to];
        Pass::over(device, &kernel, &buffers, count)
    }

    /// The gradient by the shading of every row; `textures` are that by the diffuse layer, and the
    /// albedo.
    fn by_shading(
        &self,
        device: &Device,
        textures: [&wgpu::Buffer; 2],
        [mean_weight, texel_weight]: [f32; 2],
    ) -> Vec<Pass> {
        let rows = self.rows as u32;
        let kernel = device.kernel("grey", include_str!("wgsl/grey.wgsl"), &[], "urrw");
        let texels = self.texels as f32;
        let parameters = device.uniform(&[rows, texels.to_bits(), mean_weight.to_bits()]);
        let buffers = [&parameters, &self.start, &self.shading, &self.gains];
        let grey = Pass::new(device, &kernel, &buffers, 1);
        let kernel = device.kernel("by shading", include_str!("wgsl/rows.wgsl"), &[], "urrrrrrww");
        let scale = texel_weight / (CHANNELS as f32 * texels);
        let buffers = [
            &device.uniform(&[rows, scale.to_bits()]),
            &self.start,
            &self.texel,
            textures[0],
            textures[1],
            &self.shading,
            &self.gains,
            &self.by_row,
            &self.partial,
        ];
        vec![grey, Pass::new(device, &kernel, &buffers, self.groups())]
    }

    /// The gradient by the light's logarithm.
    fn by_light(
        &self,
        device: &Device,
        nearness: &wgpu::Buffer,
        gradient: &wgpu::Buffer,
    ) -> Vec<Pass> {
        let (count, chunks) = (CHANNELS * self.cells, self.rows.div_ceil(ROWS));
        let partial = device.floats("partial sums", chunks * count);
        let constants = [self.gained(), ("ROWS", ROWS as u32)];
        let source = include_str!("wgsl/adjoint.wgsl");
        let kernel = device.kernel("adjoint", source, &constants, "urrrrw");
        let buffers = [
            &device.uniform(&[self.rows as u32, self.cells as u32]),
            &self.transport,
            self.gain.as_ref().unwrap_or(&self.transport),
            nearness,
            &self.by_row,
            &partial,
        ];
        let groups = chunks * self.cells.div_ceil(THREADS);
        let adjoint = Pass::new(device, &kernel, &buffers, groups);
        let source = include_str!("wgsl/by_light.wgsl");
        let kernel = device.kernel("by light", source, &[], "urrw");
        let parameters = device.uniform(&[count as u32, chunks as u32]);
        let buffers = [&parameters, &partial, &self.light, gradient];
        vec![adjoint, Pass::over(device, &kernel, &buffers, count)]
    }
}
