//! An adapter that computes, until it fails.

use std::sync::OnceLock;
use std::time::Duration;

use super::adapter::Adapter;
use super::ceilings::{self, Ceilings};
use super::device::{Device, locked};
use super::layout::Layout;
use super::timings::Timings;
use crate::backend::Backend;
use crate::backend::cpu::Cpu;
use crate::backend::error::BackendError;
use crate::backend::resident::DeviceError;

/// An adapter that computes.
pub struct Gpu {
    pub(super) device: Device,
    pub(super) name: String,
    /// The backend after a failure of the device.
    pub(super) cpu: Cpu,
    /// The failure.
    pub(super) failure: OnceLock<DeviceError>,
}

impl Gpu {
    /// Opens a device on this adapter.
    pub fn open(adapter: &Adapter) -> Result<Self, BackendError> {
        let refused = |error: DeviceError| BackendError::Refused {
            name: adapter.name.clone(),
            reason: error.to_string(),
        };
        let device = Device::open(&adapter.adapter).map_err(refused)?;
        let Adapter { name, api, driver, .. } = adapter;
        let name = format!("gpu, {name}, {api}, {driver}");
        Ok(Self { device, name, cpu: Cpu::new(), failure: OnceLock::new() })
    }

    /// Limits the samples of a piece and the workgroups of a grid along one axis, as if bindings and grids were this
    /// small.
    #[must_use]
    pub fn in_pieces(mut self, samples: usize, axis: usize) -> Self {
        (self.device.piece, self.device.axis) = (samples, axis);
        self
    }

    /// Returns the result of `work` and the time of each of its passes, which slows the work; no times if the adapter has
    /// no clock.
    pub fn timed<T>(&self, work: impl FnOnce() -> T) -> (T, Option<Timings>) {
        if self.device.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            *locked(&self.device.timings) = Some(Timings::new());
        }
        let result = work();
        (result, locked(&self.device.timings).take())
    }

    /// The ceilings of compute kernels: multiply-adds, and bandwidth on three arrays of `bytes` each. `budget` is the
    /// time for each.
    pub fn ceilings(&self, bytes: usize, budget: Duration) -> Result<Ceilings, DeviceError> {
        ceilings::ceilings(&self.device, bytes, budget)
    }

    /// Bytes that this program has allocated on the device, if its driver counts them.
    pub fn memory(&self) -> Option<u64> {
        self.device.device.generate_allocator_report().map(|report| report.total_allocated_bytes)
    }

    /// Releases the device. Further work runs on the processor.
    pub fn destroy(&self) {
        self.device.device.destroy();
    }

    /// `run` on the device, or after a failure `otherwise` on the processor.
    pub(super) fn either<T>(
        &self,
        run: impl FnOnce(&Device) -> Result<T, DeviceError>,
        otherwise: impl FnOnce(&Cpu) -> T,
    ) -> T {
        if self.failure.get().is_none() {
            match run(&self.device) {
                Ok(result) => return result,
                Err(error) => self.mark_failed(&error),
            }
        }
        otherwise(&self.cpu)
    }

    pub(super) fn mark_failed(&self, error: &DeviceError) {
        if self.failure.set(error.clone()).is_ok() {
            tracing::warn!("{}: {error}; the rest runs on {}", self.name, self.cpu.name());
        }
    }

    /// Whether the kernel of the joint gradient fits the adapter's workgroups.
    pub(super) fn fits(&self, layout: &Layout) -> bool {
        let most = self.device.device.limits().max_compute_workgroup_storage_size;
        layout.workgroup_bytes() <= most as usize
    }
}
