//! Backends for the arithmetic. The interface is narrow: inputs are samples, directions and sampled albedos; outputs
//! are losses, gradients and shading. A device with its own memory may run whole fits, see [`resident`].
//!
//! The processor's kernels are compiled for AVX-512, AVX2 with FMA, and plain SSE2 on x86-64, chosen at run time, and
//! for NEON on aarch64. The portable ones, for all other processors, are loops over arrays of eight floats, which
//! compilers vectorise. They index slices, without `unsafe`. Tests compare all other levels with them, also on numbers
//! of samples around all vector widths (`solver/tests/backends`; `make neon` runs them in an emulator). `make miri`
//! interprets planes and taps.

mod choice;
pub mod cpu;
mod error;
pub mod gpu;
pub mod resident;

pub use choice::Choice;
pub use error::BackendError;

use crate::model::deviation_textures::{BLURRED, PackedDeviations, ROWS, SPECULAR};
use crate::model::networks::Networks;
use crate::model::normals::{DIRECTIONS, Deviations, DirectionScale};
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::strips::{Strip, blocks};
use crate::transport::SkinHighlights;
use resident::{Descent, Job, NormalEquations, Resident};

/// Rows of sampled albedos and of their gradients: diffuse R, G, B, specular.
pub const ALBEDOS: usize = 4;
/// Rows of the gradient of [`Backend::direction_gradient`]: directions, then specular albedo.
pub const DIRECTION_ROWS: usize = 7;

/// A device that evaluates and differentiates the pixel model A_d S_d + F A_s S_s, with
/// S_d = L(p).K_d(n_d) and S_s = L(p).K_s(r).
///
/// The loss is the mean over samples and channels of weight x |model - target|. Results are
/// bit-identical for any number of threads.
pub trait Backend: Send + Sync {
    /// Device and instruction set or driver, for the record; and what became of it.
    fn name(&self) -> String;

    /// Loss of the whole model; gradients of every network parameter and of the sampled albedos.
    fn joint(
        &self,
        networks: &Networks,
        samples: &Samples,
        directions: &Planes,
        albedo: &Planes,
    ) -> JointGradient;

    /// [`Self::joint`] with the albedos of a texture, and gradients by its texels.
    fn joint_textures(
        &self,
        networks: &Networks,
        samples: &Samples,
        directions: &Planes,
        albedo: &[f32],
    ) -> TexturedJointGradient {
        let taps = &samples.taps;
        let sampled = taps.sample_vectors(albedo);
        let JointGradient { loss, networks, albedo } =
            self.joint(networks, samples, directions, &sampled);
        let albedo = taps.gather_vectors(&albedo);
        TexturedJointGradient { loss, networks, albedo }
    }

    /// The light vector L(p) of every sample.
    fn light(&self, networks: &Networks, position: &Planes) -> Planes;

    /// Loss with frozen networks and known light; gradients of directions and specular albedo
    /// ([`DIRECTION_ROWS`] rows).
    fn direction_gradient(
        &self,
        networks: &Networks,
        samples: &Samples,
        light: &Planes,
        directions: &Planes,
        albedo: &Planes,
    ) -> (f64, Planes);

    /// [`Self::direction_gradient`] with the directions and the specular albedo of textures, and gradients by their
    /// texels ([`ROWS`] values each). The albedo's last row is not read.
    fn deviation_gradient(&self, normals: &TexturedNormals) -> (f64, Vec<f32>) {
        let TexturedNormals { networks, samples, light, albedo, scale, textures } = *normals;
        let bent = textures.sample(&samples.taps);
        let deviations = Deviations { planes: &bent, blurred: BLURRED };
        let directions = scale.directions(samples, Some(deviations));
        let mut albedo = albedo.clone();
        albedo.copy_row(ALBEDOS - 1, &bent, SPECULAR);
        let (loss, by_sample) =
            self.direction_gradient(networks, samples, light, &directions, &albedo);
        let by_deviations = scale.adjoint(samples, deviations, &by_sample);
        let mut by_bent = Planes::new(ROWS, samples.len());
        (0..3).for_each(|axis| by_bent.copy_row(axis, &by_deviations, axis));
        (0..3).for_each(|axis| by_bent.copy_row(BLURRED + axis, &by_deviations, 3 + axis));
        by_bent.copy_row(SPECULAR, &by_sample, DIRECTIONS);
        let add = |(): &mut (), strip: &mut Strip<ROWS>| {
            for (block, lanes) in blocks(strip.samples.clone()) {
                strip.add_vectors(block, lanes, by_bent.block(block));
            }
        };
        (loss, samples.taps.by_blocks(|| (), add).0)
    }

    /// S_d and S_s of every sample (2 rows).
    fn shade(&self, networks: &Networks, light: &Planes, directions: &Planes) -> Planes;

    /// Highlights on these normals with these specular terms, see [`SkinHighlights::on`].
    fn highlights(
        &self,
        skin_highlights: &SkinHighlights,
        samples: &Samples,
        normals: &Planes,
        specular: &Planes,
    ) -> Planes {
        skin_highlights.on(samples, normals, specular)
    }

    /// The program of a stage on the device; nothing if its steps are taken through the methods
    /// above.
    fn resident(&self, _job: &Job) -> Option<Box<dyn Resident + '_>> {
        None
    }

    /// Conjugate gradients on the device; nothing if the host takes their steps.
    fn descent(&self, _problem: &NormalEquations) -> Option<Box<dyn Descent + '_>> {
        None
    }
}

/// Inputs of [`Backend::deviation_gradient`].
#[derive(Clone, Copy)]
pub struct TexturedNormals<'a> {
    /// Frozen.
    pub networks: &'a Networks,
    /// The pixels.
    pub samples: &'a Samples,
    /// L(p).
    pub light: &'a Planes,
    /// Sampled albedos, of which the diffuse one is read.
    pub albedo: &'a Planes,
    /// Scale of the directions.
    pub scale: &'a DirectionScale,
    /// Deviations and specular albedo.
    pub textures: &'a PackedDeviations,
}

/// The loss and the gradients of [`Backend::joint`].
#[derive(Clone, Debug)]
pub struct JointGradient {
    /// The data term.
    pub loss: f64,
    /// Gradient with respect to the parameters of the networks.
    pub networks: Vec<f32>,
    /// Gradient with respect to the sampled albedos, [`ALBEDOS`] rows.
    pub albedo: Planes,
}

/// The loss and the gradients of [`Backend::joint_textures`].
#[derive(Clone, Debug)]
pub struct TexturedJointGradient {
    /// The data term.
    pub loss: f64,
    /// Gradient with respect to the parameters of the networks.
    pub networks: Vec<f32>,
    /// Gradient with respect to the albedos, [`ALBEDOS`] values per texel.
    pub albedo: Vec<f32>,
}
