//! Methods that come with unshade and are no configuration of its solver: run in the renderer's process.

use std::path::Path;

use formats::atomic;
use scoring::run::Class;
use serde_json::Value;

use super::error::RunError;
use super::program::copy_blind;
use crate::synth::Request;
use crate::synth::Tools;

/// A method of the Python package, `unshade.methods`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Competitor {
    /// The name in a suite.
    pub name: &'static str,
    /// The name in tables.
    pub title: &'static str,
    /// Class of its inputs.
    pub class: Class,
}

/// Name, title and class; the modules stand in `synth/unshade/methods/__init__.py`.
const ALL: [(&str, &str, Class); 5] = [
    ("sh-lambert", "spherical harmonics, Lambert", Class::Passive),
    ("path-traced", "differentiable path tracing", Class::Passive),
    ("binary-patterns", "binary patterns of screens", Class::Controlled),
    ("flash-only", "flash at the lens", Class::Controlled),
    ("light-stage", "light stage", Class::Controlled),
];

impl Competitor {
    /// The one that a suite names.
    pub fn find(name: &str) -> Option<Self> {
        let (name, title, class) = ALL.into_iter().find(|(known, ..)| *known == name)?;
        Some(Self { name, title, class })
    }

    /// Whether its settings have a seed.
    pub(super) fn has_seed(self) -> bool {
        self.name == "path-traced"
    }

    /// Seconds on two cores, without the start of its process, for training views of `millions` of pixels, `frame` of
    /// them in a picture.
    pub(super) fn seconds_on_two_cores(self, settings: &str, millions: f64, frame: f64) -> f64 {
        let settings: Value = serde_json::from_str(settings).unwrap_or_default();
        let setting = |key: &str, default: f64| settings[key].as_f64().unwrap_or(default);
        match self.name {
            "path-traced" => {
                let steps = setting("basis_steps", 200.0) + setting("free_steps", 400.0);
                0.6 * steps * frame * setting("samples", 16.0)
            }
            "sh-lambert" => 2.0 + 2.0 * millions,
            _ => 15.0 * millions,
        }
    }

    /// Writes the maps folder `maps` from `capture`; `settings` are JSON. A passive method never sees more
    /// than the blind copy that programs of others get.
    pub(super) fn make(
        self,
        settings: &str,
        capture: &Path,
        maps: &Path,
        tools: &Tools,
        step: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<(), RunError> {
        atomic::refuse_overlap(maps, &[capture]).map_err(formats::MapsError::from)?;
        let scratch = tempfile::tempdir()?;
        let blind = scratch.path().join("capture");
        let given = match self.class {
            Class::Passive => {
                copy_blind(capture, &blind)?;
                blind.as_path()
            }
            Class::Controlled | Class::Privileged => capture,
        };
        let settings = serde_json::from_str(settings).unwrap_or_default();
        let request = Request::Method { name: self.name, capture: given, out: maps, settings };
        tools.run(&request, step)?;
        Ok(())
    }
}
