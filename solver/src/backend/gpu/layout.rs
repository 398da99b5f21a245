//! Networks as the kernels read them: blocks of 4 x 4 weights, so that a layer is a few products of
//! matrices and vectors, forwards and, from the left, backwards.

use super::device::Device;
use super::kernel::Kernel;
use super::pass::Pass;
use crate::model::networks::{Network, Networks};

/// Bytes of a uniform buffer; a limit of WebGPU.
const UNIFORM: usize = 64 << 10;
/// Vectors of a thread's partial sums: a block's columns, and a bias.
const PARTIAL: usize = 5;
/// Samples of a tile of `joint.wgsl`, and its threads.
pub(super) const TILE: usize = 64;

/// The networks' shape in vectors of 4, and where each parameter goes.
pub(super) struct Layout {
    width: usize,
    hidden: usize,
    outputs: usize,
    /// The place of every parameter among the packed floats.
    place: Vec<u32>,
}

impl Layout {
    pub fn new(shape: &[usize]) -> Self {
        let (width, hidden) = (shape[1] / 4, shape.len() - 2);
        let outputs = shape[shape.len() - 1] / 4;
        let mut layout = Self { width, hidden, outputs, place: vec![] };
        layout.place = layout.places(shape);
        layout
    }

    fn places(&self, shape: &[usize]) -> Vec<u32> {
        let networks = Networks { shape: shape.to_vec(), parameters: vec![] };
        let mut place = vec![];
        for network in Network::ALL {
            let base = network as usize * self.network();
            let mut bias = base + 4 * self.blocks();
            let mut block = 0;
            for layer in 0..networks.layers() {
                let (inputs, outputs) = (shape[layer], shape[layer + 1]);
                // A weight's place: its block, the column in that, the element in the column.
                let at = |output: usize, input: usize| {
                    let block = block + output / 4 * inputs.div_ceil(4) + input / 4;
                    (4 * (base + 4 * block + input % 4) + output % 4) as u32
                };
                for output in 0..outputs {
                    place.extend((0..inputs).map(|input| at(output, input)));
                }
                if layer == 0 {
                    place.extend((0..outputs).map(|output| at(output, 3)));
                } else {
                    place.extend((0..outputs).map(|output| (4 * bias + output) as u32));
                    bias += outputs / 4;
                }
                block += outputs / 4 * inputs.div_ceil(4);
            }
        }
        place
    }

    fn blocks(&self) -> usize {
        self.width * (1 + (self.hidden - 1) * self.width + self.outputs)
    }

    /// Vectors of one network.
    fn network(&self) -> usize {
        4 * self.blocks() + (self.hidden - 1) * self.width + self.outputs
    }

    /// Vectors of all networks.
    pub fn vectors(&self) -> usize {
        3 * self.network()
    }

    /// Operations of a sample on its way through one network: forward, and back to the hidden layers.
    pub fn flops(&self) -> [usize; 2] {
        let (blocks, first) = (self.blocks(), self.width);
        // The first blocks have three columns and the biases.
        [32 * blocks - 8 * first, 32 * (blocks - first)]
    }

    /// Number of outputs of a network.
    pub fn outputs(&self) -> usize {
        4 * self.outputs
    }

    /// Floats of the partial sums of one workgroup of `joint.wgsl`.
    pub fn partial_floats(&self) -> usize {
        3 * self.blocks().div_ceil(TILE) * TILE * PARTIAL * 4
    }

    /// Workgroup memory of `joint.wgsl`.
    pub fn workgroup_bytes(&self) -> usize {
        let rows = 1 + 2 * self.hidden * self.width + self.outputs;
        16 * rows * (TILE + 1) + 4 * TILE
    }

    /// Reorders parameters into blocks, padded with zeros.
    pub fn pack(&self, parameters: &[f32]) -> Vec<f32> {
        let mut packed = vec![0.0; 4 * self.vectors()];
        self.place
            .iter()
            .zip(parameters)
            .for_each(|(place, value)| packed[*place as usize] = *value);
        packed
    }

    /// The reverse of [`Layout::pack`].
    pub fn unpack(&self, packed: &[f32]) -> Vec<f32> {
        self.place.iter().map(|place| packed[*place as usize]).collect()
    }

    /// A kernel that evaluates networks: its source follows theirs, its weights are binding 1.
    /// `bindings` has a `n` for them.
    pub fn kernel(
        &self,
        device: &Device,
        name: &'static str,
        source: &str,
        constants: &[(&str, u32)],
        bindings: &str,
    ) -> std::sync::Arc<Kernel> {
        // Uniforms are read through the constants' cache, where all threads want the same weight.
        let vectors = self.vectors();
        let (weights, letter) = match 16 * vectors <= UNIFORM {
            true => (format!("var<uniform> weights: array<vec4<f32>, {vectors}>"), "u"),
            false => ("var<storage, read> weights: array<vec4<f32>>".to_owned(), "r"),
        };
        let source =
            ["@group(0) @binding(1) ", &weights, ";\n", include_str!("wgsl/networks.wgsl"), source]
                .concat();
        let all = [constants, &self.constants()].concat();
        device.kernel(name, &source, &all, &bindings.replace('n', letter))
    }

    /// The pass that adds up the partial sums of `groups` workgroups.
    pub fn summing(
        &self,
        device: &Device,
        groups: usize,
        partial: &wgpu::Buffer,
        gradient: &wgpu::Buffer,
    ) -> Pass {
        let source = include_str!("wgsl/weights.wgsl");
        let kernel = device.kernel("weight gradients", source, &self.constants(), "urw");
        let parameters = device.uniform(&[groups as u32]);
        let pass = Pass::new(device, &kernel, &[&parameters, partial, gradient], self.vectors());
        pass.doing(groups * self.partial_floats(), 1, 1)
    }

    fn constants(&self) -> [(&'static str, u32); 5] {
        [
            ("W", self.width as u32),
            ("H", self.hidden as u32),
            ("O", self.outputs as u32),
            ("HIDDEN", (self.hidden * self.width) as u32),
            ("SHARES", self.blocks().div_ceil(TILE) as u32),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_has_a_place_of_its_own_and_comes_back() {
        for shape in [[3, 16, 16, 8].as_slice(), &[3, 20, 20, 20, 4], &[3, 8, 4]] {
            let layout = Layout::new(shape);
            let parameters: Vec<f32> = (0..layout.place.len()).map(|i| 1.0 + i as f32).collect();
            let packed = layout.pack(&parameters);
            assert_eq!(packed.iter().filter(|value| **value != 0.0).count(), parameters.len());
            assert_eq!(layout.unpack(&packed), parameters);
        }
    }

    #[test]
    fn the_published_networks_fit_a_uniform_buffer_and_a_small_workgroup() {
        let layout = Layout::new(&[3, 16, 16, 8]);
        assert_eq!((layout.blocks(), layout.vectors()), (28, 354));
        assert_eq!(layout.flops(), [864, 768]);
        assert!(16 * layout.vectors() <= UNIFORM);
        assert!(layout.workgroup_bytes() <= 32 << 10);
    }
}
