//! Renders a case.

use std::path::Path;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::executor::StageExecutor;
use crate::suite::file::Suite;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::Method;
use crate::suite::plan::{Stage, StageKind};
use crate::suite::program::Usage;
use crate::suite::stage_work::{Effort, StageWork, Step, rendering_memory};
use crate::synth::Request;

pub(super) struct Capture;

impl StageWork for Capture {
    fn key(&self, inputs: &Inputs) -> Result<Key, RunError> {
        let [scene, files] = inputs.case.scene.key()?;
        Ok(Key::of(&["capture", inputs.rendered_by("capture")?, &scene, &files]))
    }

    fn make(
        &self,
        executor: &StageExecutor,
        stage: &Stage,
        out: &Path,
        step: Step,
    ) -> Result<Option<Usage>, RunError> {
        let id = &executor.suite.cases[stage.case].id;
        let scene = executor.out.join(StageKind::Capture.folder()).join(format!("{id}.toml"));
        executor.tools.run(&Request::Synth { scene: &scene, out }, step)?;
        Ok(None)
    }

    fn effort(&self, _: &Suite, size: &CaseSize, _: Option<&Method>) -> Effort {
        let pixels = size.train + size.test * (1.0 + size.other_lights);
        Effort {
            fixed: 4.0,
            rate: 0.9,
            work: 1e-6 * size.samples * pixels,
            raw: size.capture_bytes(),
            class: "capture".to_owned(),
        }
    }

    fn memory(&self, executor: &StageExecutor, stage: &Stage) -> u64 {
        rendering_memory(&CaseSize::of(&executor.suite.cases[stage.case]))
    }
}
