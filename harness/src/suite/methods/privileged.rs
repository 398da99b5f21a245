//! Methods that read the truth.

use scoring::run::{Class, Kind};
use scoring::score;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::MethodKind;
use crate::suite::method_work::{MethodWork, bytes_of_maps, cost_class};
use crate::suite::preflight::ResolvedMethod;
use crate::suite::program::{Place, Usage};
use crate::suite::stage_work::{Effort, Step};
use crate::synth::Tools;

/// An answer that is made of the truth.
#[derive(Clone, Copy)]
pub(super) enum FromTruth {
    /// The true maps.
    Oracle,
    /// The true mean colour of every label.
    LabelMeans,
}

impl MethodWork for FromTruth {
    fn role(&self) -> Kind {
        match self {
            Self::Oracle => Kind::Oracle,
            Self::LabelMeans => Kind::Privileged,
        }
    }

    fn class(&self) -> Class {
        Class::Privileged
    }

    fn title(&self, _: &str) -> String {
        let title = match self {
            Self::Oracle => "oracle (true maps)",
            Self::LabelMeans => "true mean of each label",
        };
        title.to_owned()
    }

    fn key(&self, _: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError> {
        let (capture, sources) = (inputs.capture()?, inputs.executor.sources);
        Ok(match self {
            Self::Oracle => Key::of(&["oracle", &capture.truth, sources.scores]),
            Self::LabelMeans => {
                Key::of(&["label-means", &capture.given, &capture.truth, sources.scores])
            }
        })
    }

    fn identity(&self, resolved: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
        Ok(Some(vec![resolved.method.id.clone()]))
    }

    fn make(
        &self,
        _: &ResolvedMethod,
        place: &Place,
        _: &Tools,
        _: Step,
    ) -> Result<Option<Usage>, RunError> {
        match self {
            Self::Oracle => score::oracle_maps(place.capture, place.maps)?,
            Self::LabelMeans => score::label_mean_maps(place.capture, place.maps)?,
        }
        Ok(None)
    }

    fn effort(&self, size: &CaseSize) -> Effort {
        let kind = match self {
            Self::Oracle => MethodKind::Oracle,
            Self::LabelMeans => MethodKind::LabelMeans,
        };
        let raw = bytes_of_maps(size.solved_texels());
        Effort { fixed: 0.1, rate: 0.3, work: 1e-6 * size.texels, raw, class: cost_class(&kind) }
    }
}
