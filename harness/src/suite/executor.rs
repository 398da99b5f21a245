//! Executes one stage of a suite, unless its earlier output is still valid.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use super::error::RunError;
use super::file::Suite;
use super::finished::{Provenance, Record};
use super::output::OutputHashes;
use super::plan::{Stage, StageKind};
use super::preflight::ResolvedMethod;
use super::program::Usage;
use super::record::{Records, now};
use super::size::size_of;
use super::sources::Sources;
use super::tree_hashes::TreeHashes;
use crate::synth::{Fingerprints, Tools};

/// Everything that the stages of a run share, and what executes one of them.
pub(super) struct StageExecutor<'a> {
    pub suite: &'a Suite,
    /// The run's folder.
    pub out: &'a Path,
    pub tools: &'a Tools,
    /// Versions and code of the renderer, part of keys.
    pub renderer: &'a Fingerprints,
    pub methods: &'a [ResolvedMethod<'a>],
    /// Methods whose maps are made anew.
    pub redo: &'a [String],
    /// Hashes of photographed captures, by case: gigabytes, read once.
    photographed: Mutex<BTreeMap<usize, OutputHashes>>,
    /// Hashes of what programs import.
    pub trees: TreeHashes,
    /// Code of this program, part of keys.
    pub sources: Sources,
}

/// Folder of a run for the other output of programs.
pub(super) const DEBUG: &str = "debug";

/// Hashes of finished stages' outputs, by their ids.
pub(super) type Contents = BTreeMap<String, OutputHashes>;

/// A stage that is finished.
pub(super) struct StageResult {
    pub record: Record,
    /// Whether an earlier output was still valid.
    pub kept: bool,
}

impl<'a> StageExecutor<'a> {
    pub fn new(
        suite: &'a Suite,
        out: &'a Path,
        tools: &'a Tools,
        renderer: &'a Fingerprints,
        methods: &'a [ResolvedMethod<'a>],
        redo: &'a [String],
    ) -> Self {
        let (photographed, trees) = (Mutex::default(), TreeHashes::of_user());
        let sources = Sources::BUILT;
        Self { suite, out, tools, renderer, methods, redo, photographed, trees, sources }
    }

    /// The hashes of a case's photographed capture; none of a rendered one.
    pub fn photographed(&self, case: usize) -> io::Result<Option<OutputHashes>> {
        let Some(path) = &self.suite.cases[case].photographed else { return Ok(None) };
        let mut known = self.photographed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(hash) = known.get(&case) {
            return Ok(Some(hash.clone()));
        }
        let hash = OutputHashes::of(StageKind::Capture, path)?;
        known.insert(case, hash.clone());
        Ok(Some(hash))
    }

    /// Where the output of a stage lies.
    pub fn path(&self, stage: &Stage) -> PathBuf {
        self.out.join(&stage.path)
    }

    /// The capture's folder of a case.
    pub fn capture(&self, stage: &Stage) -> PathBuf {
        let case = &self.suite.cases[stage.case];
        let rendered = || self.out.join(StageKind::Capture.folder()).join(&case.id);
        case.photographed.clone().unwrap_or_else(rendered)
    }

    /// The output of the stage of another kind, of the same case and method.
    pub fn output(&self, stage: &Stage, kind: StageKind) -> PathBuf {
        let case = self.out.join(kind.folder()).join(&self.suite.cases[stage.case].id);
        self.method(stage).map_or(case.clone(), |found| case.join(&found.method.id))
    }

    /// The method of a stage that has one.
    pub fn method(&self, stage: &Stage) -> Option<&'a ResolvedMethod<'a>> {
        self.methods.get(stage.method?)
    }

    /// Returns whether `--redo` names the stage's method.
    pub fn is_redo(&self, stage: &Stage) -> bool {
        let method = self.method(stage).filter(|_| stage.kind == StageKind::Maps);
        method.is_some_and(|found| self.redo.contains(&found.method.id))
    }

    /// The earlier output of a stage, if it is still valid; none where its key cannot be computed.
    pub fn kept(
        &self,
        stage: &Stage,
        contents: &Contents,
        records: &Records,
    ) -> Result<Option<StageResult>, RunError> {
        let path = self.path(stage);
        let Ok(key) = self.key(stage, contents) else { return Ok(None) };
        let record = records.find_or_restore(&stage.id, &key.hash, &path)?;
        Ok(record.map(|record| StageResult { record, kept: true }))
    }

    /// Executes a stage unless its output is there, intact, and made from the same inputs.
    pub fn run(
        &self,
        stage: &Stage,
        contents: &Contents,
        records: &Records,
        step: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<StageResult, RunError> {
        self.run_by(stage, contents, records, |path| {
            stage.kind.work().make(self, stage, path, step)
        })
    }

    /// Executes a stage with a function that makes its output.
    pub(super) fn run_by(
        &self,
        stage: &Stage,
        contents: &Contents,
        records: &Records,
        make: impl FnOnce(&Path) -> Result<Option<Usage>, RunError>,
    ) -> Result<StageResult, RunError> {
        let key = self.key(stage, contents)?;
        let path = self.path(stage);
        if self.is_redo(stage) {
            records.forget(&stage.id, &key.hash)?;
        } else if let Some(record) = records.find_or_restore(&stage.id, &key.hash, &path)? {
            return Ok(StageResult { record, kept: true });
        }
        records.set_aside(&stage.id, &key.hash, &path)?;
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let start = Instant::now();
        let usage = make(&path)?;
        let output = OutputHashes::of(stage.kind, &path)?;
        records.write(&stage.id, &key.hash, &output)?;
        let effort = stage.effort(self.suite);
        let made = Provenance { at: now(), from: key.made_from, usage };
        let record = Record {
            id: stage.id.clone(),
            output,
            seconds: start.elapsed().as_secs_f64(),
            bytes: size_of(&path)?,
            work: effort.work,
            raw: effort.raw,
            what: effort.class,
            made,
        };
        Ok(StageResult { record, kept: false })
    }
}
