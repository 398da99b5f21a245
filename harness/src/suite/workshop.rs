//! Does one stage of a suite, unless what an earlier run left of it is still valid.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use scoring::score;

use super::cost;
use super::error::RunError;
use super::file::Suite;
use super::make_maps;
use super::output::Output;
use super::perceptual::lpips;
use super::plan::{Kind, Task};
use super::preflight::Ready;
use super::program::{self, Place};
use super::record::{Made, Record, Records, now};
use super::relit::{lights, relit};
use super::size::size_of;
use super::sources::Sources;
use super::tools::Tools;
use super::tree_hashes::TreeHashes;
use crate::synth::{Fingerprints, cli_args, run_stage};

/// Everything that the stages of a run share.
pub(super) struct Workshop<'a> {
    pub suite: &'a Suite,
    /// The run's folder.
    pub out: &'a Path,
    pub tools: &'a Tools,
    /// Versions and code of the renderer, part of keys.
    pub renderer: &'a Fingerprints,
    pub ready: &'a [Ready<'a>],
    /// Methods whose maps are made anew.
    pub redo: &'a [String],
    /// Hashes of photographed captures, by case: gigabytes, read once.
    photographed: Mutex<BTreeMap<usize, Output>>,
    /// Hashes of what programs import.
    pub trees: TreeHashes,
    /// Code of this program, part of keys.
    pub sources: Sources,
}

/// Folder of a run for what programs leave beside their maps.
pub(super) const DEBUG: &str = "debug";

/// Hashes of finished stages' outputs, by their ids.
pub(super) type Contents = BTreeMap<String, Output>;

/// A stage that is finished.
pub(super) struct Done {
    pub record: Record,
    /// Whether an earlier output was still valid.
    pub kept: bool,
}

impl<'a> Workshop<'a> {
    pub fn new(
        suite: &'a Suite,
        out: &'a Path,
        tools: &'a Tools,
        renderer: &'a Fingerprints,
        ready: &'a [Ready<'a>],
        redo: &'a [String],
    ) -> Self {
        let (photographed, trees) = (Mutex::default(), TreeHashes::of_user());
        let sources = Sources::BUILT;
        Self { suite, out, tools, renderer, ready, redo, photographed, trees, sources }
    }

    /// The hashes of a case's photographed capture; none of a rendered one.
    pub fn photographed(&self, case: usize) -> io::Result<Option<Output>> {
        let Some(path) = &self.suite.cases[case].photographed else { return Ok(None) };
        let mut known = self.photographed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(hash) = known.get(&case) {
            return Ok(Some(hash.clone()));
        }
        let hash = Output::of(Kind::Capture, path)?;
        known.insert(case, hash.clone());
        Ok(Some(hash))
    }

    /// Where the output of a stage lies.
    pub fn path(&self, task: &Task) -> PathBuf {
        self.out.join(&task.path)
    }

    /// The capture's folder of a case.
    pub fn capture(&self, task: &Task) -> PathBuf {
        let case = &self.suite.cases[task.case];
        let rendered = || self.out.join(Kind::Capture.folder()).join(&case.id);
        case.photographed.clone().unwrap_or_else(rendered)
    }

    pub fn ready(&self, task: &Task) -> Option<&'a Ready<'a>> {
        self.ready.get(task.method?)
    }

    /// Whether a stage is done whatever was kept.
    pub fn again(&self, task: &Task) -> bool {
        let ready = self.ready(task).filter(|_| task.kind == Kind::Maps);
        ready.is_some_and(|ready| self.redo.contains(&ready.method.id))
    }

    /// The earlier output of a stage, if it is still valid; none where its key cannot be computed.
    pub fn kept(
        &self,
        task: &Task,
        contents: &Contents,
        records: &Records,
    ) -> Result<Option<Done>, RunError> {
        let path = self.path(task);
        let Ok(key) = self.key(task, contents) else { return Ok(None) };
        let record = records.valid(&task.id, &key.hash, &path)?;
        Ok(record.map(|record| Done { record, kept: true }))
    }

    /// Executes a stage unless its output is there, intact, and made from the same inputs.
    pub fn run(
        &self,
        task: &Task,
        contents: &Contents,
        records: &Records,
        step: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<Done, RunError> {
        self.run_by(task, contents, records, |path| self.make(task, path, step))
    }

    /// Executes a stage with a function that makes its output.
    pub(super) fn run_by(
        &self,
        task: &Task,
        contents: &Contents,
        records: &Records,
        make: impl FnOnce(&Path) -> Result<Made, RunError>,
    ) -> Result<Done, RunError> {
        let key = self.key(task, contents)?;
        let path = self.path(task);
        if self.again(task) {
            records.forget(&task.id, &key.hash)?;
        } else if let Some(record) = records.valid(&task.id, &key.hash, &path)? {
            return Ok(Done { record, kept: true });
        }
        records.set_aside(&task.id, &key.hash, &path)?;
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let start = Instant::now();
        let made = make(&path)?;
        let output = Output::of(task.kind, &path)?;
        records.adopt(&task.id, &key.hash, &output)?;
        let made = Made { at: now(), from: key.made_from, ..made };
        let record = Record {
            id: task.id.clone(),
            output,
            seconds: start.elapsed().as_secs_f64(),
            bytes: size_of(&path)?,
            work: cost::work(self.suite, task),
            raw: cost::raw(self.suite, task),
            what: cost::what(self.suite, task),
            made,
        };
        Ok(Done { record, kept: false })
    }

    fn make(
        &self,
        task: &Task,
        path: &Path,
        step: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<Made, RunError> {
        let (case, tools) = (&self.suite.cases[task.case], self.tools);
        let capture = self.capture(task);
        let Some(ready) = self.ready(task) else {
            if task.kind == Kind::Lights {
                lights(&capture, path, tools, step)?;
            } else {
                let scene = self.out.join(Kind::Capture.folder()).join(format!("{}.toml", case.id));
                let arguments =
                    cli_args(&[("--scene", scene.as_os_str()), ("--out", path.as_os_str())]);
                run_stage(&tools.interpreter, "synth", &arguments, &tools.interrupt, step)?;
            }
            return Ok(Made::default());
        };
        let method = ready.method;
        let name = format!("{}/{}", case.id, method.id);
        let below = |kind: Kind| self.out.join(kind.folder()).join(&name);
        let maps = below(Kind::Maps);
        if task.kind == Kind::Maps {
            let files = case.scene.files().into_iter().chain(case.photographed.clone());
            let handed = self.out.join(Kind::Lights.folder()).join(&case.id);
            let given = method.gives_pictures() && case.photographed.is_none();
            let place = Place {
                capture: &capture,
                maps: path,
                lights: given.then_some(handed.as_path()),
                log: &self.out.join("logs").join(format!("{name}.txt")),
                debug: &self.out.join(DEBUG).join(&name),
                secret: files.chain([self.out.to_path_buf()]).collect(),
                scratch: &program::scratch_prefix(self.out),
            };
            let usage = make_maps::make_maps(ready, place, tools, step)?;
            return Ok(Made { usage, ..Made::default() });
        }
        if task.kind == Kind::Relit {
            let places = [capture.as_path(), &maps, path];
            relit(self.suite.relight, method, places, &self.suite.scales, tools, step)?;
        } else {
            let mut scores = score::score(&capture, &maps, Some(&below(Kind::Relit)))?;
            scores.solver.clone_from(&method.id);
            if let Some(net) = self.suite.lpips {
                let relit = below(Kind::Relit);
                scores.rows.extend(lpips(net, &capture, &maps, Some(&relit), tools)?);
            }
            let (of, relit) = ([capture.as_path(), &maps], below(Kind::Relit));
            self.suite.metrics.add_rows(&mut scores, of, Some(&relit), tools)?;
            scores.write(path)?;
        }
        Ok(Made::default())
    }
}
