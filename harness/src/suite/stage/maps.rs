//! Turns a capture into maps, by a method.

use std::path::Path;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::executor::{DEBUG, StageExecutor};
use crate::suite::file::Suite;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::Method;
use crate::suite::plan::{Stage, StageKind};
use crate::suite::program::{self, Place, Usage};
use crate::suite::stage_work::{Effort, SMALL, StageWork, Step};

pub(super) struct Maps;

impl StageWork for Maps {
    fn key(&self, inputs: &Inputs) -> Result<Key, RunError> {
        let resolved = inputs.method()?;
        if !resolved.found {
            return Err(inputs.missing());
        }
        resolved.method.work().key(resolved, inputs)
    }

    fn make(
        &self,
        executor: &StageExecutor,
        stage: &Stage,
        out: &Path,
        step: Step,
    ) -> Result<Option<Usage>, RunError> {
        let Some(resolved) = executor.method(stage) else { return Ok(None) };
        let case = &executor.suite.cases[stage.case];
        let run = executor.out;
        let name = format!("{}/{}", case.id, resolved.method.id);
        let files = case.scene.files().into_iter().chain(case.photographed.clone());
        let lights = run.join(StageKind::Lights.folder()).join(&case.id);
        let has_lights = resolved.method.work().gives_pictures() && case.photographed.is_none();
        let place = Place {
            capture: &executor.capture(stage),
            maps: out,
            lights: has_lights.then_some(lights.as_path()),
            log: &run.join("logs").join(format!("{name}.txt")),
            debug: &run.join(DEBUG).join(&name),
            secret: files.chain([run.to_path_buf()]).collect(),
            scratch: &program::scratch_prefix(run),
        };
        resolved.method.work().make(resolved, &place, executor.tools, step)
    }

    fn effort(&self, _: &Suite, size: &CaseSize, method: Option<&Method>) -> Effort {
        match method {
            Some(method) => method.work().effort(size),
            None => Effort { fixed: 0.0, rate: 0.0, work: 0.0, raw: 0.0, class: String::new() },
        }
    }

    fn memory(&self, executor: &StageExecutor, stage: &Stage) -> u64 {
        let size = CaseSize::of(&executor.suite.cases[stage.case]);
        let capture = executor.capture(stage);
        executor.method(stage).map_or(SMALL, |found| found.method.work().memory(&capture, &size))
    }
}
