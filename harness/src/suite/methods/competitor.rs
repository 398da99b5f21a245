//! A method of the Python package.

use std::path::Path;

use scoring::run::Class;
use serde_json::Value;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::{CompetitorMethod, MethodKind};
use crate::suite::method_work::{Fault, MethodWork, bytes_of_maps, cost_class};
use crate::suite::preflight::ResolvedMethod;
use crate::suite::program::{Place, Usage};
use crate::suite::stage_work::{Effort, Step, rendering_memory};
use crate::synth::Tools;

impl MethodWork for CompetitorMethod {
    fn class(&self) -> Class {
        self.competitor.class
    }

    fn title(&self, _: &str) -> String {
        self.competitor.title.to_owned()
    }

    fn key(&self, _: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError> {
        let name = self.competitor.name;
        let given = &inputs.capture()?.given;
        let mut parts = vec!["competitor", given, name, &self.settings, inputs.rendered_by(name)?];
        // It is given photographs of its own of the scene, whatever else that is relit in.
        let scene = inputs.case.scene.clone().without_relight().key()?;
        if self.competitor.class != Class::Passive {
            parts.extend(scene.iter().map(String::as_str));
        }
        Ok(Key::of(&parts))
    }

    fn identity(&self, _: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
        Ok(Some(vec![self.competitor.name.to_owned(), self.settings.clone()]))
    }

    fn make(
        &self,
        _: &ResolvedMethod,
        place: &Place,
        tools: &Tools,
        step: Step,
    ) -> Result<Option<Usage>, RunError> {
        self.competitor.make(&self.settings, place.capture, place.maps, tools, step)?;
        Ok(None)
    }

    fn effort(&self, size: &CaseSize) -> Effort {
        let millions = 1e-6 * size.train;
        let frame = 1e-6 * size.frame();
        Effort {
            fixed: 3.0,
            rate: 1.0,
            work: self.competitor.seconds_on_two_cores(&self.settings, millions, frame),
            raw: bytes_of_maps(size.solved_texels()),
            class: cost_class(&MethodKind::Competitor(self.clone())),
        }
    }

    fn memory(&self, _: &Path, size: &CaseSize) -> u64 {
        rendering_memory(size)
    }
}

impl CompetitorMethod {
    pub(super) fn reseed(&mut self, add: i64) -> Result<(), Fault> {
        if self.competitor.has_seed() {
            let mut values: Value =
                serde_json::from_str(&self.settings).map_err(|e| ("set", e.to_string()))?;
            values["seed"] = (values["seed"].as_i64().unwrap_or(0) + add).into();
            self.settings = values.to_string();
        }
        Ok(())
    }
}
