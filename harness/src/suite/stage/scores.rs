//! Measures maps and pictures.

use std::path::Path;

use scoring::score;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::executor::StageExecutor;
use crate::suite::file::Suite;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::Method;
use crate::suite::perceptual::lpips;
use crate::suite::plan::{Stage, StageKind};
use crate::suite::program::Usage;
use crate::suite::stage_work::{Effort, SMALL, StageWork, Step, lights_of, relit_pixels};

pub(super) struct Scores;

impl StageWork for Scores {
    fn key(&self, inputs: &Inputs) -> Result<Key, RunError> {
        let (suite, sources) = (inputs.executor.suite, inputs.executor.sources);
        let (maps, relit) = (inputs.content(StageKind::Maps)?, inputs.content(StageKind::Relit)?);
        let mut parts = vec!["scores", &inputs.capture()?.content, maps, relit, sources.scores];
        if let Some(net) = suite.lpips {
            parts.extend([net, inputs.rendered_by("lpips")?]);
        }
        parts.extend(suite.metrics.key(inputs.executor.tools)?);
        Ok(Key::of(&parts))
    }

    fn make(
        &self,
        executor: &StageExecutor,
        stage: &Stage,
        out: &Path,
        _: Step,
    ) -> Result<Option<Usage>, RunError> {
        let (suite, tools) = (executor.suite, executor.tools);
        let capture = executor.capture(stage);
        let [maps, relit] =
            [StageKind::Maps, StageKind::Relit].map(|kind| executor.output(stage, kind));
        let mut scores = score::score(&capture, &maps, Some(&relit))?;
        // `solve.json` names the preset; the rows are those of the suite's method.
        if let Some(found) = executor.method(stage) {
            scores.solver.clone_from(&found.method.id);
        }
        if let Some(net) = suite.lpips {
            scores.rows.extend(lpips(net, &capture, &maps, Some(&relit), tools)?);
        }
        suite.metrics.add_rows(&mut scores, [&capture, &maps], Some(&relit), tools)?;
        scores.write(out)?;
        Ok(None)
    }

    fn effort(&self, suite: &Suite, size: &CaseSize, method: Option<&Method>) -> Effort {
        // The views that a method synthesises itself are scored too.
        let pixels = relit_pixels(suite, size, method) + size.test + size.texels;
        Effort {
            fixed: 0.3,
            rate: 1.5,
            work: 1e-6 * pixels,
            raw: 4.0 * 2e4 * lights_of(size, method),
            class: "scores".to_owned(),
        }
    }

    fn memory(&self, _: &StageExecutor, _: &Stage) -> u64 {
        SMALL
    }
}
