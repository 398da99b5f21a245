//! Turns a capture into maps, whichever way an entrant of the suite does it.

use std::fs;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use indicatif::HumanDuration;
use solver::atomic::Folder;

use super::method::{Entrant, Method};
use super::run::{RunError, SOLVER_SOURCES, Tools};
use crate::score;

/// Ends what is said of a step that knows better than its share how long the rest takes.
pub const TIME_LEFT: &str = " left";

/// Writes `maps` from `capture`.
pub(super) fn make_maps(
    entrant: &Entrant,
    capture: &Path,
    maps: &Path,
    tools: &Tools,
    progress: &mut dyn FnMut(u64, u64, &str),
) -> Result<(), RunError> {
    match &entrant.method {
        Method::Oracle => Ok(score::oracle_maps(capture, maps)?),
        Method::Baseline { method, texture_size } => method.make(capture, maps, *texture_size),
        Method::Fields { config, backend } => {
            let config = solver::Config::from_toml(config)?;
            let backend = backend.open()?;
            let capture = solver::Capture::open(capture)?;
            solve(&*backend, &capture, &config, maps, tools, &mut |step| {
                progress(step.iteration as u64, step.total as u64, &in_words(step));
            })?;
            Ok(())
        }
        Method::Command(words) => {
            let (program, arguments) = words.split_first().ok_or_else(|| RunError::Program {
                name: entrant.id.clone(),
                reason: "its command is empty".to_owned(),
            })?;
            let mut command = Command::new(program);
            command.args(arguments);
            run_program(&entrant.id, command, arguments, capture, maps, tools)
        }
        Method::Python(function) => {
            let mut command = tools.interpreter.command();
            let arguments =
                ["-m", "unshade.plugin", function, "{capture}", "{maps}"].map(str::to_owned);
            command.args(&arguments);
            run_program(&entrant.id, command, &arguments, capture, maps, tools)
        }
    }
}

/// Our own solver. An interrupt leaves maps of what there is, and a checkpoint beside them; it is an
/// error nevertheless, so that nobody takes them for finished.
pub fn solve(
    backend: &dyn solver::Backend,
    capture: &solver::Capture,
    config: &solver::Config,
    maps: &Path,
    tools: &Tools,
    hear: &mut dyn FnMut(&solver::Progress),
) -> Result<solver::Solution, RunError> {
    let solution =
        solver::solve_into(backend, maps, SOLVER_SOURCES, capture, config, &mut |step| {
            if tools.interrupt.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            hear(step);
            ControlFlow::Continue(())
        })?;
    match solution.record.interrupted {
        Some(place) => Err(RunError::Stopped { place, maps: maps.to_path_buf() }),
        None => Ok(solution),
    }
}

/// What a bar says beside it.
pub fn in_words(step: &solver::Progress) -> String {
    format!(
        "{} {}/{}, loss {:.5}, {}{TIME_LEFT}",
        step.stage,
        step.step,
        step.steps,
        step.loss,
        HumanDuration(Duration::from_secs_f64(step.seconds_left.max(0.0)))
    )
}

/// A program that is not ours: it sees the capture without its truth, and leaves a maps folder.
fn run_program(
    name: &str,
    template: Command,
    arguments: &[String],
    capture: &Path,
    maps: &Path,
    tools: &Tools,
) -> Result<(), RunError> {
    let failed = |reason: String| RunError::Program { name: name.to_owned(), reason };
    let blind = BlindCapture::of(capture)?;
    let output = Folder::begin(maps)?;
    let fill = |word: &String| {
        word.replace("{capture}", &blind.0.to_string_lossy())
            .replace("{maps}", &output.path().to_string_lossy())
    };
    let mut command = Command::new(template.get_program());
    command.args(arguments.iter().map(fill)).stdin(Stdio::null());
    for (key, value) in template.get_envs() {
        value.map(|value| command.env(key, value));
    }
    let mut child = command.spawn().map_err(|error| failed(format!("cannot start: {error}")))?;
    let status = loop {
        if tools.interrupt.load(Ordering::Relaxed) {
            let _ = child.kill();
            let _ = child.wait();
            return Err(RunError::Interrupted);
        }
        match child.try_wait()? {
            Some(status) => break status,
            None => thread::sleep(Duration::from_millis(50)),
        }
    };
    if !status.success() {
        return Err(failed(format!("ended with {status}")));
    }
    if !output.path().join("diffuse_albedo.exr").is_file() {
        return Err(failed("left no diffuse_albedo.exr in its maps folder".to_owned()));
    }
    Ok(output.commit()?)
}

/// A copy of a capture without `truth/` and the withheld pictures; removed when dropped.
struct BlindCapture(PathBuf);

impl BlindCapture {
    fn of(capture: &Path) -> io::Result<Self> {
        let name = capture.file_name().unwrap_or_default().to_string_lossy();
        let blind = Self(capture.with_file_name(format!("{name}.blind.partial")));
        if blind.0.exists() {
            fs::remove_dir_all(&blind.0)?;
        }
        copy_without_truth(capture, &blind.0)?;
        Ok(blind)
    }
}

impl Drop for BlindCapture {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn copy_without_truth(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            if entry.file_name() != "truth" {
                copy_without_truth(&entry.path(), &target)?;
            }
        } else {
            fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}
