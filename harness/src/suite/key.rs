//! Keys of stages: hashes of what they read, and of nothing else. An output is valid while its key is the same.

use std::io;

use formats::content_hash::hash_parts;

use super::cases::Case;
use super::error::RunError;
use super::executor::{Contents, StageExecutor};
use super::output::OutputHashes;
use super::plan::{Stage, StageKind};
use super::preflight::ResolvedMethod;

/// Key of a stage's inputs, as a hash and in words.
pub(super) struct Key {
    pub hash: String,
    pub made_from: String,
}

impl Key {
    pub fn of(parts: &[&str]) -> Self {
        Self { hash: hash_parts(parts), made_from: String::new() }
    }
}

/// Everything that a stage can read.
pub(super) struct Inputs<'a> {
    pub executor: &'a StageExecutor<'a>,
    pub case: &'a Case,
    stage: &'a Stage,
    photographed: Option<OutputHashes>,
    contents: &'a Contents,
}

impl<'a> Inputs<'a> {
    /// Hashes of the output of the stage of another kind, of the same case and method, unless it is unknown.
    pub fn output(&self, kind: StageKind) -> Option<&OutputHashes> {
        let method = self.executor.method(self.stage).filter(|_| kind.has_method());
        self.contents.get(&kind.id(&self.case.id, method.map(|found| &*found.method.id)))
    }

    /// The hash of such an output.
    pub fn content(&self, kind: StageKind) -> Result<&str, RunError> {
        Ok(&self.output(kind).ok_or_else(|| self.missing())?.content)
    }

    /// Hashes of the case's capture.
    pub fn capture(&self) -> Result<&OutputHashes, RunError> {
        let rendered = || self.output(StageKind::Capture);
        self.photographed.as_ref().or_else(rendered).ok_or_else(|| self.missing())
    }

    /// The stage's method.
    pub fn method(&self) -> Result<&'a ResolvedMethod<'a>, RunError> {
        self.executor.method(self.stage).ok_or_else(|| self.missing())
    }

    /// Versions and code of a stage of the renderer.
    pub fn rendered_by(&self, stage: &str) -> Result<&'a str, RunError> {
        let reason =
            || format!("the package `unshade` has no stage {stage:?}; install this version of it");
        Ok(self.executor.renderer.of(stage).ok_or_else(|| io::Error::other(reason()))?)
    }

    /// The error of a stage whose inputs are not known yet.
    pub fn missing(&self) -> RunError {
        RunError::Folder(io::Error::other(format!("{}: comes too early", self.stage.id)))
    }
}

impl StageExecutor<'_> {
    /// Key of a stage; `contents` hold the stages that come before it.
    pub fn key(&self, stage: &Stage, contents: &Contents) -> Result<Key, RunError> {
        let case = &self.suite.cases[stage.case];
        let photographed = self.photographed(stage.case)?;
        stage.kind.work().key(&Inputs { executor: self, case, stage, photographed, contents })
    }
}

#[cfg(test)]
mod tests;
