//! A program of the user.

use std::path::Path;

use toml::Value;

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::MethodKind;
use crate::suite::method_work::{Fault, MethodWork, bytes_of_maps, cost_class};
use crate::suite::plan::StageKind;
use crate::suite::preflight::ResolvedMethod;
use crate::suite::program::{Gives, Place, Program, ProgramFiles, SEED, Usage};
use crate::suite::stage_work::{Effort, Step};
use crate::synth::{Interpreter, Tools};

/// Memory of a program that states no limit, bytes.
const UNSTATED: u64 = 2 << 30;

impl MethodWork for Program {
    fn gives_pictures(&self) -> bool {
        self.gives == Gives::Pictures
    }

    fn find(&self, ours: &Interpreter) -> Result<Option<ProgramFiles>, Fault> {
        if let Some(missing) = self.inputs.iter().find(|input| !input.exists()) {
            let reason = format!("there is no {}; name a file or folder", missing.display());
            return Err(("inputs", reason));
        }
        Program::find(self, ours).map(Some).map_err(|reason| (Program::toml_key(self), reason))
    }

    fn key(&self, resolved: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError> {
        let files = resolved.files.as_ref().ok_or_else(|| inputs.missing())?;
        let ours = inputs.rendered_by("python")?;
        let program_key = files.key(self, &inputs.executor.trees, ours)?;
        let mut parts = vec!["program", &inputs.capture()?.given, &program_key];
        if MethodWork::gives_pictures(self) {
            // Its pictures become maps by the code that reads captures.
            parts.push(inputs.executor.sources.capture);
            parts.extend(inputs.output(StageKind::Lights).map(|lights| &*lights.content));
        }
        Ok(Key { made_from: files.in_words(self), ..Key::of(&parts) })
    }

    fn identity(&self, resolved: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
        Ok(resolved.files.as_ref().map(|files| files.content(self)).transpose()?)
    }

    fn make(
        &self,
        resolved: &ResolvedMethod,
        place: &Place,
        tools: &Tools,
        step: Step,
    ) -> Result<Option<Usage>, RunError> {
        let id = &resolved.method.id;
        let missing = || RunError::Program { name: id.clone(), reason: "was not found".to_owned() };
        let files = resolved.files.as_ref().ok_or_else(missing)?;
        self.run(id, files, place, &tools.interrupt, step).map(Some)
    }

    fn effort(&self, size: &CaseSize) -> Effort {
        Effort {
            fixed: 1.0,
            rate: 10.0,
            work: 1e-6 * size.train,
            raw: bytes_of_maps(size.solved_texels()),
            class: cost_class(&MethodKind::Program(Box::new(self.clone()))),
        }
    }

    fn memory(&self, _: &Path, _: &CaseSize) -> u64 {
        let stated = self.limits.memory_gib;
        stated.map_or(UNSTATED, |gib| (gib * f64::from(1 << 30)) as u64)
    }
}

impl Program {
    pub(super) fn reseed(&mut self, add: i64) {
        let seed = self.settings.get("seed").and_then(Value::as_integer).unwrap_or(0) + add;
        if let Some(stated) = self.settings.get_mut("seed") {
            *stated = Value::Integer(seed);
        }
        self.environment.insert(SEED.to_owned(), seed.to_string());
    }
}
