//! A device with its queue: kernels, buffers, submissions, and its first fault.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::kernel::Kernel;
use super::timings::Timings;
use super::unroll::unrolled;
use crate::backend::resident::DeviceError;
use crate::model::planes::BLOCK;

/// Workgroups along one axis; a limit of WebGPU.
const AXIS: usize = 65535;
/// Largest number of rows of a piece.
pub(super) const PIECE_ROWS: usize = 16;
/// Largest number of samples of a piece: bindings of 512 MiB. Larger pieces are not faster.
const LARGEST: usize = 1 << 23;

/// An open device.
pub(super) struct Device {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// The first fault.
    fault: Arc<OnceLock<String>>,
    kernels: Mutex<HashMap<String, Arc<Kernel>>>,
    /// Samples of a piece; see [`super::pieces`].
    pub piece: usize,
    /// Workgroups along one axis of a grid.
    pub axis: usize,
    /// The times of passes, while they are measured.
    pub timings: Mutex<Option<Timings>>,
}

impl Device {
    pub fn open(adapter: &wgpu::Adapter) -> Result<Self, DeviceError> {
        let most = adapter.limits();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("unshade"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: wgpu::Limits {
                max_buffer_size: most.max_buffer_size,
                max_storage_buffer_binding_size: most.max_storage_buffer_binding_size,
                max_compute_workgroup_storage_size: most.max_compute_workgroup_storage_size,
                ..wgpu::Limits::default()
            },
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| DeviceError(one_line(&error.to_string())))?;
        let fault = Arc::new(OnceLock::new());
        let heard = Arc::clone(&fault);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let what = match &error {
                wgpu::Error::OutOfMemory { .. } => "out of memory".to_owned(),
                error => one_line(&error.to_string()),
            };
            let _ = heard.set(what);
        }));
        let heard = Arc::clone(&fault);
        device.set_device_lost_callback(move |reason, message| {
            let _ = heard.set(one_line(&format!("device lost ({reason:?}) {message}")));
        });
        let piece = largest_piece(most.max_storage_buffer_binding_size);
        let (kernels, timings) = (Mutex::default(), Mutex::default());
        Ok(Self { device, queue, fault, kernels, piece, axis: AXIS, timings })
    }

    /// An error if there has been a fault since the device was opened.
    pub fn check(&self) -> Result<(), DeviceError> {
        match self.fault.get() {
            Some(fault) => Err(DeviceError(fault.clone())),
            None => Ok(()),
        }
    }

    /// A kernel, compiled at its first use. See [`Kernel::new`].
    pub fn kernel(
        &self,
        name: &'static str,
        source: &str,
        constants: &[(&str, u32)],
        bindings: &str,
    ) -> Arc<Kernel> {
        let head = constants.iter().map(|(name, value)| format!("const {name}: u32 = {value}u;\n"));
        let source = head.collect::<String>() + &unrolled(source, constants);
        let mut kernels = locked(&self.kernels);
        let compile = || Arc::new(Kernel::new(&self.device, name, &source, bindings));
        Arc::clone(kernels.entry(source.clone()).or_insert_with(compile))
    }

    /// A buffer of `count` zeros.
    pub fn floats(&self, name: &'static str, count: usize) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: 4 * count.max(4) as u64,
            usage: STORAGE,
            mapped_at_creation: false,
        })
    }

    /// A buffer with this content.
    pub fn filled<T: bytemuck::Pod>(&self, name: &'static str, content: &[T]) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(content);
        self.pieces(name, bytes.len(), STORAGE, [bytes].into_iter())
    }

    /// A uniform buffer of whole words; floats as their bits.
    pub fn uniform(&self, words: &[u32]) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(words);
        self.pieces("parameters", bytes.len(), wgpu::BufferUsages::UNIFORM, [bytes].into_iter())
    }

    /// A buffer of `count` floats, filled row by row.
    pub fn rows<'a>(
        &self,
        name: &'static str,
        count: usize,
        rows: impl Iterator<Item = &'a [f32]>,
    ) -> wgpu::Buffer {
        self.pieces(name, 4 * count, STORAGE, rows.map(bytemuck::cast_slice))
    }

    fn pieces<'a>(
        &self,
        name: &'static str,
        size: usize,
        usage: wgpu::BufferUsages,
        pieces: impl Iterator<Item = &'a [u8]>,
    ) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: size.next_multiple_of(16).max(16) as u64,
            usage,
            mapped_at_creation: true,
        });
        // Without memory or after the loss of the device there is no range; `check` reports the fault.
        if let Ok(mut range) = buffer.get_mapped_range_mut(..) {
            let mut at = 0;
            for piece in pieces {
                range.slice(at..at + piece.len()).copy_from_slice(piece);
                at += piece.len();
            }
        }
        buffer.unmap();
        if size > STAGED {
            // A failure is a fault of the device, which `check` reports.
            self.queue.submit([]);
            let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
        }
        buffer
    }

    /// Waits for all submissions.
    pub fn wait(&self) -> Result<(), DeviceError> {
        self.check()?;
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map(drop).map_err(|error| DeviceError(one_line(&error.to_string())))
    }

    /// Reads these buffers after all submissions.
    pub fn read<T: bytemuck::Pod>(
        &self,
        buffers: &[&wgpu::Buffer],
    ) -> Result<Vec<Vec<T>>, DeviceError> {
        self.check()?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let copies: Vec<wgpu::Buffer> = buffers
            .iter()
            .map(|buffer| {
                let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("read back"),
                    size: buffer.size(),
                    usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
                copy
            })
            .collect();
        self.queue.submit([encoder.finish()]);
        copies.iter().for_each(|copy| copy.slice(..).map_async(wgpu::MapMode::Read, |_| {}));
        self.wait()?;
        let content = |copy: &wgpu::Buffer| match copy.slice(..).get_mapped_range() {
            Ok(range) => Ok(bytemuck::pod_collect_to_vec(&range)),
            Err(error) => Err(DeviceError(one_line(&error.to_string()))),
        };
        copies.iter().map(content).collect()
    }
}

/// The samples of a piece on a device with bindings of this size: 2 million for 128 MiB, the least of any adapter.
fn largest_piece(binding: u64) -> usize {
    usize::try_from(binding).map_or(LARGEST, |bytes| (bytes / (4 * PIECE_ROWS)).min(LARGEST))
        / BLOCK
        * BLOCK
}

const STORAGE: wgpu::BufferUsages = wgpu::BufferUsages::STORAGE
    .union(wgpu::BufferUsages::UNIFORM)
    .union(wgpu::BufferUsages::COPY_SRC)
    .union(wgpu::BufferUsages::COPY_DST);

/// Size above which an upload is finished before the next one begins, to save host memory, bytes.
const STAGED: usize = 32 << 20;

/// The protected data is consistent even after a panic.
pub(super) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Joins the several lines of drivers' messages.
pub(super) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
