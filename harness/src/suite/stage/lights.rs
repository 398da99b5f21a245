//! Writes the lights of a case for methods that give pictures.

use std::path::Path;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::executor::StageExecutor;
use crate::suite::file::Suite;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::Method;
use crate::suite::plan::Stage;
use crate::suite::program::Usage;
use crate::suite::stage_work::{Effort, RENDERER, StageWork, Step};
use crate::synth::Request;

pub(super) struct Lights;

impl StageWork for Lights {
    fn key(&self, inputs: &Inputs) -> Result<Key, RunError> {
        Ok(Key::of(&["lights", &inputs.capture()?.content, inputs.rendered_by("lights")?]))
    }

    fn make(
        &self,
        executor: &StageExecutor,
        stage: &Stage,
        out: &Path,
        step: Step,
    ) -> Result<Option<Usage>, RunError> {
        executor.tools.run(&Request::Lights { capture: &executor.capture(stage), out }, step)?;
        Ok(None)
    }

    fn effort(&self, _: &Suite, _: &CaseSize, _: Option<&Method>) -> Effort {
        Effort { fixed: 2.0, rate: 0.0, work: 0.0, raw: 0.0, class: "lights".to_owned() }
    }

    fn memory(&self, _: &StageExecutor, _: &Stage) -> u64 {
        RENDERER
    }
}
