//! Fits that run entirely on a device: samples, textures, gradients and moments stay there, many steps are submitted at
//! once, and only the losses are read back.
//!
//! The host keeps a copy of all variables from the last [`Resident::download`]. Checkpoints store this copy, and the
//! processor resumes from it if the device fails.

use glam::Vec3;

use crate::fit::adam::Adam;
use crate::model::blur::Blur;
use crate::model::deviation::Deviation;
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::taps::Taps;

/// The constants of a fit, for a device. The variables are uploaded separately.
pub enum Job<'a> {
    /// Optimises networks, diffuse and specular albedo.
    Joint {
        /// The pixels.
        samples: &'a Samples,
        /// Inputs of the directional networks.
        directions: &'a Planes,
        /// See [`Networks::shape`].
        shape: &'a [usize],
        /// Weight of the albedo prior.
        prior: f32,
    },
    /// Optimises one of the albedos, in which the model is linear.
    Layer {
        /// The texels of each pixel.
        taps: &'a Taps,
        /// Rows: the target R, G, B minus the other layer; the weight; and the shading of this layer, R, G, B for the
        /// diffuse albedo, one value for the specular albedo.
        known: Planes,
        /// Weight of the albedo prior.
        prior: f32,
    },
    /// Optimises deviation and specular albedo under frozen networks.
    Normals(NormalsJob<'a>),
}

/// See [`Job::Normals`].
#[derive(Clone, Copy)]
pub struct NormalsJob<'a> {
    /// The pixels.
    pub samples: &'a Samples,
    /// The map from the deviation texture to directions.
    pub deviation: &'a Deviation,
    /// Frozen.
    pub networks: &'a Networks,
    /// L(p).
    pub light: &'a Planes,
    /// The albedos at every sample; only the diffuse one is read.
    pub albedo: &'a Planes,
}

/// A parameter array of a fit with its optimiser.
pub struct Variable<'a> {
    /// The values.
    pub values: &'a mut Vec<f32>,
    /// Rate, step count and moments.
    pub adam: &'a mut Adam,
    /// No value falls below this.
    pub minimum: f32,
    /// No value rises above this.
    pub maximum: f32,
}

impl<'a> Variable<'a> {
    /// A variable without a maximum.
    pub fn new(values: &'a mut Vec<f32>, adam: &'a mut Adam, minimum: f32) -> Self {
        Self { values, adam, minimum, maximum: f32::INFINITY }
    }

    /// Takes a step on the host.
    pub fn step(&mut self, gradient: &[f32], decay: f32) {
        self.adam.step(self.values, gradient, decay, self.minimum);
        if self.maximum < f32::INFINITY {
            self.values.iter_mut().for_each(|value| *value = value.min(self.maximum));
        }
    }
}

/// A fit on a device. The order of its variables is that in the description of its [`Job`].
pub trait Resident {
    /// Copies values, moments and step counts from the host to the device.
    fn upload(&mut self, variables: &[Variable]) -> Result<(), DeviceError>;

    /// Takes a step for each factor on the learning rates, at most [`BATCH`], and returns the losses before the steps.
    fn steps(&mut self, rate_factors: &[f32]) -> Result<Vec<f64>, DeviceError>;

    /// Copies everything from the device to the host. After an error the host's copies are unchanged.
    fn download(&mut self, variables: &mut [Variable]) -> Result<(), DeviceError>;
}

/// The normal equations A x = b of `unshade/height_solve.rs`. The unknowns are a height and three changes of the albedo
/// per texel.
pub struct NormalEquations<'a> {
    /// The texels of each pixel.
    pub taps: &'a Taps,
    /// Derivatives of a sample's colour with respect to the specular deviation (3 rows), the diffuse deviation (3 of R,
    /// then of G and B) and the albedo (R, G, B).
    pub slopes: &'a Planes,
    /// The weight of every sample.
    pub weight: &'a Planes,
    /// b.
    pub right_hand_side: &'a [f32],
    /// The initial x.
    pub x: &'a [f32],
    /// Derivatives of the deviation with respect to the height's difference to the right, and downwards.
    pub basis: [&'a [Vec3]; 2],
    /// The blur from the specular deviation to the diffuse one.
    pub blur: &'a Blur,
    /// Weight of the squared deviation.
    pub flatness: f32,
    /// Weight of the squared differences of the deviation.
    pub smoothness: f32,
    /// Weight of squared heights.
    pub height_damping: f32,
    /// Weight of squared changes of the albedo.
    pub albedo_damping: f32,
    /// The removed share of a colour's component along the diffuse layer (the derivatives with respect to the albedo).
    pub diffuse_share: f32,
    /// Squared norm of the residual, over that of b, below which steps change nothing.
    pub tolerance: f64,
}

/// Conjugate gradients on a device.
pub trait Descent {
    /// Takes steps.
    fn steps(&mut self, count: usize) -> Result<(), DeviceError>;

    /// Returns the current x.
    fn unknowns(&mut self) -> Result<Vec<f32>, DeviceError>;
}

/// The largest number of steps of a submission.
pub const BATCH: usize = 25;

/// A device is lost, out of memory, or refused a command.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{0}")]
pub struct DeviceError(pub String);
