//! Runs a suite: capture, solve, relight, score for every case, then the report.
//!
//! A stage whose inputs have not changed is skipped; every output appears complete or not at
//! all, so a run that was killed goes on where it stopped and ends with the same bytes.

use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use serde_json::{Value, json};
use solver::atomic;

use super::cases::Case;
use super::content::{hash_parts, hash_path};
use super::entrant;
use super::file::Suite;
use super::method::{Entrant, Method};
use super::record::Records;
use super::scene::{Scene, SceneError};
use crate::compare::CompareError;
use crate::report::{self, ReportError};
use crate::score::{self, ScoreError};
use crate::synth::{Interpreter, InterpreterError, Interrupt, StageError, run_stage};

/// What the solver's and the scoring's code was when this program was built.
pub(crate) const SOLVER_SOURCES: &str = env!("UNSHADE_SOLVER_SOURCES");
const SCORE_SOURCES: &str = env!("UNSHADE_SCORE_SOURCES");
/// The stage that comes last.
const REPORT: &str = "report";

/// How a run can end badly; each message is one line.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum RunError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Interpreter(#[from] InterpreterError),
    #[error(transparent)]
    Stage(StageError),
    #[error(transparent)]
    Capture(#[from] solver::CaptureError),
    #[error(transparent)]
    Config(#[from] solver::ConfigError),
    #[error(transparent)]
    Backend(#[from] solver::BackendError),
    #[error(transparent)]
    Solve(#[from] solver::SolveError),
    #[error(transparent)]
    Maps(#[from] solver::MapsError),
    #[error(transparent)]
    Score(#[from] ScoreError),
    #[error(transparent)]
    Check(#[from] crate::check::CheckError),
    #[error(transparent)]
    Report(ReportError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error(transparent)]
    Torch(#[from] crate::bench::TorchError),
    #[error("solver {name}: {reason}")]
    Program { name: String, reason: String },
    #[error("{0}: another run is using this folder; wait for it or choose another")]
    Busy(PathBuf),
    #[error("the run folder cannot be used: {0}")]
    Folder(#[from] io::Error),
    #[error("interrupted; the same command goes on from here")]
    Interrupted,
    #[error(
        "interrupted in {place}; {} holds what there was, the same command goes on from here",
        maps.display()
    )]
    Stopped { place: String, maps: PathBuf },
}

impl RunError {
    /// Whether the user wanted it.
    pub fn is_interrupt(&self) -> bool {
        matches!(self, Self::Interrupted | Self::Stopped { .. })
    }
}

impl From<StageError> for RunError {
    fn from(error: StageError) -> Self {
        match error {
            StageError::Interrupted => Self::Interrupted,
            error => Self::Stage(error),
        }
    }
}

impl From<ReportError> for RunError {
    fn from(error: ReportError) -> Self {
        match error {
            ReportError::Interrupted => Self::Interrupted,
            error => Self::Report(error),
        }
    }
}

/// What every stage needs at hand.
pub struct Tools {
    /// Runs the path tracer.
    pub interpreter: Interpreter,
    /// Raised by Ctrl-C.
    pub interrupt: Interrupt,
}

/// Hears how a run gets on.
pub trait Observer {
    /// `done` of `total` stages are finished and `id` begins.
    fn stage_begins(&mut self, id: &str, done: usize, total: usize);
    /// The stage has done `done` of `total` steps.
    fn step(&mut self, done: u64, total: u64, what: &str);
    /// The stage is finished; `seconds` is absent if its earlier result was still valid.
    fn stage_ends(&mut self, id: &str, seconds: Option<f64>);
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
}

/// Runs `suite` in the folder `out`.
pub fn run(
    suite: &Suite,
    out: &Path,
    tools: &Tools,
    observer: &mut dyn Observer,
) -> Result<RunSummary, RunError> {
    fs::create_dir_all(out)?;
    let lock = File::create(out.join(".lock"))?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => return Err(RunError::Busy(out.to_path_buf())),
        Err(TryLockError::Error(error)) => return Err(error.into()),
    }
    let renderer = tools.interpreter.fingerprint()?;
    let total = suite.cases.len() * (1 + 3 * suite.entrants.len()) + 1;
    let records = Records::open(out)?;
    let mut stages = Stages { out, tools, observer, records, ran: 0, skipped: 0, total };
    let manifest = manifest(suite, &renderer);
    atomic::write_file(
        &out.join("run.json"),
        &serde_json::to_vec_pretty(&manifest).map_err(io::Error::from)?,
    )?;
    for case in &suite.cases {
        let capture = stages.capture(case, &renderer)?;
        for entrant in &suite.entrants {
            stages.entrant(case, entrant, &capture, &suite.scales, &renderer)?;
        }
    }
    let (ran, skipped) = (stages.ran, stages.skipped);
    let folder = out.join("report");
    let start = Instant::now();
    observer.stage_begins(REPORT, ran + skipped, total);
    report(out, &folder, tools, &mut |done, total, what| observer.step(done, total, what))?;
    observer.stage_ends(REPORT, Some(start.elapsed().as_secs_f64()));
    Ok(RunSummary { report: folder.join("index.html"), ran, skipped })
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

fn manifest(suite: &Suite, renderer: &str) -> Value {
    let cases: Vec<Value> = suite
        .cases
        .iter()
        .map(|case| {
            let solvers: Vec<Value> = suite
                .entrants
                .iter()
                .map(|entrant| {
                    let below = |folder| format!("{folder}/{}/{}", case.id, entrant.id);
                    json!({
                        "id": entrant.id, "kind": entrant.kind(), "title": entrant.title,
                        "maps": below("maps"), "relit": below("relit"),
                        "scores": format!("{}.json", below("scores")),
                    })
                })
                .collect();
            json!({
                "id": case.id, "face": case.scene.name_of("face"),
                "light": case.scene.name_of("light"), "variant": case.variant,
                "capture": format!("captures/{}", case.id), "solvers": solvers,
            })
        })
        .collect();
    json!({
        "format": 1, "suite": suite.name, "title": suite.title, "cases": cases,
        "versions": {
            "unshade": env!("CARGO_PKG_VERSION"), "renderer": renderer,
            "solver sources": SOLVER_SOURCES, "scoring sources": SCORE_SOURCES,
        },
        "suite_toml": suite.text,
    })
}

struct Stages<'a> {
    out: &'a Path,
    tools: &'a Tools,
    observer: &'a mut dyn Observer,
    records: Records,
    ran: usize,
    skipped: usize,
    total: usize,
}

/// A finished output: where it is and what is in it.
struct Output {
    path: PathBuf,
    content: String,
}

impl Stages<'_> {
    /// Does `work` unless its output is there, intact, and made from the same inputs.
    fn stage(
        &mut self,
        id: &str,
        inputs: &[&str],
        path: PathBuf,
        work: impl FnOnce(&Path, &Tools, &mut dyn FnMut(u64, u64, &str)) -> Result<(), RunError>,
    ) -> Result<Output, RunError> {
        let key = hash_parts(inputs);
        self.observer.stage_begins(id, self.ran + self.skipped, self.total);
        if let Some(content) = self.records.finished(id, &key, &path) {
            self.skipped += 1;
            self.records.note_time(id, None)?;
            self.observer.stage_ends(id, None);
            return Ok(Output { path, content });
        }
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let start = Instant::now();
        let observer = &mut *self.observer;
        work(&path, self.tools, &mut |done, total, what| observer.step(done, total, what))?;
        let content = self.records.note(id, &key, &path)?;
        let seconds = start.elapsed().as_secs_f64();
        self.ran += 1;
        self.records.note_time(id, Some(seconds))?;
        self.observer.stage_ends(id, Some(seconds));
        Ok(Output { path, content })
    }

    fn capture(&mut self, case: &Case, renderer: &str) -> Result<Output, RunError> {
        let scene = case.scene.to_toml().map_err(io::Error::other)?;
        let files = file_contents(&case.scene)?;
        let scene_file = self.out.join("captures").join(format!("{}.toml", case.id));
        fs::create_dir_all(self.out.join("captures"))?;
        atomic::write_file(&scene_file, scene.as_bytes())?;
        let path = self.out.join("captures").join(&case.id);
        let id = format!("capture/{}", case.id);
        self.stage(&id, &["capture", renderer, &scene, &files], path, |path, tools, step| {
            let arguments =
                words(&[("--scene", scene_file.as_os_str()), ("--out", path.as_os_str())]);
            run_stage(&tools.interpreter, "synth", &arguments, &tools.interrupt, step)?;
            Ok(())
        })
    }

    fn entrant(
        &mut self,
        case: &Case,
        entrant: &Entrant,
        capture: &Output,
        scales: &[&str],
        renderer: &str,
    ) -> Result<(), RunError> {
        let name = format!("{}/{}", case.id, entrant.id);
        let method = match &entrant.method {
            Method::Fields { config, backend } => {
                // The resolved values, so that a preset that changed is solved again; and what
                // computes here, since no two devices give the same bytes.
                let config = solver::Config::from_toml(config)?.to_toml();
                hash_parts(&["fields", &config, &backend.open()?.name(), SOLVER_SOURCES])
            }
            Method::Oracle => hash_parts(&["oracle", SCORE_SOURCES]),
            Method::Baseline { method, texture_size } => {
                let size = texture_size.to_string();
                hash_parts(&["baseline", method.name(), &size, SOLVER_SOURCES])
            }
            Method::Command(words) => hash_parts(&["command", &words.join("\0")]),
            Method::Python(function) => hash_parts(&["python", function]),
        };
        let maps = self.stage(
            &format!("maps/{name}"),
            &["maps", &capture.content, &method],
            self.out.join("maps").join(&name),
            |path, tools, step| entrant::make_maps(entrant, &capture.path, path, tools, step),
        )?;
        let relit = self.stage(
            &format!("relit/{name}"),
            &["relit", &capture.content, &maps.content, renderer, SCORE_SOURCES, &scales.join(" ")],
            self.out.join("relit").join(&name),
            |path, tools, step| relight(&capture.path, &maps.path, path, scales, tools, step),
        )?;
        self.stage(
            &format!("scores/{name}"),
            &["scores", &capture.content, &maps.content, &relit.content, SCORE_SOURCES],
            self.out.join("scores").join(format!("{name}.json")),
            |path, _, _| {
                let mut scores = score::score(&capture.path, &maps.path, Some(&relit.path))?;
                scores.solver.clone_from(&entrant.id);
                Ok(scores.write(path)?)
            },
        )?;
        Ok(())
    }
}

/// Renders the scene file `scene` into the capture folder `out`.
pub fn synth(
    scene: &Path,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let scene = resolved(scene)?;
    let arguments = words(&[("--scene", scene.path().as_os_str()), ("--out", out.as_os_str())]);
    run_stage(&tools.interpreter, "synth", &arguments, &tools.interrupt, step)?;
    Ok(())
}

/// What the scene file `scene` stands for, in words: face, cameras, and each light in numbers.
pub fn describe(scene: &Path, tools: &Tools) -> Result<String, RunError> {
    let scene = resolved(scene)?;
    let arguments = words(&[("--scene", scene.path().as_os_str())]);
    let silent = &mut |_, _, _: &str| {};
    let said = run_stage(&tools.interpreter, "describe", &arguments, &tools.interrupt, silent)?;
    Ok(said["text"].as_str().unwrap_or_default().to_owned())
}

/// Renders `count` sampled identities into one PNG.
pub fn contact_sheet(
    count: u32,
    seed: u64,
    out: &Path,
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let (count, seed) = (OsString::from(count.to_string()), OsString::from(seed.to_string()));
    let arguments = words(&[("--count", &count), ("--seed", &seed), ("--out", out.as_os_str())]);
    run_stage(&tools.interpreter, "contact-sheet", &arguments, &tools.interrupt, step)?;
    Ok(())
}

/// The scene file with all that it refers to, in a file that lives as long as the result.
fn resolved(scene: &Path) -> Result<tempfile::NamedTempFile, RunError> {
    let text = Scene::open(scene)?.to_toml().map_err(io::Error::other)?;
    let mut file = tempfile::Builder::new().prefix("unshade-").suffix(".toml").tempfile()?;
    file.write_all(text.as_bytes())?;
    Ok(file)
}

/// Renders `maps` in the capture's lights, under each of `scales` (of [`super::SCALES`]).
pub fn relight(
    capture: &Path,
    maps: &Path,
    out: &Path,
    scales: &[&str],
    tools: &Tools,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    let scale = score::fit_scale(capture, maps)?;
    let mut arguments = words(&[
        ("--capture", capture.as_os_str()),
        ("--maps", maps.as_os_str()),
        ("--out", out.as_os_str()),
    ]);
    for name in scales {
        let factor = if *name == "global" { scale.global } else { 1.0 };
        arguments.extend([OsString::from("--scale"), OsString::from(format!("{name}={factor}"))]);
    }
    run_stage(&tools.interpreter, "relight", &arguments, &tools.interrupt, step)?;
    Ok(())
}

/// The content of every file that the scene names.
fn file_contents(scene: &Scene) -> Result<String, SceneError> {
    let hashes: Result<Vec<_>, _> = scene
        .files()
        .into_iter()
        .map(|path| {
            hash_path(&path).map_err(|error| SceneError::Read { path, reason: error.to_string() })
        })
        .collect();
    Ok(hashes?.join(" "))
}

fn words(pairs: &[(&str, &std::ffi::OsStr)]) -> Vec<OsString> {
    pairs.iter().flat_map(|(flag, value)| [OsString::from(flag), value.to_os_string()]).collect()
}
