//! Runs a suite: capture, solve, relight, score for every case, then the report.
//!
//! A stage whose inputs have not changed is skipped; every output appears complete or not at
//! all, so a run that was killed goes on where it stopped and ends with the same bytes.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use formats::atomic;
use formats::content_hash::{hash_parts, hash_path};
use scoring::score;

use super::cases::Case;
use super::error::RunError;
use super::file::{RENDERERS, Suite};
use super::make_maps;
use super::manifest::manifest;
use super::method::{Method, MethodKind};
use super::preflight::{self, Ready};
use super::program::{self, Place};
use super::record::{Made, Records};
use super::relit::{lights, relit};
use super::sources::{SCORE_SOURCES, SOLVER_SOURCES};
use super::stages::words;
use super::tools::{Observer, Tools};
use crate::synth::run_stage;

/// The stage that comes last.
const REPORT: &str = "report";

/// What a run is told beside its suite.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// Methods whose maps are made anew, whatever was kept.
    pub redo: Vec<String>,
}

/// What a run left behind.
#[derive(Debug)]
pub struct RunSummary {
    /// The page to open.
    pub report: PathBuf,
    /// Stages that ran, and stages whose earlier results were still valid.
    pub ran: usize,
    /// See `ran`.
    pub skipped: usize,
    /// Methods that failed: `<case>/<method>` and why.
    pub failed: BTreeMap<String, String>,
}

/// Runs `suite` in the folder `out`. A method that fails leaves its cells empty and the others run.
pub fn run(
    suite: &Suite,
    out: &Path,
    options: &RunOptions,
    tools: &Tools,
    observer: &mut dyn Observer,
) -> Result<RunSummary, RunError> {
    check_redo(suite, options)?;
    preflight::files(suite)?;
    let ready = preflight::methods(suite, tools)?;
    atomic::refuse_overlap(out, &[&suite.path])?;
    atomic::claim(out)?;
    let lock = File::create(out.join(".lock"))?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => return Err(RunError::Busy(out.to_path_buf())),
        Err(TryLockError::Error(error)) => return Err(error.into()),
    }
    program::clear_scratch(&program::scratch_prefix(out));
    let renderer = tools.interpreter.fingerprint()?;
    let rendered = suite.cases.iter().filter(|case| case.photographed.is_none()).count();
    let handed = suite.methods.iter().any(Method::gives_pictures);
    let rendered = if handed { 2 * rendered } else { rendered };
    let total = rendered + suite.cases.len() * 3 * suite.methods.len() + 1;
    let records = Records::open(out)?;
    let failed = BTreeMap::new();
    let mut stages =
        Stages { suite, out, options, tools, observer, records, failed, ran: 0, skipped: 0, total };
    stages.write_manifest(&renderer)?;
    stages.prepare(&renderer)?;
    for case in &suite.cases {
        let capture = stages.capture(case, &renderer)?;
        let lights = stages.lights(case, &capture, &renderer)?;
        for ready in &ready {
            let given = Given { capture: &capture, lights: lights.as_ref() };
            stages.run_method(case, ready, given, &renderer)?;
        }
    }
    stages.write_manifest(&renderer)?;
    let Stages { ran, skipped, failed, .. } = stages;
    let folder = out.join("report");
    let start = Instant::now();
    observer.stage_begins(REPORT, ran + skipped, total);
    report(out, &folder, tools, &mut |done, total, what| observer.step(done, total, what))?;
    observer.stage_ends(REPORT, Some(start.elapsed().as_secs_f64()));
    Ok(RunSummary { report: folder.join("index.html"), ran, skipped, failed })
}

fn check_redo(suite: &Suite, options: &RunOptions) -> Result<(), RunError> {
    let known = |name: &String| suite.methods.iter().any(|method| method.id == *name);
    match options.redo.iter().find(|name| !known(name)) {
        None => Ok(()),
        Some(name) => {
            let ids: Vec<_> = suite.methods.iter().map(|method| method.id.as_str()).collect();
            Err(RunError::Redo { name: name.clone(), known: ids.join(", ") })
        }
    }
}

/// Writes the report of the run folder `run` to the folder `out`.
pub fn report(
    run: &Path,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    report::write(run, out, &mut |done, total, case| {
        step(done, total, case);
        !tools.interrupt.load(Ordering::Relaxed)
    })?;
    Ok(())
}

struct Stages<'a> {
    suite: &'a Suite,
    out: &'a Path,
    options: &'a RunOptions,
    tools: &'a Tools,
    observer: &'a mut dyn Observer,
    records: Records,
    failed: BTreeMap<String, String>,
    ran: usize,
    skipped: usize,
    total: usize,
}

/// A finished output: where it is and what is in it.
struct Output {
    path: PathBuf,
    content: String,
}

/// What the methods of a case start from.
#[derive(Clone, Copy)]
struct Given<'g> {
    capture: &'g Output,
    lights: Option<&'g Output>,
}

/// What decides whether a stage's earlier output is still valid.
struct Key<'k> {
    inputs: &'k [&'k str],
    /// Valid or not, it is made anew.
    redo: bool,
    /// What made it, in words.
    made_from: String,
}

impl<'k> From<&'k [&'k str]> for Key<'k> {
    fn from(inputs: &'k [&'k str]) -> Self {
        Self { inputs, redo: false, made_from: String::new() }
    }
}

impl Stages<'_> {
    fn write_manifest(&self, renderer: &str) -> Result<(), RunError> {
        let manifest = manifest(self.suite, renderer, &self.failed);
        let text = serde_json::to_vec_pretty(&manifest).map_err(io::Error::from)?;
        Ok(atomic::write_file(&self.out.join("run.json"), &text)?)
    }

    /// Writes the scenes of all cases, and checks those that are still to be rendered.
    fn prepare(&mut self, renderer: &str) -> Result<(), RunError> {
        let captures = self.out.join("captures");
        fs::create_dir_all(&captures)?;
        let mut pending = Vec::new();
        let rendered = self.suite.cases.iter().filter(|case| case.photographed.is_none());
        for case in rendered {
            let scene = case.scene.to_toml().map_err(io::Error::other)?;
            atomic::write_file(&captures.join(format!("{}.toml", case.id)), scene.as_bytes())?;
            let (id, path) = (format!("capture/{}", case.id), captures.join(&case.id));
            let key = hash_parts(&["capture", renderer, &scene, &case.scene.content()?]);
            if self.records.finished(&id, &key, &path).is_none() {
                pending.push(case);
            }
        }
        preflight::space(self.suite, &pending, self.out)?;
        preflight::scenes(self.suite, &pending, &captures, self.tools)
    }

    /// Does `work` unless its output is there, intact, and made from the same inputs.
    fn stage<'k>(
        &mut self,
        id: &str,
        key: impl Into<Key<'k>>,
        path: PathBuf,
        work: impl FnOnce(&Path, &Tools, &mut dyn FnMut(u64, u64, &str)) -> Result<Made, RunError>,
    ) -> Result<Output, RunError> {
        let key = key.into();
        let hash = hash_parts(key.inputs);
        self.observer.stage_begins(id, self.ran + self.skipped, self.total);
        let kept = self.records.finished(id, &hash, &path).filter(|_| !key.redo);
        if let Some(content) = kept {
            self.skipped += 1;
            self.records.keep_time(id)?;
            self.observer.stage_ends(id, None);
            return Ok(Output { path, content });
        }
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let start = Instant::now();
        let observer = &mut *self.observer;
        let made =
            work(&path, self.tools, &mut |done, total, what| observer.step(done, total, what))?;
        let content = self.records.note(id, &hash, &path)?;
        let seconds = start.elapsed().as_secs_f64();
        self.ran += 1;
        self.records.note_time(id, seconds, Made { from: key.made_from, ..made })?;
        self.observer.stage_ends(id, Some(seconds));
        Ok(Output { path, content })
    }

    fn capture(&mut self, case: &Case, renderer: &str) -> Result<Output, RunError> {
        if let Some(path) = case.photographed.clone() {
            let content = hash_path(&path)?;
            return Ok(Output { path, content });
        }
        let scene = case.scene.to_toml().map_err(io::Error::other)?;
        let files = case.scene.content()?;
        let scene_file = self.out.join("captures").join(format!("{}.toml", case.id));
        let path = self.out.join("captures").join(&case.id);
        let id = format!("capture/{}", case.id);
        let inputs: &[&str] = &["capture", renderer, &scene, &files];
        self.stage(&id, inputs, path, |path, tools, step| {
            let arguments =
                words(&[("--scene", scene_file.as_os_str()), ("--out", path.as_os_str())]);
            run_stage(&tools.interpreter, "synth", &arguments, &tools.interrupt, step)?;
            Ok(Made::default())
        })
    }

    /// The lights that methods of pictures relight in, if there are such.
    fn lights(
        &mut self,
        case: &Case,
        capture: &Output,
        renderer: &str,
    ) -> Result<Option<Output>, RunError> {
        let wanted = self.suite.methods.iter().any(Method::gives_pictures);
        if !wanted || case.photographed.is_some() {
            return Ok(None);
        }
        let path = self.out.join("lights").join(&case.id);
        let inputs: &[&str] = &["lights", &capture.content, renderer];
        let made = self.stage(&format!("lights/{}", case.id), inputs, path, |path, tools, step| {
            lights(&capture.path, path, tools, step)?;
            Ok(Made::default())
        });
        made.map(Some)
    }

    /// One method on one case; what it does wrong is kept as its failure.
    fn run_method(
        &mut self,
        case: &Case,
        ready: &Ready,
        given: Given,
        renderer: &str,
    ) -> Result<(), RunError> {
        let name = format!("{}/{}", case.id, ready.method.id);
        match self.make_and_score(case, ready, given, renderer, &name) {
            Err(error) if error.is_of_method() => {
                tracing::warn!("{name}: failed: {error}");
                // Scores of an earlier state of the method must not pass for this one's.
                match fs::remove_file(self.out.join("scores").join(format!("{name}.json"))) {
                    Err(error) if error.kind() != io::ErrorKind::NotFound => {
                        return Err(error.into());
                    }
                    _ => {}
                }
                self.failed.insert(name, error.to_string());
                Ok(())
            }
            result => result,
        }
    }

    fn make_and_score(
        &mut self,
        case: &Case,
        ready: &Ready,
        Given { capture, lights }: Given,
        renderer: &str,
        name: &str,
    ) -> Result<(), RunError> {
        let method = ready.method;
        let (key, made_from) = self.method_key(ready, renderer)?;
        let files = case.scene.files().into_iter().chain(case.photographed.clone());
        let secret = files.chain([self.out.to_path_buf()]).collect();
        let log = self.out.join("logs").join(format!("{name}.txt"));
        let scratch = program::scratch_prefix(self.out);
        let scales = &self.suite.scales;
        let redo = self.options.redo.contains(&method.id);
        let mut inputs = vec!["maps", &capture.content, &key];
        let lights = lights.filter(|_| method.gives_pictures());
        inputs.extend(lights.map(|lights| lights.content.as_str()));
        let maps = self.stage(
            &format!("maps/{name}"),
            Key { inputs: &inputs, redo, made_from },
            self.out.join("maps").join(name),
            |path, tools, step| {
                let place = Place {
                    capture: &capture.path,
                    maps: path,
                    lights: lights.map(|lights| lights.path.as_path()),
                    log: &log,
                    secret,
                    scratch: &scratch,
                };
                let usage = make_maps::make_maps(ready, place, tools, step)?;
                Ok(Made { usage, ..Made::default() })
            },
        )?;
        let by = self.suite.relight;
        let mut how = scales.join(" ");
        if by != RENDERERS[0] {
            how = format!("{how} {by}");
        }
        let inputs: &[&str] =
            &["relit", &capture.content, &maps.content, renderer, SCORE_SOURCES, &how];
        let relit = self.stage(
            &format!("relit/{name}"),
            inputs,
            self.out.join("relit").join(name),
            |path, tools, step| {
                relit(by, method, [&capture.path, &maps.path, path], scales, tools, step)?;
                Ok(Made::default())
            },
        )?;
        let inputs: &[&str] =
            &["scores", &capture.content, &maps.content, &relit.content, SCORE_SOURCES];
        self.stage(
            &format!("scores/{name}"),
            inputs,
            self.out.join("scores").join(format!("{name}.json")),
            |path, _, _| {
                let mut scores = score::score(&capture.path, &maps.path, Some(&relit.path))?;
                scores.solver.clone_from(&method.id);
                scores.write(path)?;
                Ok(Made::default())
            },
        )?;
        Ok(())
    }

    /// What decides a method's maps beside the capture, as a key and in words.
    fn method_key(&self, ready: &Ready, renderer: &str) -> Result<(String, String), RunError> {
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
}
