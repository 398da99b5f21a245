//! What the networks are evaluated on. The boundary is narrow: samples, directions and albedos
//! already sampled from their textures go in; losses, gradients and shading come out.

pub mod cpu;

use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// Rows of sampled albedos and of their gradients: diffuse R, G, B, specular.
pub const ALBEDOS: usize = 4;
/// Rows of the gradient of [`Backend::bend`]: directions, then specular albedo.
pub const BENT: usize = 7;

/// A device that evaluates and differentiates the pixel model A_d S_d + F A_s S_s, with
/// S_d = L(p).K_d(n_d) and S_s = L(p).K_s(r).
///
/// The loss is the mean over samples and channels of weight x |model - target|. Results are
/// bit-identical for any number of threads.
pub trait Backend: Sync {
    /// Device and instruction set, for the record.
    fn name(&self) -> String;

    /// Loss of the whole model; gradients of every network parameter and of the sampled albedos.
    fn joint(
        &self,
        networks: &Networks,
        samples: &Samples,
        directions: &Planes,
        albedo: &Planes,
    ) -> JointGradient;

    /// The light vector L(p) of every sample.
    fn light(&self, networks: &Networks, position: &Planes) -> Planes;

    /// Loss with frozen networks and known light; gradients of directions and specular albedo
    /// ([`BENT`] rows).
    fn bend(
        &self,
        networks: &Networks,
        samples: &Samples,
        light: &Planes,
        directions: &Planes,
        albedo: &Planes,
    ) -> (f64, Planes);

    /// S_d and S_s of every sample (2 rows).
    fn shade(&self, networks: &Networks, light: &Planes, directions: &Planes) -> Planes;
}

/// What [`Backend::joint`] finds.
#[derive(Clone, Debug)]
pub struct JointGradient {
    /// The data term.
    pub loss: f64,
    /// By network parameter.
    pub networks: Vec<f32>,
    /// By sampled albedo, [`ALBEDOS`] rows.
    pub albedo: Planes,
}
