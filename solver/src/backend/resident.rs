//! Stages that run on a device from end to end: samples, textures, gradients and moments stay there,
//! many steps are submitted at once, and the host hears of the losses alone.
//!
//! The host keeps its own copy of everything that moves, as it was at the last
//! [`Resident::download`]: that is what checkpoints are made of, and where the processor goes on
//! should the device fail.

use glam::Vec3;

use crate::fit::adam::Adam;
use crate::model::blur::Blur;
use crate::model::deviation::Deviation;
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::taps::Taps;

/// A stage as a device may take it in: all that stays as it is while the stage runs.
pub enum Job<'a> {
    /// Moves networks, diffuse and specular albedo.
    Joint {
        /// The pixels.
        samples: &'a Samples,
        /// Inputs of the directional networks.
        directions: &'a Planes,
        /// Of the networks, see [`Networks::shape`].
        shape: &'a [usize],
        /// Weight of the albedo prior.
        prior: f32,
    },
    /// Moves one of the albedos, in which the model is linear while everything else stays.
    Layer {
        /// From texels to pixels.
        taps: &'a Taps,
        /// Rows: what the other layer leaves of the target R, G, B; the weight; and the shading of this
        /// layer, R, G, B under the diffuse albedo, one value under the specular one.
        known: Planes,
        /// Weight of the albedo prior.
        prior: f32,
    },
    /// Moves deviation and specular albedo under frozen networks.
    Normals(NormalsJob<'a>),
}

/// See [`Job::Normals`].
#[derive(Clone, Copy)]
pub struct NormalsJob<'a> {
    /// The pixels.
    pub samples: &'a Samples,
    /// From the deviation texture to directions.
    pub deviation: &'a Deviation,
    /// Frozen.
    pub networks: &'a Networks,
    /// L(p).
    pub light: &'a Planes,
    /// Sampled albedos, of which the diffuse one stays.
    pub albedo: &'a Planes,
}

/// Something that a stage moves, with its optimiser.
pub struct Variable<'a> {
    /// The values.
    pub values: &'a mut Vec<f32>,
    /// Rate, step count and moments.
    pub adam: &'a mut Adam,
    /// No value falls below this.
    pub minimum: f32,
    /// Nor rises above this.
    pub maximum: f32,
}

impl<'a> Variable<'a> {
    /// Of these values.
    pub fn new(values: &'a mut Vec<f32>, adam: &'a mut Adam, minimum: f32) -> Self {
        Self { values, adam, minimum, maximum: f32::INFINITY }
    }

    /// A step on the host.
    pub fn step(&mut self, gradient: &[f32], decay: f32) {
        self.adam.step(self.values, gradient, decay, self.minimum);
        if self.maximum < f32::INFINITY {
            self.values.iter_mut().for_each(|value| *value = value.min(self.maximum));
        }
    }
}

/// A stage on a device. Its variables come in the order that [`Job`] names.
pub trait Resident {
    /// Values, moments and step counts of the host go to the device.
    fn upload(&mut self, variables: &[Variable]) -> Result<(), DeviceError>;

    /// A step for each share of the learning rates, [`BATCH`] at most; the losses before each.
    fn steps(&mut self, rate_factors: &[f32]) -> Result<Vec<f64>, DeviceError>;

    /// The reverse of [`Resident::upload`]; on an error the host's copies are as they were.
    fn download(&mut self, variables: &mut [Variable]) -> Result<(), DeviceError>;
}

/// The normal equations of the height solve, see `unshade/height_solve.rs`: unknown are a height per texel
/// and three changes of the albedo.
pub struct NormalEquations<'a> {
    /// From texels to pixels.
    pub taps: &'a Taps,
    /// What a colour gains: by the specular deviation (3 rows), by the diffuse one (3 of R, then of G and
    /// B), by the albedo (R, G, B).
    pub slopes: &'a Planes,
    /// Of every sample.
    pub weight: &'a Planes,
    /// The right-hand side.
    pub goal: &'a [f32],
    /// Where to start.
    pub x: &'a [f32],
    /// Deviation by the height's change to the right, and downwards.
    pub basis: [&'a [Vec3]; 2],
    /// From the specular deviation to the diffuse one.
    pub blur: &'a Blur,
    /// Weights of the squared deviation, of its squared differences, of squared heights, and of the
    /// albedo's squared unknowns.
    pub flatness: f32,
    /// See `flatness`.
    pub smoothness: f32,
    /// See `flatness`.
    pub rest: f32,
    /// See `flatness`.
    pub damping: f32,
    /// Share of a colour's part along that of the diffuse layer (the slopes by the albedo) that counts for
    /// nothing.
    pub diffuse_share: f32,
    /// Squared norm of the residual, over that of the goal, at which nothing moves any more.
    pub enough: f64,
}

/// Conjugate gradients on a device.
pub trait Descent {
    /// Takes steps.
    fn steps(&mut self, count: usize) -> Result<(), DeviceError>;

    /// Where they have led.
    fn unknowns(&mut self) -> Result<Vec<f32>, DeviceError>;
}

/// Most steps between two submissions.
pub const BATCH: usize = 25;

/// A device that is lost, out of memory, or refused what it was told to do.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{0}")]
pub struct DeviceError(pub String);
