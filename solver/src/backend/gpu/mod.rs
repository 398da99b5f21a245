//! Graphics processors, through wgpu's compute shaders (Vulkan, Metal, DirectX 12).
//!
//! The fits of the published method, the last albedo of the default method, and the conjugate gradients of its relief
//! run entirely on the device, see [`super::resident`]. The processor fits the light and computes everything that is
//! needed once: G-buffers, rays, linearisations of the relief (with highlights from the device), maps and views.
//!
//! Layouts are the processor's: planes of blocks of 256 samples, gradients of textures by gather in texel
//! order, sums in a fixed order without atomics. One adapter with one driver therefore gives the same
//! bytes every time; the processor's differ by rounding.
//!
//! Samples come in pieces that fit the bindings: of 128 MiB, which every adapter has, or up to 512 MiB.
//!
//! Costs per sample and step with the published networks. Everything except the networks is limited by memory if a byte
//! costs more than a dozen operations.
//!
//! | stage | operations | bytes: sampling / directions / networks or albedo / gather | texel and step |
//! |---|---|---|---|
//! | warm-up | 7488, and 1824 for hidden layers evaluated twice | 40 / 0 / 88 / 32 | 196 |
//! | normals and specular | 3456, and 1216 | 64 / 168 / 120 / 52 | 440 |
//! | diffuse | 60 | 0 / 0 / 52 / 20 | 140 |
//!
//! The paper's capture (12 million pixels x 2000, then 48 million x 500 twice, 2048² textures) on an H200
//! with the 67 TFLOP/s and 4.8 TB/s of its data sheet: warm-up 3.3 s of arithmetic (2.7 without the second
//! evaluation), 0.8 s of memory, and 2.9 s of workgroup memory, through which 3.6 kB of layers a sample go
//! to the weights' gradients; normals 1.7 s, 2.2 s; diffuse 0.4 s of memory. The overlap is unknown:
//! 6 s with full overlap, 11 s without, 20 s at half of the data sheet's speed. Not yet measured; `unshade bench`
//! compares every pass with its limit.
//!
//! A device failure is logged in one line, and the processor continues.

mod adapter;
mod blurs;
mod ceilings;
mod computing;
mod device;
mod direction_gradient;
mod heights;
mod joint;
mod kernel;
mod layer;
mod layout;
mod normals;
mod pass;
mod pieces;
mod program;
mod skin_highlights;
mod submission;
mod timings;
mod unroll;

pub use super::error::VARIABLE;
pub use adapter::{Adapter, adapters};
pub use ceilings::Ceilings;
pub use computing::Gpu;
pub use timings::{PassTime, Timings};

use self::layout::Layout;
use super::resident::{Descent, Job, NormalEquations, Resident};
use super::{Backend, JointGradient};
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::SkinHighlights;

impl Backend for Gpu {
    fn name(&self) -> String {
        match self.failure.get() {
            Some(error) => format!("{}; it failed ({error}); then {}", self.name, self.cpu.name()),
            None => self.name.clone(),
        }
    }

    fn joint(
        &self,
        networks: &Networks,
        samples: &Samples,
        directions: &Planes,
        albedo: &Planes,
    ) -> JointGradient {
        let layout = Layout::new(&networks.shape);
        if !self.fits(&layout) {
            return self.cpu.joint(networks, samples, directions, albedo);
        }
        self.either(
            |device| joint::joint(device, &layout, networks, samples, directions, albedo),
            |cpu| cpu.joint(networks, samples, directions, albedo),
        )
    }

    fn light(&self, networks: &Networks, position: &Planes) -> Planes {
        self.either(
            |device| direction_gradient::light(device, networks, position),
            |cpu| cpu.light(networks, position),
        )
    }

    fn direction_gradient(
        &self,
        networks: &Networks,
        samples: &Samples,
        light: &Planes,
        directions: &Planes,
        albedo: &Planes,
    ) -> (f64, Planes) {
        self.either(
            |device| {
                direction_gradient::direction_gradient(
                    device, networks, samples, light, directions, albedo,
                )
            },
            |cpu| cpu.direction_gradient(networks, samples, light, directions, albedo),
        )
    }

    fn shade(&self, networks: &Networks, light: &Planes, directions: &Planes) -> Planes {
        self.either(
            |device| direction_gradient::shade(device, networks, light, directions),
            |cpu| cpu.shade(networks, light, directions),
        )
    }

    fn highlights(
        &self,
        skin_highlights: &SkinHighlights,
        samples: &Samples,
        normals: &Planes,
        specular: &Planes,
    ) -> Planes {
        self.either(
            |device| {
                skin_highlights::highlights(device, skin_highlights, samples, normals, specular)
            },
            |cpu| cpu.highlights(skin_highlights, samples, normals, specular),
        )
    }

    fn descent(&self, problem: &NormalEquations) -> Option<Box<dyn Descent + '_>> {
        if self.failure.get().is_some() {
            return None;
        }
        match heights::Heights::new(self, problem) {
            Ok(heights) => Some(Box::new(heights)),
            Err(error) => {
                self.mark_failed(&error);
                None
            }
        }
    }

    fn resident(&self, job: &Job) -> Option<Box<dyn Resident + '_>> {
        if self.failure.get().is_some() {
            return None;
        }
        match job {
            Job::Joint { samples, directions, shape, prior } => {
                let layout = Layout::new(shape);
                if !self.fits(&layout) {
                    return None;
                }
                Some(Box::new(joint::program(self, layout, samples, directions, *prior)))
            }
            Job::Layer { taps, known, prior } => {
                Some(Box::new(layer::program(self, taps, known, *prior)))
            }
            Job::Normals(job) => Some(Box::new(normals::program(self, job))),
        }
    }
}
