//! A baseline.

use scoring::run::Kind;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::{BaselineSettings, MethodKind};
use crate::suite::method_work::{MethodWork, bytes_of_maps, cost_class};
use crate::suite::preflight::ResolvedMethod;
use crate::suite::program::{Place, Usage};
use crate::suite::sources::SOLVER_SOURCES;
use crate::suite::stage_work::{Effort, Step};
use crate::synth::Tools;

impl MethodWork for BaselineSettings {
    fn role(&self) -> Kind {
        Kind::Baseline
    }

    fn title(&self, _: &str) -> String {
        self.baseline.title().to_owned()
    }

    fn recovers_light(&self) -> bool {
        false
    }

    fn key(&self, _: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError> {
        let (name, size) = (self.baseline.name(), self.texture_size.to_string());
        let given = &inputs.capture()?.given;
        Ok(Key::of(&["baseline", given, name, &size, inputs.executor.sources.solver]))
    }

    fn identity(&self, _: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
        let (name, size) = (self.baseline.name().to_owned(), self.texture_size.to_string());
        Ok(Some(vec![name, size, SOLVER_SOURCES.to_owned()]))
    }

    fn make(
        &self,
        _: &ResolvedMethod,
        place: &Place,
        _: &Tools,
        _: Step,
    ) -> Result<Option<Usage>, RunError> {
        self.baseline.make(place.capture, place.maps, self.texture_size)?;
        Ok(None)
    }

    fn effort(&self, size: &CaseSize) -> Effort {
        let texels = self.texture_size.pow(2) as f64;
        Effort {
            fixed: 0.1,
            rate: 0.3,
            work: 1e-6 * (size.train + texels * size.views as f64),
            raw: bytes_of_maps(texels),
            class: cost_class(&MethodKind::Baseline(*self)),
        }
    }
}
