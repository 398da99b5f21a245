//! The processor, with explicit vectors of the widest available instruction set.
//!
//! Samples are processed in chunks of [`CHUNK_BLOCKS`] blocks. The gradients of the weights are summed block by block
//! within a chunk, and over chunks in order in f64, so that results do not depend on the number of threads.
//!
//! Traffic between memory and a sample per iteration, in bytes; everything else lives in about
//! 250 KiB of scratch per thread:
//!
//! | pass | read | written |
//! |---|---|---|
//! | [`Backend::joint`] | 72: position, two directions, Fresnel factor, colour, weight, albedos | 16: gradients with respect to the albedos |
//! | [`Backend::joint_textures`] | 68: the same without the albedos, and place | 0 |
//! | [`Backend::direction_gradient`] | 92: light vector, two directions, Fresnel factor, colour, weight, albedos | 28: gradients with respect to directions and specular albedo |
//! | [`Backend::deviation_gradient`] | 100: light vector, normal, view, Fresnel factor, colour, weight, albedo, place | 0 |
//! | [`Backend::shade`] | 56: light vector, two directions | 8 |
//! | sampling or gathering `C` channels | 12 of place, `4 C` | `4 C` |
//! | a diffuse step ([`Layer::gradient`](crate::model::layer::Layer::gradient)) | 44: S_d of R, G, B, specular layer, colour, weight, place | 0 |
//! | a specular step with fixed normals | 32: the residual colour, F S_s, weight, place | 0 |
//! | a conjugate-gradient step of the heights | 76: 15 slopes, weight, place | 0 |
//!
//! A texel's value costs 24 bytes in Adam and 4 when it is sampled. A step on deviation textures costs about 400 bytes
//! more per texel: the packed texel of 32 bytes and its gradient of 32 bytes are written and read pass by pass, and both
//! are blurred. A joint step is 7488 FLOP per sample and therefore limited by arithmetic on every machine with more than
//! 0.012 bytes of bandwidth per FLOP; the diffuse and specular steps are limited by memory.

mod ahead;
mod directions;
mod kernels;
mod lanes;
mod level;
mod perceptron;
mod shade;

use self::kernels::{Inputs, Scratch};
pub(crate) use self::lanes::exp_plain as exp;
pub use self::level::Level;
use self::perceptron::Packed;
use super::{
    ALBEDOS, Backend, DIRECTION_ROWS, JointGradient, TexturedJointGradient, TexturedNormals,
};
use crate::model::deviation_textures::ROWS;
use crate::model::networks::{Network, Networks};
use crate::model::planes::{CHUNK_BLOCKS, Planes, Row};
use crate::model::samples::Samples;
use crate::model::strips::Strip;

/// The processor backend at one level.
#[derive(Clone, Copy, Debug)]
pub struct Cpu {
    level: Level,
}

impl Cpu {
    /// The backend at the fastest level.
    pub fn new() -> Self {
        let level = Level::available().last().copied().unwrap_or(Level::Portable);
        Self { level }
    }

    /// The backend at a level of [`Level::available`].
    ///
    /// # Panics
    /// If this machine does not have the level.
    pub fn at(level: Level) -> Self {
        assert!(Level::available().contains(&level));
        Self { level }
    }
}

impl Cpu {
    /// Runs only multiply-adds of the backend's vectors on one thread, and returns the number of operations (two each):
    /// the ceiling of a kernel, for benchmarks.
    pub fn multiply_adds(&self, rounds: usize) -> f64 {
        std::hint::black_box(kernels::peak(self.level, rounds));
        (rounds * kernels::PEAK_CHAINS * self.level.flops_per_multiply_add()) as f64
    }
}

impl Default for Cpu {
    fn default() -> Self {
        Self::new()
    }
}

fn pack(networks: &Networks) -> [Packed; 3] {
    Network::ALL.map(|network| Packed::new(networks, network))
}

/// Planes of `rows` rows that `pass` fills in parallel chunks; and its results in the order of the chunks.
fn chunks<T: Send>(
    networks: &Networks,
    rows: usize,
    len: usize,
    pass: impl Fn(usize, &mut Scratch, &mut [Row]) -> T + Sync,
) -> (Planes, Vec<T>) {
    let scratch = || Scratch::new(networks);
    Planes::from_tasks(rows, len, CHUNK_BLOCKS, scratch, |scratch, first, out| {
        pass(first, scratch, out)
    })
}

/// Sums the losses and gradients of chunks in order.
fn total(networks: &Networks, parts: Vec<(f64, Vec<f32>)>) -> (f64, Vec<f32>) {
    let mut total = vec![0.0f64; networks.parameters.len()];
    let mut loss = 0.0;
    for (part, sums) in parts {
        loss += part;
        total.iter_mut().zip(sums).for_each(|(total, sum)| *total += f64::from(sum));
    }
    (loss, total.into_iter().map(|gradient| gradient as f32).collect())
}

impl Backend for Cpu {
    fn name(&self) -> String {
        format!("cpu, {}", self.level)
    }

    fn joint(
        &self,
        networks: &Networks,
        samples: &Samples,
        directions: &Planes,
        albedo: &Planes,
    ) -> JointGradient {
        let packed = &pack(networks);
        let inputs = Inputs { packed, samples, directions, albedo };
        let (by_albedo, parts) = chunks(networks, ALBEDOS, samples.len(), |first, scratch, out| {
            let loss = kernels::joint(self.level, &inputs, first, scratch, out);
            (loss, scratch.sums.clone())
        });
        let (loss, networks) = total(networks, parts);
        JointGradient { loss, networks, albedo: by_albedo }
    }

    fn joint_textures(
        &self,
        networks: &Networks,
        samples: &Samples,
        directions: &Planes,
        albedo: &[f32],
    ) -> TexturedJointGradient {
        let packed = &pack(networks);
        // The sampled albedos are not needed.
        let inputs = Inputs { packed, samples, directions, albedo: directions };
        let scratch = || Scratch::new(networks);
        let work = |scratch: &mut Scratch, strip: &mut Strip<ALBEDOS>| {
            let loss = kernels::joint_textured(self.level, &inputs, albedo, scratch, strip);
            (loss, scratch.sums.clone())
        };
        let (albedo, parts) = samples.taps.by_chunk(scratch, work);
        let (loss, networks) = total(networks, parts);
        TexturedJointGradient { loss, networks, albedo }
    }

    fn light(&self, networks: &Networks, position: &Planes) -> Planes {
        let packed = &pack(networks);
        let pass = |first: usize, scratch: &mut Scratch, out: &mut [Row]| {
            kernels::light(self.level, packed, position, first, scratch, out);
        };
        chunks(networks, networks.outputs(), position.len(), pass).0
    }

    fn direction_gradient(
        &self,
        networks: &Networks,
        samples: &Samples,
        light: &Planes,
        directions: &Planes,
        albedo: &Planes,
    ) -> (f64, Planes) {
        let packed = &pack(networks);
        let inputs = Inputs { packed, samples, directions, albedo };
        let (gradient, losses) =
            chunks(networks, DIRECTION_ROWS, samples.len(), |first, scratch, out| {
                kernels::direction_gradient(self.level, &inputs, light, first, scratch, out)
            });
        (losses.iter().sum(), gradient)
    }

    fn deviation_gradient(&self, normals: &TexturedNormals) -> (f64, Vec<f32>) {
        let packed = &pack(normals.networks);
        let work = |scratch: &mut Scratch, strip: &mut Strip<ROWS>| {
            kernels::textured(self.level, packed, normals, scratch, strip)
        };
        let scratch = || Scratch::new(normals.networks);
        let (gradient, losses) = normals.samples.taps.by_blocks(scratch, work);
        (losses.iter().sum(), gradient)
    }

    fn shade(&self, networks: &Networks, light: &Planes, directions: &Planes) -> Planes {
        let packed = &pack(networks);
        let pass = |first: usize, scratch: &mut Scratch, out: &mut [Row]| {
            kernels::shade_blocks(self.level, packed, light, directions, first, scratch, out);
        };
        chunks(networks, 2, light.len(), pass).0
    }
}
