//! Files of a program: found before anything is rendered, and part of its result's key.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;

use formats::content_hash::{hash_parts, hash_path};
use serde::Deserialize;

use super::confine::is_system;
use super::pictures::Gives;
use super::start::{Program, Start};
use crate::suite::near;
use crate::synth::Interpreter;

/// Says what a Python program is made of; for any Python from 3.8 on.
const DEPENDENCIES: &str = include_str!("dependencies.py");

/// A program that was found, and its files.
#[derive(Clone, Debug, Default)]
pub struct ProgramFiles {
    pub(super) executable: PathBuf,
    /// With `{capture}` and `{maps}` still in them.
    pub(super) arguments: Vec<String>,
    /// Its own files: their content decides whether an earlier result is still valid.
    own: Vec<PathBuf>,
    /// Folders of its interpreter.
    interpreter: Vec<PathBuf>,
}

/// The answer of `dependencies.py`.
#[derive(Deserialize)]
struct Answer {
    executable: PathBuf,
    system: Vec<PathBuf>,
    files: Vec<PathBuf>,
    #[serde(default)]
    arguments: Option<Vec<String>>,
    error: Option<String>,
}

impl Program {
    /// Finds the program and its files; the error is the reason alone.
    pub fn find(&self, ours: &Interpreter) -> Result<ProgramFiles, String> {
        match &self.start {
            Start::Python(function) => {
                if !function.contains(':') {
                    return Err(format!(
                        "python = {function:?} names no function; write \"module:function\""
                    ));
                }
                let answer = self.ask(ours.path(), "module", function)?;
                if let Some(known) = &answer.arguments
                    && let Some(key) = self.settings.keys().find(|key| !known.contains(key))
                {
                    return Err(near::unknown(&format!("{function} has no argument"), key, known));
                }
                let arguments = ["-m", "unshade.plugin", function, "{capture}", "{maps}"];
                Ok(ProgramFiles {
                    executable: answer.executable,
                    arguments: arguments.map(str::to_owned).to_vec(),
                    own: answer.files,
                    interpreter: answer.system,
                })
            }
            Start::Command(words) => self.find_command(words),
        }
    }

    fn find_command(&self, words: &[String]) -> Result<ProgramFiles, String> {
        let (program, arguments) =
            words.split_first().ok_or("command is empty; name a program".to_owned())?;
        for place in ["{capture}", "{maps}"] {
            if !arguments.iter().any(|word| word.contains(place)) {
                return Err(format!("command never says {place}, so the program cannot know it"));
            }
        }
        if self.gives == Gives::Maps && arguments.iter().any(|word| word.contains("{lights}")) {
            return Err(
                "command says {lights}, which maps are made without; state gives = \"pictures\" \
                        if it relights"
                    .to_owned(),
            );
        }
        let executable = self.executable(program)?;
        let mut files = ProgramFiles { arguments: arguments.to_vec(), ..ProgramFiles::default() };
        // Scripts, weights and settings that the command names.
        let named = arguments.iter().map(|word| self.folder.join(word));
        files.own.extend(named.filter(|path| path.is_file()));
        let name = executable.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !name.starts_with("python") {
            files.own.push(executable.clone());
            if let Some(python) = self.python_of(&executable) {
                let answer = self.ask(&python, "script", &executable.to_string_lossy())?;
                files.own.extend(answer.files);
                files.interpreter = answer.system;
            }
            files.executable = executable;
            return Ok(files);
        }
        let (kind, name) = match arguments {
            [flag, module, ..] if flag == "-m" => ("module", module.as_str()),
            _ => match arguments.iter().find(|word| !word.starts_with('-')) {
                Some(script) if self.folder.join(script).is_file() => ("script", script.as_str()),
                Some(script) => {
                    return Err(format!("there is no {}", self.folder.join(script).display()));
                }
                None => return Err("command names no Python script".to_owned()),
            },
        };
        let answer = self.ask(&executable, kind, name)?;
        files.own.extend(answer.files);
        files.executable = answer.executable;
        files.interpreter = answer.system;
        Ok(files)
    }

    /// The program that a word names: beside the suite, or on the path.
    fn executable(&self, program: &str) -> Result<PathBuf, String> {
        let beside = self.folder.join(program);
        if beside.is_file() {
            return Ok(beside);
        }
        let path =
            self.environment.get("PATH").map(Into::into).or_else(|| std::env::var_os("PATH"));
        let on_path = || {
            let folders = std::env::split_paths(path.as_ref()?).collect::<Vec<_>>();
            folders.into_iter().map(|folder| folder.join(program)).find(|file| file.is_file())
        };
        let found = if program.contains('/') { None } else { on_path() };
        found.ok_or_else(|| {
            format!("there is no program {program:?} in {} or on the PATH", self.folder.display())
        })
    }

    /// The Python that the first line of a script names, as those do that packages install.
    fn python_of(&self, script: &Path) -> Option<PathBuf> {
        let mut head = Vec::new();
        File::open(script).ok()?.take(512).read_to_end(&mut head).ok()?;
        let text = String::from_utf8_lossy(&head).into_owned();
        let mut words = text.lines().next()?.strip_prefix("#!")?.split_whitespace();
        let is_python =
            |word: &&str| word.rsplit('/').next().is_some_and(|n| n.starts_with("python"));
        self.executable(words.find(is_python)?).ok()
    }

    fn ask(&self, python: &Path, kind: &str, name: &str) -> Result<Answer, String> {
        let output = Command::new(python)
            .args(["-c", DEPENDENCIES])
            .arg(&self.folder)
            .args([kind, name])
            .current_dir(&self.folder)
            .envs(&self.environment)
            .output()
            .map_err(|error| format!("{} cannot be started: {error}", python.display()))?;
        let answer: Answer = serde_json::from_slice(&output.stdout).map_err(|_| {
            let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
            let last = said.lines().last().unwrap_or("no message").to_owned();
            format!("{} cannot say what {name} is made of: {last}", python.display())
        })?;
        match answer.error {
            Some(error) => Err(error),
            None => Ok(answer),
        }
    }
}

impl ProgramFiles {
    /// Files of the user that the program may read, without `inputs`.
    pub(super) fn readable(&self) -> impl Iterator<Item = &PathBuf> {
        self.own.iter().chain(&self.interpreter).chain([&self.executable])
    }

    /// A key of all that decides the program's result: equal keys, equal programs.
    pub fn key(&self, program: &Program) -> std::io::Result<String> {
        let mut parts = vec![
            format!("{:?}", program.start),
            format!("{:?}", program.environment),
            format!("{:?}", program.version),
        ];
        if program.gives == Gives::Pictures {
            parts.push(format!("pictures {}", program.texture_size));
        }
        if program.network {
            parts.push("network".to_owned());
        }
        if !program.settings.is_empty() {
            parts.push(format!("set {}", program.settings_json()));
        }
        for path in self.own.iter().chain(&program.inputs) {
            // A path of the system's changes with its packages, not with the method.
            let content = if is_system(path) { String::new() } else { hash_path(path)? };
            parts.push(format!("{} {content}", path.display()));
        }
        Ok(hash_parts(&parts.iter().map(String::as_str).collect::<Vec<_>>()))
    }

    /// All that makes it this program, wherever it lies: settings, and names and hashes of its files.
    pub(in crate::suite) fn content(&self, program: &Program) -> std::io::Result<Vec<String>> {
        let mut parts = Vec::new();
        for path in self.own.iter().chain(&program.inputs).filter(|path| !is_system(path)) {
            let name = match path.strip_prefix(&program.folder) {
                Ok(below) => below.as_os_str(),
                Err(_) => path.file_name().unwrap_or_default(),
            };
            parts.push(format!("{} {}", name.to_string_lossy(), hash_path(path)?));
        }
        parts.sort();
        parts.push(format!("{:?}", (&program.start, &program.version, program.gives)));
        parts.push(format!("{} {}", program.settings_json(), program.texture_size));
        Ok(parts)
    }

    /// Text of a report: `mine.py and 3 more files, version "2"`.
    pub fn in_words(&self, program: &Program) -> String {
        let name =
            |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let own: Vec<_> = self.own.iter().filter(|path| !is_system(path)).collect();
        let mut words = own.first().map_or_else(|| name(&self.executable), |path| name(path));
        if own.len() > 1 {
            words.push_str(&format!(" and {} more files", own.len() - 1));
        }
        match &program.version {
            Some(version) => format!("{words}, version {version:?}"),
            None => words,
        }
    }
}
