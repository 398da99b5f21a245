//! The interface of a kind of method.

use std::fmt::Debug;
use std::path::Path;

use formats::content_hash::hash_parts;
use scoring::run::{Class, Kind};

use super::case_size::CaseSize;
use super::error::RunError;
use super::key::{Inputs, Key};
use super::preflight::ResolvedMethod;
use super::program::{Place, ProgramFiles, Usage};
use super::stage_work::{Effort, SMALL, Step};
use crate::synth::{Interpreter, Tools};

/// The key of a method's table that is wrong, and why.
pub(super) type Fault = (&'static str, String);

/// A kind of method.
pub(super) trait MethodWork {
    /// The part that it plays in results.
    fn role(&self) -> Kind {
        Kind::Solver
    }

    /// Class of its inputs.
    fn class(&self) -> Class {
        Class::Passive
    }

    /// The title of a method that states none.
    fn title(&self, name: &str) -> String {
        name.to_owned()
    }

    /// Whether it is handed the lights and gives pictures.
    fn gives_pictures(&self) -> bool {
        false
    }

    /// Whether maps of photographs come with the light that they were recovered in.
    fn recovers_light(&self) -> bool {
        true
    }

    /// Looks for what it needs on this machine; the files of a program.
    fn find(&self, _ours: &Interpreter) -> Result<Option<ProgramFiles>, Fault> {
        Ok(None)
    }

    /// Key of its maps: what the method is given, and what it is.
    fn key(&self, resolved: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError>;

    /// Settings and code of the method, without paths of this machine or the capture: a leaderboard matches methods by
    /// their hash. None for a program that was not found.
    fn identity(&self, resolved: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError>;

    /// Writes the maps of a place from its capture.
    fn make(
        &self,
        resolved: &ResolvedMethod,
        place: &Place,
        tools: &Tools,
        step: Step,
    ) -> Result<Option<Usage>, RunError>;

    /// How much there is to do for a case of this size.
    fn effort(&self, size: &CaseSize) -> Effort;

    /// Bytes of memory at the peak.
    fn memory(&self, _capture: &Path, _size: &CaseSize) -> u64 {
        SMALL
    }
}

/// The name under which costs of a method of these settings are compared.
pub(super) fn cost_class(kind: &impl Debug) -> String {
    format!("method {}", &hash_parts(&[&format!("{kind:?}")])[..12])
}

/// Bytes of maps as bare numbers.
pub(super) fn bytes_of_maps(texels: f64) -> f64 {
    4.0 * 13.0 * texels
}
