//! A device with its queue: kernels, buffers, submissions, and what went wrong with it.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::kernel::{Kernel, Pass, Slots};
use super::pieces::PIECE;
use super::unroll::unrolled;
use crate::backend::resident::DeviceError;

/// Time on the device by pass: its name, milliseconds, dispatches.
pub type Timings = BTreeMap<&'static str, (f64, usize)>;

/// Queries of one submission; a limit of WebGPU.
const QUERIES: u32 = 4096;

/// An open device.
pub(super) struct Device {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// The first thing that went wrong.
    fault: Arc<OnceLock<String>>,
    kernels: Mutex<HashMap<String, Arc<Kernel>>>,
    /// Samples of a piece; see [`super::pieces`].
    pub piece: usize,
    /// Present if passes are timed.
    timings: Option<Mutex<Timings>>,
}

impl Device {
    pub fn open(adapter: &wgpu::Adapter, timed: bool) -> Result<Self, DeviceError> {
        let most = adapter.limits();
        let timed = timed && adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("unshade"),
            required_features: match timed {
                true => wgpu::Features::TIMESTAMP_QUERY,
                false => wgpu::Features::empty(),
            },
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
        let timings = timed.then(Mutex::default);
        Ok(Self { device, queue, fault, kernels: Mutex::default(), piece: PIECE, timings })
    }

    /// An error if anything has gone wrong since the device was opened.
    pub fn check(&self) -> Result<(), DeviceError> {
        match self.fault.get() {
            Some(fault) => Err(DeviceError(fault.clone())),
            None => Ok(()),
        }
    }

    /// Time on the device so far; nothing if it is not measured.
    pub fn timings(&self) -> Option<Timings> {
        self.timings.as_ref().map(|timings| locked(timings).clone())
    }

    /// A kernel, compiled when it is first asked for. See [`Kernel::new`].
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

    /// A buffer for `count` floats, all zero.
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

    /// A buffer of `count` floats that come row by row.
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
        // Without memory, or of a device that is lost, there is no range; its fault says so.
        if let Ok(mut range) = buffer.get_mapped_range_mut(..) {
            let mut at = 0;
            for piece in pieces {
                range.slice(at..at + piece.len()).copy_from_slice(piece);
                at += piece.len();
            }
        }
        buffer.unmap();
        buffer
    }

    /// Submits `steps` rounds of passes, with the slots of each round.
    pub fn submit(&self, passes: &[Pass], slots: Option<&Slots>, steps: usize) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let Some(timings) = &self.timings else {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            for step in 0..steps {
                passes.iter().for_each(|one| one.encode(&mut pass, slots, step));
            }
            drop(pass);
            self.queue.submit([encoder.finish()]);
            return;
        };
        let rounds = (QUERIES as usize / (2 * passes.len().max(1))).clamp(1, steps.max(1));
        let count = 2 * (rounds * passes.len()) as u32;
        for first in (0..steps).step_by(rounds) {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let queries = self.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count,
            });
            let rounds = rounds.min(steps - first);
            for (number, (step, one)) in (first..first + rounds)
                .flat_map(|step| passes.iter().map(move |one| (step, one)))
                .enumerate()
            {
                let stamps = wgpu::ComputePassTimestampWrites {
                    query_set: &queries,
                    beginning_of_pass_write_index: Some(2 * number as u32),
                    end_of_pass_write_index: Some(2 * number as u32 + 1),
                };
                let descriptor = wgpu::ComputePassDescriptor {
                    label: Some(one.name()),
                    timestamp_writes: Some(stamps),
                };
                one.encode(&mut encoder.begin_compute_pass(&descriptor), slots, step);
            }
            let stamps = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: 8 * u64::from(count),
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            let used = 2 * (rounds * passes.len()) as u32;
            encoder.resolve_query_set(&queries, 0..used, &stamps, 0);
            self.queue.submit([encoder.finish()]);
            let Ok(stamps) = self.read::<u64>(&[&stamps]) else { return };
            let period = f64::from(self.queue.get_timestamp_period()) * 1e-6;
            let mut timings = locked(timings);
            let stamps = stamps[0][..used as usize].chunks_exact(2);
            for (one, stamps) in passes.iter().cycle().zip(stamps) {
                let sum = timings.entry(one.name()).or_default();
                sum.0 += stamps[1].saturating_sub(stamps[0]) as f64 * period;
                sum.1 += 1;
            }
        }
    }

    /// Until everything that was submitted is done.
    pub fn wait(&self) -> Result<(), DeviceError> {
        self.check()?;
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map(drop).map_err(|error| DeviceError(one_line(&error.to_string())))
    }

    /// What is in these buffers after all that was submitted.
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

const STORAGE: wgpu::BufferUsages = wgpu::BufferUsages::STORAGE
    .union(wgpu::BufferUsages::UNIFORM)
    .union(wgpu::BufferUsages::COPY_SRC)
    .union(wgpu::BufferUsages::COPY_DST);

/// Nothing that these locks protect is ever left half done.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Drivers say what went wrong on several lines.
pub(super) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
