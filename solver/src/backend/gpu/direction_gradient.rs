//! Shading under frozen networks, and its gradients.

use super::device::Device;
use super::layout::{Layout, TILE};
use super::pass::Pass;
use super::pieces::{Pieces, pixels};
use crate::backend::DIRECTION_ROWS;
use crate::backend::resident::DeviceError;
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// L(p) of every sample.
pub(super) fn light(
    device: &Device,
    networks: &Networks,
    position: &Planes,
) -> Result<Planes, DeviceError> {
    evaluated(device, networks, position, None)
}

/// S_d and S_s of every sample.
pub(super) fn shade(
    device: &Device,
    networks: &Networks,
    light: &Planes,
    directions: &Planes,
) -> Result<Planes, DeviceError> {
    evaluated(device, networks, directions, Some(light))
}

/// The light of positions, or with a light the shading of directions.
fn evaluated(
    device: &Device,
    networks: &Networks,
    inputs: &Planes,
    light: Option<&Planes>,
) -> Result<Planes, DeviceError> {
    let layout = Layout::new(&networks.shape);
    let rows = if light.is_some() { 2 } else { networks.outputs() };
    let pieces = Pieces::new(device, inputs.len(), networks.outputs());
    let constants = [("WHAT", u32::from(light.is_some()))];
    let source = include_str!("wgsl/shading.wgsl");
    let kernel = layout.kernel(device, "shading", source, &constants, "unrrw");
    let weights = device.filled("networks", &layout.pack(&networks.parameters));
    let inputs = pieces.upload(device, "directions", &[inputs]);
    // Without a light, one of the inputs stands in its place: no kernel reads it.
    let light = light.map(|light| pieces.upload(device, "light", &[light]));
    let out = pieces.zeros(device, "shading", rows);
    let pass = |(at, piece): (usize, &std::ops::Range<usize>)| {
        let parameters = device.uniform(&[piece.len() as u32]);
        let light = light.as_ref().map_or(&inputs[at], |light| &light[at]);
        let buffers = [&parameters, &weights, &inputs[at], light, &out[at]];
        Pass::new(device, &kernel, &buffers, piece.len().div_ceil(TILE))
    };
    let passes: Vec<Pass> = pieces.0.iter().enumerate().map(pass).collect();
    device.submit(&passes, None, 1);
    Ok(pieces.planes(rows, &device.read(&out.iter().collect::<Vec<_>>())?))
}

/// Buffers of the kernel besides weights, directions and albedos.
pub(super) struct DirectionGradient {
    pub pieces: Pieces,
    light: Vec<wgpu::Buffer>,
    pixels: Vec<wgpu::Buffer>,
    /// [`DIRECTION_ROWS`] rows.
    pub gradient: Vec<wgpu::Buffer>,
    pub losses: wgpu::Buffer,
    /// Workgroups, each with a partial loss.
    pub groups: usize,
    scale: f32,
}

impl DirectionGradient {
    pub fn new(device: &Device, pieces: Pieces, samples: &Samples, light: &Planes) -> Self {
        let groups = pieces.0.iter().map(|piece| piece.len().div_ceil(TILE)).sum();
        Self {
            light: pieces.upload(device, "light", &[light]),
            pixels: pixels(device, &pieces, samples),
            gradient: pieces.zeros(device, "gradient", DIRECTION_ROWS),
            losses: device.floats("partial losses", groups),
            groups,
            scale: 1.0 / (3.0 * samples.len() as f32),
            pieces,
        }
    }

    /// Loss, and gradients by directions and specular albedo.
    pub fn passes(
        &self,
        device: &Device,
        layout: &Layout,
        weights: &wgpu::Buffer,
        directions: &[wgpu::Buffer],
        albedo: &[wgpu::Buffer],
    ) -> Vec<Pass> {
        let source =
            [include_str!("wgsl/pixel.wgsl"), include_str!("wgsl/direction_gradient.wgsl")]
                .concat();
        let kernel = layout.kernel(device, "bent shading", &source, &[], "unrrrrww");
        let mut first = 0;
        let mut passes = vec![];
        for (at, piece) in self.pieces.0.iter().enumerate() {
            let words = [piece.len() as u32, first as u32, self.scale.to_bits()];
            let buffers = [
                &device.uniform(&words),
                weights,
                &directions[at],
                &self.light[at],
                &self.pixels[at],
                &albedo[at],
                &self.gradient[at],
                &self.losses,
            ];
            let groups = piece.len().div_ceil(TILE);
            let [forward, _] = layout.flops();
            // Two directions, Fresnel factor, colour, weight, albedos, light.
            let values = 15 + layout.outputs() + DIRECTION_ROWS;
            let pass = Pass::new(device, &kernel, &buffers, groups);
            passes.push(pass.doing(piece.len(), 2 * 2 * forward, values));
            first += groups;
        }
        passes
    }
}

/// One evaluation.
pub(super) fn direction_gradient(
    device: &Device,
    networks: &Networks,
    samples: &Samples,
    light: &Planes,
    directions: &Planes,
    albedo: &Planes,
) -> Result<(f64, Planes), DeviceError> {
    let layout = Layout::new(&networks.shape);
    let pieces = Pieces::new(device, samples.len(), networks.outputs());
    let directions = pieces.upload(device, "directions", &[directions]);
    let albedo = pieces.upload(device, "albedos", &[albedo]);
    let kernels = DirectionGradient::new(device, pieces, samples, light);
    let weights = device.filled("networks", &layout.pack(&networks.parameters));
    device.submit(&kernels.passes(device, &layout, &weights, &directions, &albedo), None, 1);
    let mut buffers = vec![&kernels.losses];
    buffers.extend(&kernels.gradient);
    let contents = device.read::<f32>(&buffers)?;
    let loss = contents[0][..kernels.groups].iter().map(|loss| f64::from(*loss)).sum();
    Ok((loss, kernels.pieces.planes(DIRECTION_ROWS, &contents[1..])))
}
