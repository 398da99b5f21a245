//! Networks and albedos together: once, or step after step.

use super::computing::Gpu;
use super::device::Device;
use super::layout::{Layout, TILE};
use super::pass::Pass;
use super::pieces::{DeviceTaps, Pieces, padded, pixels};
use super::program::{Moved, Program, prior};
use crate::backend::resident::DeviceError;
use crate::backend::{ALBEDOS, JointGradient};
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// Workgroups that walk the samples: several times what a large GPU holds at once (an H200 about 660), so
/// that the last ones to run leave it idle for a small part of the time alone.
const GROUPS: usize = 4096;
/// Fewest workgroups of a piece, if it has that many tiles.
const LEAST_GROUPS: usize = 256;
/// Fewest tiles of a workgroup: its sums are as large as four tiles' inputs.
const TILES: usize = 4;

/// Floats of a sample: position, two directions, Fresnel factor, colour, weight, albedos.
const INPUTS: usize = 18;

/// Buffers of the joint kernel besides weights.
pub(super) struct Joint {
    pieces: Pieces,
    /// Sampled albedos and their gradients.
    pub albedo: Vec<wgpu::Buffer>,
    pub by_albedo: Vec<wgpu::Buffer>,
    partial: wgpu::Buffer,
    /// Partial sums, as many as there are workgroups.
    pub losses: wgpu::Buffer,
    /// Workgroups of each piece.
    pub groups: Vec<usize>,
}

impl Joint {
    pub fn new(
        device: &Device,
        layout: &Layout,
        pieces: Pieces,
        albedo: Vec<wgpu::Buffer>,
    ) -> Self {
        let most = LEAST_GROUPS.max(GROUPS / pieces.0.len().max(1));
        let groups: Vec<usize> =
            pieces.0.iter().map(|piece| (padded(piece) / TILE / TILES).clamp(1, most)).collect();
        let all: usize = groups.iter().sum();
        Self {
            albedo,
            by_albedo: pieces.zeros(device, "albedo gradients", ALBEDOS),
            partial: device.floats("partial sums", all * layout.partial_floats()),
            losses: device.floats("partial losses", all),
            groups,
            pieces,
        }
    }

    /// The passes that leave the gradients of the networks in `gradient`, and those of the sampled
    /// albedos.
    pub fn passes(
        &self,
        device: &Device,
        layout: &Layout,
        samples: &Samples,
        directions: &Planes,
        weights: &wgpu::Buffer,
        gradient: &wgpu::Buffer,
    ) -> Vec<Pass> {
        let source = [include_str!("wgsl/pixel.wgsl"), include_str!("wgsl/joint.wgsl")].concat();
        let kernel = layout.kernel(device, "networks", &source, &[], "unrrrrwww");
        let position = self.pieces.upload(device, "positions", &[&samples.position]);
        let directions = self.pieces.upload(device, "directions", &[directions]);
        let pixels = pixels(device, &self.pieces, samples);
        let scale = 1.0 / (3.0 * samples.len() as f32);
        let mut first = 0;
        let mut passes = vec![];
        for (at, (piece, groups)) in self.pieces.0.iter().zip(&self.groups).enumerate() {
            let tiles = (padded(piece) / TILE) as u32;
            let words = [tiles, *groups as u32, first as u32, scale.to_bits(), 0];
            let parameters = device.uniform(&words);
            let buffers = [
                &parameters,
                weights,
                &position[at],
                &directions[at],
                &pixels[at],
                &self.albedo[at],
                &self.by_albedo[at],
                &self.partial,
                &self.losses,
            ];
            let [forward, back] = layout.flops();
            let pass = Pass::new(device, &kernel, &buffers, *groups)
                .doing(piece.len(), 3 * (2 * forward + back), INPUTS + ALBEDOS)
                .doing(*groups, 0, layout.partial_floats());
            passes.push(pass);
            first += groups;
        }
        passes.push(layout.summing(device, first, &self.partial, gradient));
        passes
    }
}

/// One evaluation.
pub(super) fn joint(
    device: &Device,
    layout: &Layout,
    networks: &Networks,
    samples: &Samples,
    directions: &Planes,
    albedo: &Planes,
) -> Result<JointGradient, DeviceError> {
    let pieces = Pieces::new(device, samples.len(), ALBEDOS);
    let albedo = pieces.upload(device, "albedos", &[albedo]);
    let joint = Joint::new(device, layout, pieces, albedo);
    let weights = device.filled("networks", &layout.pack(&networks.parameters));
    let gradient = device.floats("gradient", 4 * layout.vectors());
    let passes = joint.passes(device, layout, samples, directions, &weights, &gradient);
    device.submit(&passes, None, 1);
    let mut buffers = vec![&gradient, &joint.losses];
    buffers.extend(&joint.by_albedo);
    let contents = device.read::<f32>(&buffers)?;
    let groups = joint.groups.iter().sum();
    Ok(JointGradient {
        loss: contents[1][..groups].iter().map(|loss| f64::from(*loss)).sum(),
        networks: layout.unpack(&contents[0]),
        albedo: joint.pieces.planes(ALBEDOS, &contents[2..]),
    })
}

/// The warm-up.
pub(super) fn program<'a>(
    gpu: &'a Gpu,
    layout: Layout,
    samples: &Samples,
    directions: &Planes,
    weight: f32,
) -> Program<'a> {
    let device = &gpu.device;
    let pieces = Pieces::new(device, samples.len(), ALBEDOS);
    let taps = DeviceTaps::new(device, &pieces, &samples.taps);
    let size = samples.taps.size();
    let albedo = pieces.zeros(device, "albedos", ALBEDOS);
    let joint = Joint::new(device, &layout, pieces, albedo);
    let weights = Moved::new(device, "networks", 4 * layout.vectors());
    let diffuse = Moved::new(device, "diffuse albedo", 3 * size * size);
    let specular = Moved::new(device, "specular albedo", size * size);

    let mut passes = taps.sample(device, &diffuse.values, 3, &joint.albedo, [0, ALBEDOS]);
    passes.extend(taps.sample(device, &specular.values, 1, &joint.albedo, [3, ALBEDOS]));
    let (values, gradient) = (&weights.values, &weights.gradient);
    passes.extend(joint.passes(device, &layout, samples, directions, values, gradient));
    let (prior_pass, prior_sums) = prior(device, &diffuse, size, weight).unzip();
    let add = prior_pass.is_some();
    passes.extend(prior_pass);
    let by_albedo = &joint.by_albedo;
    passes.extend(taps.gather(device, by_albedo, [0, ALBEDOS], &diffuse.gradient, 3, add));
    passes.extend(taps.gather(device, by_albedo, [3, ALBEDOS], &specular.gradient, 1, false));
    let groups = joint.groups.iter().sum();
    let mut losses = vec![(joint.losses, groups)];
    losses.extend(prior_sums);
    let weights = weights.in_layout(layout);
    Program::new(gpu, passes, &losses, vec![weights, diffuse, specular])
}
