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

/// The true maps.
pub(super) struct Oracle;

/// The true mean colour of every label.
pub(super) struct LabelMeans;

fn effort(size: &CaseSize, kind: &MethodKind) -> Effort {
    let raw = bytes_of_maps(size.solved_texels());
    Effort { fixed: 0.1, rate: 0.3, work: 1e-6 * size.texels, raw, class: cost_class(kind) }
}

fn identity(resolved: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
    Ok(Some(vec![resolved.method.id.clone()]))
}

impl MethodWork for Oracle {
    fn role(&self) -> Kind {
        Kind::Oracle
    }

    fn class(&self) -> Class {
        Class::Privileged
    }

    fn title(&self, _: &str) -> String {
        "oracle (true maps)".to_owned()
    }

    fn key(&self, _: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError> {
        Ok(Key::of(&["oracle", &inputs.capture()?.truth, inputs.executor.sources.scores]))
    }

    fn identity(&self, resolved: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
        identity(resolved)
    }

    fn make(
        &self,
        _: &ResolvedMethod,
        place: &Place,
        _: &Tools,
        _: Step,
    ) -> Result<Option<Usage>, RunError> {
        score::oracle_maps(place.capture, place.maps)?;
        Ok(None)
    }

    fn effort(&self, size: &CaseSize) -> Effort {
        effort(size, &MethodKind::Oracle)
    }
}

impl MethodWork for LabelMeans {
    fn role(&self) -> Kind {
        Kind::Privileged
    }

    fn class(&self) -> Class {
        Class::Privileged
    }

    fn title(&self, _: &str) -> String {
        "true mean of each label".to_owned()
    }

    fn key(&self, _: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError> {
        let (capture, sources) = (inputs.capture()?, inputs.executor.sources);
        Ok(Key::of(&["label-means", &capture.given, &capture.truth, sources.scores]))
    }

    fn identity(&self, resolved: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
        identity(resolved)
    }

    fn make(
        &self,
        _: &ResolvedMethod,
        place: &Place,
        _: &Tools,
        _: Step,
    ) -> Result<Option<Usage>, RunError> {
        score::label_mean_maps(place.capture, place.maps)?;
        Ok(None)
    }

    fn effort(&self, size: &CaseSize) -> Effort {
        effort(size, &MethodKind::LabelMeans)
    }
}
