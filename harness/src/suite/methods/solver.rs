//! Our own solver.

use std::path::Path;

use scoring::run::{Class, Kind};
use solver::memory::Estimate;
use solver::{Config, Extent};
use toml::{Table, Value};

use crate::suite::case_size::CaseSize;
use crate::suite::error::RunError;
use crate::suite::key::{Inputs, Key};
use crate::suite::method::SolverMethod;
use crate::suite::method_work::{Fault, MethodWork, bytes_of_maps};
use crate::suite::preflight::ResolvedMethod;
use crate::suite::program::{Place, ProgramFiles, Usage};
use crate::suite::seeds::Vary;
use crate::suite::solve::{in_words, solve};
use crate::suite::sources::SOLVER_SOURCES;
use crate::suite::stage_work::{Effort, SMALL, Step};
use crate::synth::{Interpreter, Tools};

impl MethodWork for SolverMethod {
    fn role(&self) -> Kind {
        if self.given.is_empty() { Kind::Solver } else { Kind::Privileged }
    }

    fn class(&self) -> Class {
        if self.given.is_empty() { Class::Passive } else { Class::Privileged }
    }

    fn find(&self, _: &Interpreter) -> Result<Option<ProgramFiles>, Fault> {
        self.backend.open().map_err(|error| ("backend", error.to_string()))?;
        let config =
            Config::from_toml(&self.config).map_err(|error| ("config", error.to_string()))?;
        if let (Config::Paper(_), false) = (config, self.given.is_empty()) {
            return Err(("given", solver::SolveError::GivenToOther.to_string()));
        }
        Ok(None)
    }

    fn key(&self, _: &ResolvedMethod, inputs: &Inputs) -> Result<Key, RunError> {
        // The resolved values, so that a preset that changed is solved again; and what computes here, since no two
        // devices give the same bytes.
        let config = Config::from_toml(&self.config)?.to_toml();
        let backend = self.backend.open()?.name();
        let capture = inputs.capture()?;
        let mut parts =
            vec!["fields", &capture.given, &config, &backend, inputs.executor.sources.solver];
        let known = self.known();
        if !known.is_empty() {
            parts.extend([&*known, &capture.truth]);
        }
        let made_from = format!("this program's sources of the solver, on {backend}");
        Ok(Key { made_from, ..Key::of(&parts) })
    }

    fn identity(&self, _: &ResolvedMethod) -> Result<Option<Vec<String>>, RunError> {
        let config = Config::from_toml(&self.config)?.to_toml();
        let mut parts = vec![config, SOLVER_SOURCES.to_owned()];
        parts.extend(Some(self.known()).filter(|known| !known.is_empty()));
        Ok(Some(parts))
    }

    fn make(
        &self,
        _: &ResolvedMethod,
        place: &Place,
        tools: &Tools,
        step: Step,
    ) -> Result<Option<Usage>, RunError> {
        let config = Config::from_toml(&self.config)?;
        let backend = self.backend.open()?;
        let capture = capture::Capture::open(place.capture)?.with_truth(&self.given)?;
        solve(&*backend, &capture, &config, place.maps, tools, &mut |progress| {
            step(progress.iteration as u64, progress.total as u64, &in_words(progress));
        })?;
        Ok(None)
    }

    fn effort(&self, size: &CaseSize) -> Effort {
        let (views, pixels) = (size.views, size.covered as usize);
        let work = Config::from_toml(&self.config).map_or(0.0, |config| {
            let texture_size = config.texture_size().expected(views, pixels);
            let extent = Extent { views, pixels, texture_size, has_changing_light: false };
            solver::seconds_on_two_cores(&config, &extent)
        });
        // The work counts the steps, whatever the configuration; only the device differs.
        let class = format!("maps fields {:?}", self.backend);
        Effort { fixed: 0.2, rate: 1.0, work, raw: bytes_of_maps(size.solved_texels()), class }
    }

    fn memory(&self, capture: &Path, _: &CaseSize) -> u64 {
        match (capture::Capture::open(capture), Config::from_toml(&self.config)) {
            (Ok(capture), Ok(config)) => Estimate::new(&capture, &config).peak,
            // The stage itself reports what is wrong with them.
            _ => SMALL,
        }
    }
}

impl SolverMethod {
    /// Names of the parts that it holds at their truth.
    fn known(&self) -> String {
        self.given.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
    }

    pub(super) fn reseed(&mut self, add: i64, vary: Vary) -> Result<(), Fault> {
        let given = Config::from_toml(&self.config).map_err(|e| ("config", e.to_string()))?;
        let mut values: Table = self.config.parse().map_err(|e| unreadable(&e))?;
        if vary == Vary::Rounding {
            let rendering = values.entry("rendering").or_insert(Table::new().into());
            if let Some(rendering) = rendering.as_table_mut() {
                rendering.insert("rounding_seed".to_owned(), add.into());
            }
        } else {
            let seed = Value::Integer((given.seed() as i64).wrapping_add(add));
            values.insert("seed".to_owned(), seed);
        }
        self.config = toml::to_string(&values).map_err(|e| ("config", e.to_string()))?;
        Ok(())
    }
}

fn unreadable(error: &toml::de::Error) -> Fault {
    ("config", error.to_string())
}
