//! Submissions of passes; with the time of each, if that is asked for.

use super::device::{Device, locked};
use super::pass::{Pass, Slots};

/// Queries of one submission; a limit of WebGPU.
const QUERIES: usize = 4096;

impl Device {
    /// Submits `steps` rounds of passes, with the slots of each round.
    pub fn submit(&self, passes: &[Pass], slots: Option<&Slots>, steps: usize) {
        if locked(&self.timings).is_some() {
            return self.submit_timed(passes, slots, steps);
        }
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        for step in 0..steps {
            passes.iter().for_each(|one| one.encode(&mut pass, slots, step));
        }
        drop(pass);
        self.queue.submit([encoder.finish()]);
    }

    /// [`Device::submit`] with a pair of time stamps around every dispatch, into `timings`.
    fn submit_timed(&self, passes: &[Pass], slots: Option<&Slots>, steps: usize) {
        let all: Vec<(usize, &Pass)> =
            (0..steps).flat_map(|step| passes.iter().map(move |one| (step, one))).collect();
        for part in all.chunks(QUERIES / 2) {
            let count = 2 * part.len() as u32;
            let queries = self.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count,
            });
            let mut encoder = self.device.create_command_encoder(&Default::default());
            for (number, (step, one)) in part.iter().enumerate() {
                let stamps = wgpu::ComputePassTimestampWrites {
                    query_set: &queries,
                    beginning_of_pass_write_index: Some(2 * number as u32),
                    end_of_pass_write_index: Some(2 * number as u32 + 1),
                };
                let descriptor = wgpu::ComputePassDescriptor {
                    label: Some(one.name()),
                    timestamp_writes: Some(stamps),
                };
                one.encode(&mut encoder.begin_compute_pass(&descriptor), slots, *step);
            }
            let stamps = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: 8 * u64::from(count),
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            encoder.resolve_query_set(&queries, 0..count, &stamps, 0);
            self.queue.submit([encoder.finish()]);
            let Ok(stamps) = self.read::<u64>(&[&stamps]) else { return };
            let period = f64::from(self.queue.get_timestamp_period()) * 1e-6;
            let mut timings = locked(&self.timings);
            let Some(timings) = timings.as_mut() else { return };
            for ((_, one), stamps) in part.iter().zip(stamps[0].chunks_exact(2)) {
                let sum = timings.entry(one.name()).or_default();
                sum.milliseconds += stamps[1].saturating_sub(stamps[0]) as f64 * period;
                sum.dispatches += 1;
                sum.flops += one.work.flops;
                sum.bytes += one.work.bytes;
            }
        }
    }
}
