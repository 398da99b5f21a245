//! Renders maps, or takes a method's own pictures: what is compared with the truth's relit pictures.

use std::fs;
use std::path::Path;

use formats::atomic::Folder;
use scoring::score;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::executor::StageExecutor;
use crate::suite::file::Suite;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::Method;
use crate::suite::plan::{Stage, StageKind};
use crate::suite::program::Usage;
use crate::suite::stage_work::{Effort, StageWork, Step, relit_pixels, rendering_memory};
use crate::suite::stages::{Relight, relight};

pub(super) struct Relit;

impl StageWork for Relit {
    fn key(&self, inputs: &Inputs) -> Result<Key, RunError> {
        let suite = inputs.executor.suite;
        let photographed = inputs.case.photographed.is_some();
        let by = if photographed { "photographed" } else { suite.relight };
        let scales = suite.scales.join(" ");
        let capture = &inputs.capture()?.content;
        let mut parts = vec!["relit", capture, inputs.content(StageKind::Maps)?];
        parts.extend([by, inputs.rendered_by(by)?, &scales]);
        // The albedo's one factor, and pictures that are a method's own, come from there.
        let own = inputs.method()?.method.work().gives_pictures();
        if suite.scales.contains(&"global") || own {
            parts.push(inputs.executor.sources.scores);
        }
        Ok(Key::of(&parts))
    }

    fn make(
        &self,
        executor: &StageExecutor,
        stage: &Stage,
        out: &Path,
        step: Step,
    ) -> Result<Option<Usage>, RunError> {
        let (suite, tools) = (executor.suite, executor.tools);
        let (capture, maps) = (&executor.capture(stage), &executor.output(stage, StageKind::Maps));
        let method = executor.method(stage);
        let gives_pictures = method.is_some_and(|found| found.method.work().gives_pictures());
        let own = gives_pictures && maps.join("relit").is_dir();
        if own {
            score::keep_own_relit(capture, maps, out, &suite.scales)?;
        } else if !gives_pictures || maps.join("diffuse_albedo.exr").is_file() {
            let (renderer, scales) = (suite.relight, &suite.scales);
            relight(&Relight { capture, maps, out, renderer, scales, light: None }, tools, step)?;
        } else {
            let folder = Folder::begin(out)?;
            fs::write(folder.path().join("relit.json"), "{\"scales\": {}}\n")?;
            folder.commit()?;
        }
        Ok(None)
    }

    fn effort(&self, suite: &Suite, size: &CaseSize, method: Option<&Method>) -> Effort {
        let pixels = relit_pixels(suite, size, method);
        Effort {
            fixed: 2.2,
            rate: 0.4,
            work: 1e-6 * size.samples * pixels,
            raw: 4.0 * 9.0 * pixels,
            class: format!("relit {}", suite.relight),
        }
    }

    fn memory(&self, executor: &StageExecutor, stage: &Stage) -> u64 {
        rendering_memory(&CaseSize::of(&executor.suite.cases[stage.case]))
    }
}
