//! The progress of a solve for its caller, and the caller's options.

use std::ops::ControlFlow;

use formats::maps::MapsError;

use super::checkpoint::Checkpoint;
use crate::solution::ViewLayers;

/// The progress of a solve after a step.
#[derive(Clone, Debug)]
pub struct Progress<'a> {
    /// The current stage.
    pub stage: &'a str,
    /// The finished steps of the stage.
    pub step: usize,
    /// The planned steps of the stage.
    pub steps: usize,
    /// The finished steps of all stages.
    pub iteration: usize,
    /// The planned steps of all stages, without those of fits that converged early.
    pub total: usize,
    /// The loss before the last step.
    pub loss: f64,
    /// The estimated seconds until the maps are finished.
    pub seconds_left: f64,
}

pub(crate) type Callback<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + 'a;

/// Receives the layers of a training view.
pub type LayerSink<'a> = dyn FnMut(&ViewLayers) -> Result<(), MapsError> + 'a;

/// Options of a run; none of them changes a map.
#[derive(Default)]
pub struct Options<'a> {
    /// The checkpoint from which the solve can continue after an interrupt or a crash.
    pub checkpoint: Option<Checkpoint>,
    /// Receives the layers of the training views one after the other, if the configuration enables them. Many large
    /// views do not fit into memory.
    pub layers: Option<&'a mut LayerSink<'a>>,
}
