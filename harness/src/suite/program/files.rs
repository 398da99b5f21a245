//! Files of a program: found before anything is rendered. They are all that it can read beside the system, and part of
//! its result's key.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::Command;

use formats::content_hash::{hash_parts, hash_path};
use serde::Deserialize;

use super::confine::is_system;
use super::pictures::Gives;
use super::start::{Program, Start};
use crate::suite::near;
use crate::suite::tree_hashes::TreeHashes;
use crate::synth::Interpreter;

/// Says what a Python program is made of; for any Python from 3.8 on.
const DEPENDENCIES: &str = include_str!("dependencies.py");

/// A program that was found, and its files.
#[derive(Clone, Debug, Default)]
pub struct ProgramFiles {
    pub(super) executable: PathBuf,
    /// With `{capture}` and `{maps}` still in them.
    pub(super) arguments: Vec<String>,
    /// Its own files.
    own: Vec<PathBuf>,
    /// Folders of what it imports that is neither its own nor installed.
    packages: Vec<PathBuf>,
    /// Files and folders of its interpreter, and of all that is installed for it.
    installed: Vec<PathBuf>,
    /// Folders in which it looks for modules.
    listed: Vec<PathBuf>,
}

/// The answer of `dependencies.py`.
#[derive(Deserialize)]
struct Answer {
    executable: PathBuf,
    files: Vec<PathBuf>,
    #[serde(default)]
    arguments: Option<Vec<String>>,
    packages: Vec<PathBuf>,
    installed: Vec<PathBuf>,
    listed: Vec<PathBuf>,
    error: Option<String>,
}

impl Program {
    /// Finds the program and its files; the error is only the reason.
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
                let arguments = arguments.map(str::to_owned).to_vec();
                let mut files = ProgramFiles { arguments, ..ProgramFiles::default() };
                files.executable.clone_from(&answer.executable);
                files.add(answer, self);
                Ok(files)
            }
            Start::Command(words) => self.find_command(words),
        }
    }

    fn find_command(&self, words: &[String]) -> Result<ProgramFiles, String> {
        let (program, arguments) =
            words.split_first().ok_or("command is empty; name a program".to_owned())?;
        for place in ["{capture}", "{maps}"] {
            if !arguments.iter().any(|word| word.contains(place)) {
                return Err(format!("command does not contain {place}; add it as an argument"));
            }
        }
        if self.gives == Gives::Maps && arguments.iter().any(|word| word.contains("{lights}")) {
            return Err(
                "command contains {lights}, which only methods with gives = \"pictures\" get; \
                        add gives, or remove {lights}"
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
            match self.python_of(&executable) {
                Some(python) => {
                    let answer = self.ask(&python, "script", &executable.to_string_lossy())?;
                    files.add(answer, self);
                }
                None => files.own.extend(self.libraries(&executable)),
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
        files.executable.clone_from(&answer.executable);
        files.add(answer, self);
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
            .env_clear()
            .envs(self.all_variables(python.parent().unwrap_or(&self.folder)))
            // A version manager's stand-in for Python finds the real one by these.
            .envs(["PATH", "HOME"].iter().filter_map(|name| Some((name, std::env::var_os(name)?))))
            .envs(&self.environment)
            .output()
            .map_err(|error| format!("{} cannot be started: {error}", python.display()))?;
        let answer: Answer = serde_json::from_slice(&output.stdout).map_err(|_| {
            let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
            let last = said.lines().last().unwrap_or("no message").to_owned();
            format!("{} cannot list the files of {name}: {last}", python.display())
        })?;
        match answer.error {
            Some(error) => Err(error),
            None => Ok(answer),
        }
    }
}

impl Program {
    /// Shared libraries of an executable that are not the system's, as its loader finds them.
    fn libraries(&self, executable: &Path) -> Vec<PathBuf> {
        if executable.canonicalize().is_ok_and(|real| is_system(&real)) {
            return Vec::new();
        }
        let said = Command::new("ldd").arg(executable).envs(self.variables()).output();
        let text = said.map(|said| String::from_utf8_lossy(&said.stdout).into_owned());
        let words = text.unwrap_or_default();
        let found =
            words.split_whitespace().filter(|word| word.starts_with('/')).map(PathBuf::from);
        found.filter(|path| path.is_file() && !is_system(path)).collect()
    }
}

impl ProgramFiles {
    fn add(&mut self, answer: Answer, program: &Program) {
        self.own.extend(answer.files);
        (self.packages, self.installed) = (answer.packages, answer.installed);
        self.installed.extend(program.libraries(&answer.executable));
        self.installed.push(answer.executable);
        self.listed = answer.listed;
    }

    /// Files and folders that the program may read beside the system's, without `inputs`.
    pub(super) fn readable(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.own, &self.packages, &self.installed].into_iter().flatten().chain([&self.executable])
    }

    /// Folders of which it may see the names.
    pub(super) fn listed(&self) -> &[PathBuf] {
        &self.listed
    }

    /// A key of all that decides the program's result: equal keys, equal programs. `ours` are the versions and the code of
    /// the package `unshade`, as far as functions may call it.
    pub(in crate::suite) fn key(
        &self,
        program: &Program,
        trees: &TreeHashes,
        ours: &str,
    ) -> io::Result<String> {
        let mut parts = vec![
            format!("{:?}", program.start),
            format!("{:?}", program.variables()),
            format!("{:?}", program.version),
            // What is part of the system is as its release has it.
            system_release(),
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
        for path in self.own.iter().chain(&program.inputs).chain([&self.executable]) {
            parts.push(format!("{} {}", path.display(), hash_path(path)?));
        }
        let is_ours = |path: &&PathBuf| {
            matches!(program.start, Start::Python(_)) && path.ends_with("unshade")
        };
        let (own, others): (Vec<_>, Vec<_>) = self.packages.iter().partition(is_ours);
        parts.extend(own.iter().map(|_| ours.to_owned()));
        let others: Vec<PathBuf> = others.into_iter().cloned().collect();
        parts.push(trees.hash(&others)?);
        parts.push(trees.once(&self.installed)?);
        Ok(hash_parts(&parts.iter().map(String::as_str).collect::<Vec<_>>()))
    }

    /// All that makes it this program, wherever it lies: settings, and names and hashes of its files.
    pub(in crate::suite) fn content(&self, program: &Program) -> io::Result<Vec<String>> {
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

/// The name and version of the system's release.
fn system_release() -> String {
    let text = fs::read_to_string("/etc/os-release").unwrap_or_default();
    let stated = |line: &&str| ["ID=", "VERSION_ID="].iter().any(|key| line.starts_with(key));
    let mut words: Vec<&str> = text.lines().filter(stated).collect();
    words.push(std::env::consts::ARCH);
    words.join(" ")
}
