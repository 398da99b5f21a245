//! Dispatches that are recorded once and submitted often, with the values that differ between steps.

use std::sync::Arc;

use super::device::Device;
use super::kernel::{Kernel, slot_layout};
use crate::backend::resident::Variable;
use crate::fit::adam::Adam;

/// Threads of a workgroup of the kernels that have one thread per value.
pub(super) const THREADS: usize = 256;
/// Distance of uniforms with dynamic offsets; the default limit of WebGPU.
const SLOT: usize = 256;

/// The least operations and bytes of a dispatch.
#[derive(Clone, Copy, Default)]
pub(super) struct Work {
    /// Floating-point operations, a multiply-add being two.
    pub flops: f64,
    /// Bytes from and to memory, every value read once and written once.
    pub bytes: f64,
}

/// A dispatch with its buffers.
pub(super) struct Pass {
    kernel: Arc<Kernel>,
    buffers: wgpu::BindGroup,
    slot: Option<usize>,
    grid: [u32; 2],
    pub work: Work,
}

impl Pass {
    /// A pass of any number of workgroups.
    pub fn new(
        device: &Device,
        kernel: &Arc<Kernel>,
        buffers: &[&wgpu::Buffer],
        workgroups: usize,
    ) -> Self {
        let entries: Vec<_> = buffers
            .iter()
            .enumerate()
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let buffers = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(kernel.name),
            layout: &kernel.layout,
            entries: &entries,
        });
        let rows = workgroups.div_ceil(device.axis).max(1);
        let grid = [workgroups.div_ceil(rows) as u32, rows as u32];
        Self { kernel: Arc::clone(kernel), buffers, slot: None, grid, work: Work::default() }
    }

    /// A pass with one thread for each of `count` values.
    pub fn over(
        device: &Device,
        kernel: &Arc<Kernel>,
        buffers: &[&wgpu::Buffer],
        count: usize,
    ) -> Self {
        Self::new(device, kernel, buffers, count.div_ceil(THREADS))
    }

    /// Reads the step's slot number `slot`.
    #[must_use]
    pub fn with_slot(self, slot: usize) -> Self {
        Self { slot: Some(slot), ..self }
    }

    /// Adds the cost of `count` items: operations, and values read or written.
    #[must_use]
    pub fn doing(self, count: usize, flops: usize, values: usize) -> Self {
        let (flops, bytes) = ((count * flops) as f64, (4 * count * values) as f64);
        let work = Work { flops: self.work.flops + flops, bytes: self.work.bytes + bytes };
        Self { work, ..self }
    }

    pub fn name(&self) -> &'static str {
        self.kernel.name
    }

    pub fn encode(&self, pass: &mut wgpu::ComputePass, slots: Option<&Slots>, step: usize) {
        pass.set_pipeline(&self.kernel.pipeline);
        pass.set_bind_group(0, &self.buffers, &[]);
        if let (Some(slot), Some(slots)) = (self.slot, slots) {
            let offset = (step * slots.per_step + slot) * SLOT;
            pass.set_bind_group(1, &slots.bindings, &[offset as u32]);
        }
        pass.dispatch_workgroups(self.grid[0], self.grid[1], 1);
    }
}

/// The values that differ between steps: factors of the optimisers, and the index of the loss.
pub(super) struct Slots {
    buffer: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    per_step: usize,
}

impl Slots {
    /// `per_step` slots for each of `steps` steps.
    pub fn new(device: &Device, per_step: usize, steps: usize) -> Self {
        let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("slots"),
            size: (per_step * steps * SLOT) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bindings = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("slots"),
            layout: &slot_layout(&device.device),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &buffer,
                    offset: 0,
                    size: std::num::NonZeroU64::new(4 * Factors::WORDS as u64),
                }),
            }],
        });
        Self { buffer, bindings, per_step }
    }

    /// Writes the slots, step by step.
    pub fn write(&self, device: &Device, slots: &[Factors]) {
        let mut bytes = vec![0u8; slots.len() * SLOT];
        for (slot, factors) in bytes.chunks_exact_mut(SLOT).zip(slots) {
            slot[..4 * Factors::WORDS].copy_from_slice(bytemuck::cast_slice(&factors.0));
        }
        device.queue.write_buffer(&self.buffer, 0, &bytes);
    }
}

/// A slot's content; see `struct Factors` in `adam.wgsl`.
#[derive(Clone, Copy)]
pub(super) struct Factors([u32; Self::WORDS]);

impl Factors {
    const WORDS: usize = 12;

    /// The factors of a variable's step number `number`, from 1.
    pub fn adam(variable: &AdamFactors, number: usize, decay: f32, step: usize) -> Self {
        let [rate, root] = variable.optimiser.factors(number as i32, decay);
        let c = variable.optimiser.config();
        let floats = [rate, root, c.beta1, c.beta2, c.epsilon, variable.minimum].map(f32::to_bits);
        let [a, b, c, d, e, f] = floats;
        Self([a, b, c, d, e, f, 1, step as u32, variable.maximum.to_bits(), 0, 0, 0])
    }

    /// The factors of a constant variable.
    pub fn still(step: usize) -> Self {
        Self([0, 0, 0, 0, 0, 0, 0, step as u32, 0, 0, 0, 0])
    }
}

/// A variable's optimiser and bounds, for a device.
pub(super) struct AdamFactors {
    optimiser: Adam,
    minimum: f32,
    maximum: f32,
}

impl AdamFactors {
    pub fn of(variable: &Variable) -> Self {
        // Large numbers instead of infinity, which shaders may assume not to occur.
        let (minimum, maximum) = (variable.minimum.max(f32::MIN), variable.maximum.min(f32::MAX));
        Self { optimiser: variable.adam.without_moments(), minimum, maximum }
    }
}
