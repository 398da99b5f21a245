//! The results of a solve so far.

use capture::CaptureError;
use serde::{Deserialize, Serialize};

use super::adam::Adam;
use super::context::SolveContext;
use super::error::SolveError;
use super::light_estimate::{DiffuseReflectance, LightEstimate};
use super::lighting::Lighting;
use super::snapshot::Snapshot;
use super::stage::State;

/// The results of a solve so far: with the capture and the configuration, all that is needed to go
/// on from the end of a step.
#[derive(Serialize, Deserialize)]
pub(super) struct Solve {
    /// Steps that are finished.
    pub finished: usize,
    /// The initial textures.
    pub initial: State,
    /// The best of the starts so far, with which the warm-up goes on.
    pub best: Option<Start>,
    /// The networks' own model of the pictures.
    pub state: State,
    /// The light that the semantic colours show, until the albedo moves too.
    pub light_estimate: Option<LightEstimate>,
    /// Light and albedo under explicit transport.
    pub lighting: Option<Lighting>,
    /// The diffuse albedo of the maps, if it is not the networks'.
    pub diffuse_reflectance: Option<DiffuseReflectance>,
    /// The textures after every stage.
    pub snapshots: Vec<Snapshot>,
}

impl Solve {
    pub fn new(context: &SolveContext) -> Result<Self, SolveError> {
        if context.coarse().is_empty() {
            return Err(CaptureError::NothingVisible(context.capture.folder.clone()).into());
        }
        let initial = context.initial_state();
        let state = initial.clone();
        Ok(Self {
            finished: 0,
            initial,
            best: None,
            state,
            light_estimate: None,
            lighting: None,
            diffuse_reflectance: None,
            snapshots: vec![],
        })
    }
}

/// A short warm-up from the networks of one seed.
#[derive(Serialize, Deserialize)]
pub(super) struct Start {
    pub losses: Vec<f64>,
    pub state: State,
    pub optimisers: Vec<Adam>,
}

impl Start {
    /// How far it has come: the mean of the last tenth of its losses.
    pub fn loss(&self) -> f64 {
        let tail = &self.losses[self.losses.len() - self.losses.len().div_ceil(10)..];
        tail.iter().sum::<f64>() / tail.len() as f64
    }
}
