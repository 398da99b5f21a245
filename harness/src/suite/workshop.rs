//! Does one stage of a suite, unless what an earlier run left of it is still valid.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use formats::content_hash::{hash_parts, hash_path};
use scoring::score;

use super::cost;
use super::error::RunError;
use super::file::{RENDERERS, Suite};
use super::make_maps;
use super::method::MethodKind;
use super::perceptual::lpips;
use super::plan::{Kind, Task};
use super::preflight::Ready;
use super::program::{self, Place};
use super::record::{Made, Record, Records, now};
use super::relit::{lights, relit};
use super::size::size_of;
use super::sources::{SCORE_SOURCES, SOLVER_SOURCES};
use super::stages::words;
use super::tools::Tools;
use crate::synth::run_stage;

/// Everything that the stages of a run share.
pub(super) struct Workshop<'a> {
    pub suite: &'a Suite,
    /// The run's folder.
    pub out: &'a Path,
    pub tools: &'a Tools,
    /// Fingerprint of the renderer, part of keys.
    pub renderer: &'a str,
    pub ready: &'a [Ready<'a>],
    /// Methods whose maps are made anew.
    pub redo: &'a [String],
    /// Hashes of photographed captures, by case: gigabytes, read once.
    photographed: Mutex<BTreeMap<usize, String>>,
}

/// Folder of a run for what programs leave beside their maps.
pub(super) const DEBUG: &str = "debug";

/// Content hashes of finished stages, by their ids.
pub(super) type Contents = BTreeMap<String, String>;

/// Key of a stage's inputs, as a hash and in words: an earlier output is valid while it is the
/// same.
pub(super) struct Key {
    pub hash: String,
    pub made_from: String,
}

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
        renderer: &'a str,
        ready: &'a [Ready<'a>],
        redo: &'a [String],
    ) -> Self {
        Self { suite, out, tools, renderer, ready, redo, photographed: Mutex::default() }
    }

    /// The hash of a case's photographed capture; none of a rendered one.
    fn photographed(&self, case: usize) -> io::Result<Option<String>> {
        let Some(path) = &self.suite.cases[case].photographed else { return Ok(None) };
        let mut known = self.photographed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(hash) = known.get(&case) {
            return Ok(Some(hash.clone()));
        }
        let hash = hash_path(path)?;
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

    fn ready(&self, task: &Task) -> Option<&'a Ready<'a>> {
        self.ready.get(task.method?)
    }

    /// Key of a stage; `contents` hold the stages that come before it.
    pub fn key(&self, task: &Task, contents: &Contents) -> Result<Key, RunError> {
        let case = &self.suite.cases[task.case];
        let of = |kind: Kind| {
            let name = task.id.split_once('/').map_or("", |(_, name)| name);
            let name = if matches!(kind, Kind::Capture | Kind::Lights) { &case.id } else { name };
            contents.get(&format!("{}/{name}", kind.word())).map(String::as_str)
        };
        let missing =
            || RunError::Folder(io::Error::other(format!("{}: comes too early", task.id)));
        let photographed = self.photographed(task.case)?;
        let capture = || photographed.as_deref().or(of(Kind::Capture)).ok_or_else(missing);
        let plain = |inputs: &[&str]| Key { hash: hash_parts(inputs), made_from: String::new() };
        let renderer = self.renderer;
        Ok(match task.kind {
            Kind::Capture => {
                let scene = case.scene.to_toml().map_err(io::Error::other)?;
                plain(&["capture", renderer, &scene, &case.scene.content()?])
            }
            Kind::Lights => plain(&["lights", capture()?, renderer]),
            Kind::Maps => {
                let ready = self.ready(task).filter(|ready| ready.found).ok_or_else(missing)?;
                let (key, made_from) = method_key(ready, renderer)?;
                let mut inputs = vec!["maps", capture()?, &key];
                inputs.extend(of(Kind::Lights).filter(|_| ready.method.gives_pictures()));
                Key { hash: hash_parts(&inputs), made_from }
            }
            Kind::Relit => {
                let mut how = self.suite.scales.join(" ");
                if self.suite.relight != RENDERERS[0] {
                    how = format!("{how} {}", self.suite.relight);
                }
                let maps = of(Kind::Maps).ok_or_else(missing)?;
                plain(&["relit", capture()?, maps, renderer, SCORE_SOURCES, &how])
            }
            Kind::Scores => {
                let maps = of(Kind::Maps).ok_or_else(missing)?;
                let relit = of(Kind::Relit).ok_or_else(missing)?;
                let mut inputs = vec!["scores", capture()?, maps, relit, SCORE_SOURCES];
                inputs.extend(self.suite.lpips);
                plain(&inputs)
            }
        })
    }

    /// Whether a stage is done whatever was kept.
    pub fn again(&self, task: &Task) -> bool {
        let ready = self.ready(task).filter(|_| task.kind == Kind::Maps);
        ready.is_some_and(|ready| self.redo.contains(&ready.method.id))
    }

    /// What an earlier run left of a stage, if it is still valid; none too where that cannot be told.
    pub fn kept(
        &self,
        task: &Task,
        contents: &Contents,
        records: &Records,
    ) -> Result<Option<Done>, RunError> {
        let path = self.path(task);
        let Ok(key) = self.key(task, contents) else { return Ok(None) };
        let Some(content) = records.finished(&task.id, &key.hash, &path) else { return Ok(None) };
        Ok(Some(Done { record: records.kept(&task.id, content, &path)?, kept: true }))
    }

    /// Does a stage unless its output is there, intact, and made from the same inputs.
    pub fn run(
        &self,
        task: &Task,
        contents: &Contents,
        records: &Records,
        step: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<Done, RunError> {
        let key = self.key(task, contents)?;
        let path = self.path(task);
        let kept = records.finished(&task.id, &key.hash, &path).filter(|_| !self.again(task));
        if let Some(content) = kept {
            return Ok(Done { record: records.kept(&task.id, content, &path)?, kept: true });
        }
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let start = Instant::now();
        let made = self.make(task, &path, step)?;
        let content = records.note(&task.id, &key.hash, &path)?;
        let made = Made { at: now(), from: key.made_from, ..made };
        let record = Record {
            id: task.id.clone(),
            content,
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
                    words(&[("--scene", scene.as_os_str()), ("--out", path.as_os_str())]);
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
            scores.write(path)?;
        }
        Ok(Made::default())
    }
}

/// Key of a method's maps beside the capture: a hash's text, and words.
fn method_key(ready: &Ready, renderer: &str) -> Result<(String, String), RunError> {
    Ok(match (&ready.method.kind, &ready.files) {
        (MethodKind::Fields { config, backend }, _) => {
            // The resolved values, so that a preset that changed is solved again; and what
            // computes here, since no two devices give the same bytes.
            let config = solver::Config::from_toml(config)?.to_toml();
            let backend = backend.open()?.name();
            let from = format!("this program's sources of the solver, on {backend}");
            (hash_parts(&["fields", &config, &backend, SOLVER_SOURCES]), from)
        }
        (MethodKind::Program(program), Some(files)) => {
            (hash_parts(&["program", &files.key(program)?]), files.in_words(program))
        }
        (MethodKind::Baseline { baseline, texture_size }, _) => {
            let size = texture_size.to_string();
            (hash_parts(&["baseline", baseline.name(), &size, SOLVER_SOURCES]), String::new())
        }
        (MethodKind::Competitor { competitor, settings }, _) => {
            (hash_parts(&["competitor", competitor.name, settings, renderer]), String::new())
        }
        (MethodKind::LabelMeans, _) => {
            (hash_parts(&["label-means", SOLVER_SOURCES, SCORE_SOURCES]), String::new())
        }
        (MethodKind::Oracle | MethodKind::Program(_), _) => {
            (hash_parts(&["oracle", SCORE_SOURCES]), String::new())
        }
    })
}
