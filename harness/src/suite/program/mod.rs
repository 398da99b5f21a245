//! Third-party programs as methods of a suite.
//!
//! A program gets a copy of the capture without the pictures of withheld views, and writes a maps
//! folder. Of the user's files it may read only its own files and `inputs`; a change of these runs
//! it again.

mod blind;
mod confine;
mod environment;
mod files;
mod pictures;
mod spawn;
mod start;
mod watch;

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;

use formats::atomic::Folder;
use formats::content_hash::hash_parts;

use super::error::RunError;
use crate::synth::Interrupt;
pub(in crate::suite) use blind::{copy_blind, given_files};
use confine::Permissions;
pub use files::ProgramFiles;
pub use pictures::Gives;
use spawn::Network;
pub use start::{PLACEHOLDERS, Program, Start};
use watch::{End, Watched, last_line, watch};
pub use watch::{Limits, Usage};

/// Messages of a program that misses a variable, such as `PATH` or `LD_LIBRARY_PATH`.
const MISSING: [&str; 3] = ["cannot open shared object file", "not found", "KeyError"];

/// Folder below the debug folder that is the program's home.
const HOME: &str = "home";

/// Messages of a program that finds no network.
const UNREACHABLE: [&str; 4] = [
    "Network is unreachable",
    "Temporary failure in name resolution",
    "Name or service not known",
    "Could not resolve host",
];

/// Environment variable that hands a program the seed.
pub(super) const SEED: &str = "UNSHADE_SEED";

/// Where a program works.
pub(super) struct Place<'a> {
    pub capture: &'a Path,
    pub maps: &'a Path,
    pub log: &'a Path,
    /// Folder for its own output, which stays until the next time that it runs.
    pub debug: &'a Path,
    /// Lat-long pictures of the lights to relight in, for methods of pictures.
    pub lights: Option<&'a Path>,
    /// Paths that it must not see: the run, and the files of the truth.
    pub secret: Vec<PathBuf>,
    /// The run's [`scratch_prefix`].
    pub scratch: &'a str,
}

/// How the temporary folders of a run's programs begin, so that the next run of the same folder can
/// clear what a killed one left.
pub(super) fn scratch_prefix(run: &Path) -> String {
    let place = run.canonicalize().unwrap_or_else(|_| run.to_path_buf());
    let key = hash_parts(&[&place.to_string_lossy()]);
    format!("unshade-{}-", &key[..12])
}

/// Removes the temporary folders that an earlier run of this folder left.
pub(super) fn clear_scratch(prefix: &str) {
    for entry in fs::read_dir(std::env::temp_dir()).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(prefix) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

impl Program {
    /// The key of its table that names it.
    pub fn toml_key(&self) -> &'static str {
        match self.start {
            Start::Command(_) => "command",
            Start::Python(_) => "python",
        }
    }

    /// Runs it, checks what it left, and keeps that as the maps folder.
    pub(super) fn run(
        &self,
        name: &str,
        files: &ProgramFiles,
        place: &Place,
        interrupt: &Interrupt,
        progress: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<Usage, RunError> {
        let failed = |reason: String| RunError::Program { name: name.to_owned(), reason };
        let output = Folder::begin(place.maps)?;
        // Outside the run's folder, because that holds the truth.
        let scratch = tempfile::Builder::new().prefix(place.scratch).tempdir()?;
        let [capture, results, own, lights] =
            ["capture", "results", "tmp", "lights"].map(|name| scratch.path().join(name));
        // Beside the maps there is room for what is renamed into their place.
        let maps = results.join("maps");
        copy_blind(place.capture, &capture)?;
        fs::create_dir_all(&maps)?;
        fs::create_dir(&own)?;
        fs::create_dir(&lights)?;
        for entry in place.lights.map(fs::read_dir).transpose()?.into_iter().flatten() {
            let file = entry?.path();
            if let Some(name) =
                file.file_name().filter(|_| file.extension() == Some("exr".as_ref()))
            {
                fs::copy(&file, lights.join(name))?;
            }
        }
        if let Some(folder) = place.log.parent() {
            fs::create_dir_all(folder)?;
        }
        let log = File::create(place.log)?;
        let debug = Debug::begin(place.debug)?;
        let command = self.command(files, [&capture, &maps, &own, &lights, &debug.path], &log)?;
        let mut permissions = Permissions {
            read: files.readable().chain(&self.inputs).cloned().collect(),
            list: files.listed().iter().chain([&self.folder]).cloned().collect(),
            write: vec![results, own, debug.path.clone()],
            secret: place.secret.clone(),
        };
        permissions.read.extend([capture, lights]);
        let mut usage = Usage::default();
        let (ticks, heard) = mpsc::channel();
        let (limits, network, log) = (&self.limits, self.network, place.log);
        let watched = Watched { limits, network, log, interrupt };
        // A thread of its own: the kernel restricts threads, for good, and what they start.
        let end = thread::scope(|scope| {
            let usage = &mut usage;
            let running = scope.spawn(move || -> Result<End, String> {
                usage.confined = confine::restrict(&permissions)?;
                watch(command, &watched, &ticks, usage)
                    .map_err(|error| format!("cannot start: {error}"))
            });
            heard.iter().for_each(|()| progress(0, 0, &last_line(log)));
            progress(0, 0, &last_line(log));
            running.join().unwrap_or_else(|_| Err("its watch ended".to_owned()))
        });
        debug.end();
        let what = match end.map_err(&failed)? {
            End::Interrupted => {
                output.abandon();
                return Err(RunError::Interrupted);
            }
            End::Limit(reason) => Some(reason),
            End::Exited(status) if status.success() => None,
            End::Exited(status) => Some(format!("ended with {status}")),
        };
        let left = match what {
            Some(what) => Err(failed(format!("{what}{}", self.last_words(place.log, &usage)))),
            None if self.gives == Gives::Maps => check(&maps).map_err(failed),
            None => Ok(()),
        };
        // Pictures come from the copy, in which no link leads to files that the program could not read.
        let kept = left.and_then(|()| Ok(copy_folder(&maps, output.path())?)).and_then(|()| {
            let (size, scratch) = (self.texture_size, scratch.path());
            match self.gives {
                Gives::Maps => Ok(()),
                Gives::Pictures => {
                    pictures::into_maps(place.capture, output.path(), scratch, size).map_err(failed)
                }
            }
        });
        if let Err(error) = kept {
            output.abandon();
            return Err(error);
        }
        output.commit()?;
        Ok(usage)
    }

    fn command(
        &self,
        files: &ProgramFiles,
        [capture, maps, own, lights, debug]: [&Path; 5],
        log: &File,
    ) -> io::Result<Command> {
        let fill = |word: &String| {
            self.with_settings(word)
                .replace("{capture}", &capture.to_string_lossy())
                .replace("{maps}", &maps.to_string_lossy())
                .replace("{lights}", &lights.to_string_lossy())
                .replace("{debug}", &debug.to_string_lossy())
        };
        let mut command = Command::new(&files.executable);
        command
            .args(files.arguments.iter().map(fill))
            .current_dir(&self.folder)
            .env_clear()
            .env("TMPDIR", own)
            .env("XDG_CACHE_HOME", own)
            .env("HOME", debug.join(HOME))
            .env("UNSHADE_DEBUG", debug)
            .env("UNSHADE_SET", self.settings_json())
            .envs(self.all_variables(files.executable.parent().unwrap_or(Path::new("/"))))
            .stdin(Stdio::null())
            .stdout(log.try_clone()?)
            .stderr(log.try_clone()?);
        Ok(command)
    }

    /// The last words of a failed program, and the place of the rest.
    fn last_words(&self, log: &Path, usage: &Usage) -> String {
        let text = fs::read(log).unwrap_or_default();
        let text = String::from_utf8_lossy(&text[text.len().saturating_sub(4096)..]).into_owned();
        let last = last_line(log);
        let mut said = if last.is_empty() { last } else { format!(": {last}") };
        let unreachable = UNREACHABLE.iter().any(|words| text.contains(words));
        if usage.network != Network::Open && unreachable {
            said.push_str("; its network is closed, write network = true to open it");
        }
        if usage.confined && text.contains("Permission denied") {
            said.push_str(
                "; it may read its own files and inputs = [...], and write {maps}, {debug}, HOME and TMPDIR",
            );
        }
        if MISSING.iter().any(|words| text.contains(words)) {
            said.push_str(
                "; its environment is what environment = { ... } states, without the shell's variables",
            );
        }
        format!("{said} (log: {})", log.display())
    }
}

/// The debug folder of a program, with its home folder in it.
struct Debug {
    path: PathBuf,
}

impl Debug {
    /// Empties the folder: what it holds is of this run of the program alone.
    fn begin(path: &Path) -> io::Result<Self> {
        match fs::remove_dir_all(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => fs::create_dir_all(path.join(HOME))?,
        }
        Ok(Self { path: std::path::absolute(path)? })
    }

    /// Removes what the program left empty: its home, the folder, and those of the case and of the run.
    fn end(self) {
        let _ = fs::remove_dir(self.path.join(HOME));
        for folder in self.path.ancestors().take(3) {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Refuses a maps folder that nothing could be done with, before it takes an earlier one's place.
fn check(maps: &Path) -> Result<(), String> {
    if !maps.join("diffuse_albedo.exr").is_file() {
        return Err("left no diffuse_albedo.exr in its maps folder".to_owned());
    }
    formats::Maps::read(maps)
        .map(drop)
        .map_err(|error| error.to_string().replace(&*maps.to_string_lossy(), "its maps folder"))
}

/// Copies what is in one folder into another, perhaps on another disk. Links are not followed.
pub(super) fn copy_folder(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        let kind = entry.file_type()?;
        if kind.is_dir() {
            copy_folder(&entry.path(), &target)?;
        } else if kind.is_file() {
            fs::copy(entry.path(), &target)?;
        }
    }
    Ok(())
}
