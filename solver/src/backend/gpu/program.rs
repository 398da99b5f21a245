//! The program of a fit: its passes, recorded once, and its variables.

use super::computing::Gpu;
use super::device::Device;
use super::layout::Layout;
use super::pass::{AdamFactors, Factors, Pass, Slots, THREADS};
use crate::backend::resident::{BATCH, DeviceError, Resident, Variable};

/// Values on the device, with their gradient and moments.
pub(super) struct Moved {
    pub values: wgpu::Buffer,
    pub gradient: wgpu::Buffer,
    moments: [wgpu::Buffer; 2],
    count: usize,
    /// The packed order of networks' parameters on the device.
    layout: Option<Layout>,
    factors: Option<AdamFactors>,
}

impl Moved {
    pub fn new(device: &Device, name: &'static str, count: usize) -> Self {
        Self {
            values: device.floats(name, count),
            gradient: device.floats("gradient", count),
            moments: ["first moment", "second moment"].map(|name| device.floats(name, count)),
            count,
            layout: None,
            factors: None,
        }
    }

    /// Networks, which have another order on the host.
    pub fn in_layout(self, layout: Layout) -> Self {
        Self { layout: Some(layout), ..self }
    }

    fn to_device(&self, values: &[f32]) -> Vec<u8> {
        let packed = self.layout.as_ref().map(|layout| layout.pack(values));
        bytemuck::cast_slice(packed.as_deref().unwrap_or(values)).to_vec()
    }

    fn to_host(&self, mut values: Vec<f32>) -> Vec<f32> {
        values.truncate(self.count);
        self.layout.as_ref().map_or_else(|| values.clone(), |layout| layout.unpack(&values))
    }
}

/// Partial sums of a term of the loss, and their number.
pub(super) type LossPart = (wgpu::Buffer, usize);

/// A fit on the device.
pub(super) struct Program<'a> {
    gpu: &'a Gpu,
    passes: Vec<Pass>,
    slots: Slots,
    losses: wgpu::Buffer,
    moved: Vec<Moved>,
    /// The number of steps taken.
    done: usize,
}

impl<'a> Program<'a> {
    /// `gradients` are the passes that write the gradients of everything in `moved`, which has the order of the host's
    /// variables.
    pub fn new(gpu: &'a Gpu, gradients: Vec<Pass>, loss: &[LossPart], moved: Vec<Moved>) -> Self {
        let device = &gpu.device;
        let mut passes = gradients;
        let adam = device.kernel("adam", include_str!("wgsl/adam.wgsl"), &[], "uwrww+");
        for (slot, moved) in moved.iter().enumerate() {
            let parameters = device.uniform(&[moved.count as u32]);
            let [first, second] = &moved.moments;
            let buffers = [&parameters, &moved.values, &moved.gradient, first, second];
            let pass = Pass::over(device, &adam, &buffers, moved.count).with_slot(slot);
            passes.push(pass.doing(moved.count, 14, 7));
        }
        let losses = device.floats("losses", BATCH);
        for (at, (parts, count)) in loss.iter().enumerate() {
            passes.extend(total(device, parts, [0, *count], &losses, true, at > 0));
        }
        let slots = Slots::new(device, moved.len(), BATCH);
        Self { gpu, passes, slots, losses, moved, done: 0 }
    }

    fn check<T>(&self, result: Result<T, DeviceError>) -> Result<T, DeviceError> {
        result.inspect_err(|error| self.gpu.mark_failed(error))
    }
}

/// Parts that one workgroup sums; many workgroups hide the latency of memory.
const SHARE: usize = 4096;

/// The pass that sums `count` parts from `first` on into the step's slot, or the first slot; with `add`, to its value.
pub(super) fn total(
    device: &Device,
    parts: &wgpu::Buffer,
    [first, count]: [usize; 2],
    to: &wgpu::Buffer,
    by_step: bool,
    add: bool,
) -> Vec<Pass> {
    let groups = count.div_ceil(SHARE).max(1);
    if groups > 1 {
        let between = device.floats("sums", groups);
        let mut passes = vec![sums(device, parts, [first, count], &between, [false; 2])];
        passes.extend(total(device, &between, [0, groups], to, by_step, add));
        return passes;
    }
    vec![sums(device, parts, [first, count], to, [by_step, add])]
}

/// The pass that sums partial sums, share by share.
fn sums(
    device: &Device,
    parts: &wgpu::Buffer,
    [first, count]: [usize; 2],
    to: &wgpu::Buffer,
    [by_step, add]: [bool; 2],
) -> Pass {
    let kernel = device.kernel("sum", include_str!("wgsl/total.wgsl"), &[], "urw+");
    let words = [first, count, SHARE, usize::from(by_step), usize::from(add)];
    let parameters = device.uniform(&words.map(|word| word as u32));
    let groups = count.div_ceil(SHARE).max(1);
    let pass = Pass::new(device, &kernel, &[&parameters, parts, to], groups);
    pass.with_slot(0).doing(count, 1, 1)
}

/// The pass of the albedo prior, which overwrites the gradient; `None` without a weight.
pub(super) fn prior(
    device: &Device,
    albedo: &Moved,
    size: usize,
    weight: f32,
) -> Option<(Pass, LossPart)> {
    if weight == 0.0 {
        return None;
    }
    let kernel = device.kernel("prior", include_str!("wgsl/prior.wgsl"), &[], "urww");
    let scale = weight / albedo.count as f32;
    let parameters = device.uniform(&[size as u32, scale.to_bits()]);
    let groups = albedo.count.div_ceil(THREADS);
    let sums = device.floats("prior", groups);
    let buffers = [&parameters, &albedo.values, &albedo.gradient, &sums];
    let pass = Pass::new(device, &kernel, &buffers, groups).doing(albedo.count, 40, 2);
    Some((pass, (sums, groups)))
}

impl Resident for Program<'_> {
    fn upload(&mut self, variables: &[Variable]) -> Result<(), DeviceError> {
        let queue = &self.gpu.device.queue;
        self.done = variables.first().map_or(0, |variable| variable.adam.steps());
        for (moved, variable) in self.moved.iter_mut().zip(variables) {
            let [first, second] = variable.adam.moments();
            let places = [&moved.values, &moved.moments[0], &moved.moments[1]];
            for (place, content) in places.into_iter().zip([variable.values, first, second]) {
                queue.write_buffer(place, 0, &moved.to_device(content));
            }
            moved.factors = Some(AdamFactors::of(variable));
        }
        self.check(self.gpu.device.check())
    }

    fn steps(&mut self, rate_factors: &[f32]) -> Result<Vec<f64>, DeviceError> {
        let device = &self.gpu.device;
        let factors: Vec<Factors> = rate_factors
            .iter()
            .enumerate()
            .flat_map(|(step, decay)| {
                let number = self.done + step + 1;
                self.moved.iter().map(move |moved| match &moved.factors {
                    Some(factors) => Factors::adam(factors, number, *decay, step),
                    _ => Factors::still(step),
                })
            })
            .collect();
        self.slots.write(device, &factors);
        device.submit(&self.passes, Some(&self.slots), rate_factors.len());
        let losses = self.check(device.read::<f32>(&[&self.losses]))?;
        self.done += rate_factors.len();
        Ok(losses[0][..rate_factors.len()].iter().map(|loss| f64::from(*loss)).collect())
    }

    fn download(&mut self, variables: &mut [Variable]) -> Result<(), DeviceError> {
        let buffers: Vec<&wgpu::Buffer> = self
            .moved
            .iter()
            .flat_map(|moved| [&moved.values, &moved.moments[0], &moved.moments[1]])
            .collect();
        let mut contents = self.check(self.gpu.device.read::<f32>(&buffers))?.into_iter();
        for (moved, variable) in self.moved.iter().zip(variables) {
            let mut next = || moved.to_host(contents.next().unwrap_or_default());
            *variable.values = next();
            let (first, second) = (next(), next());
            variable.adam.restore(self.done, first, second);
        }
        Ok(())
    }
}
