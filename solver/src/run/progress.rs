//! Progress of a solve as its caller sees it, and the caller's options.

use std::ops::ControlFlow;

use formats::maps::MapsError;

use super::checkpoint::Checkpoint;
use crate::solution::ViewLayers;

/// Where a solve stands.
#[derive(Clone, Debug)]
pub struct Progress<'a> {
    /// The stage at work.
    pub stage: &'a str,
    /// Steps done of the stage.
    pub step: usize,
    /// Steps of the stage.
    pub steps: usize,
    /// Steps done over all stages.
    pub iteration: usize,
    /// Steps of all stages; fewer from where the light proves to need no further rounds.
    pub total: usize,
    /// The loss before the last step.
    pub loss: f64,
    /// Seconds until the maps are there, as far as one can tell.
    pub seconds_left: f64,
}

pub(crate) type Callback<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + 'a;

/// Takes the layers of a training view.
pub type LayerSink<'a> = dyn FnMut(&ViewLayers) -> Result<(), MapsError> + 'a;

/// How a solve is run. Nothing in it changes a map.
#[derive(Default)]
pub struct Options<'a> {
    /// Where to keep what is needed to go on after an interrupt or a fall.
    pub checkpoint: Option<Checkpoint>,
    /// Takes the layers of the training views one after the other, if the configuration wants them:
    /// of many large views, memory has no room.
    pub layers: Option<&'a mut LayerSink<'a>>,
}
