//! Submissions: what others make of handed-out captures, checked and scored.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use formats::atomic::{self, Folder};
use formats::content_hash::hash_path;
use scoring::check::{self, Finding, Level};
use scoring::run::{self, FORMAT, RunFile};
use scoring::score::{self, Scores};
use sealing::{Secret, Statement};
use serde::Deserialize;

use super::error::RunError;
use super::file::{RENDERERS, SCALES};
use super::manifest;
use super::observer::Observer;
use super::plan::StageKind;
use super::remote_stage::versions;
use super::seal::{Relight, Round, SealedCase};
use super::stages;
use crate::synth::Tools;

const FILE: &str = "submission.toml";

/// `submission.toml`: whose maps these are. The maps lie in `maps/<case>`.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Submission {
    /// Version of the format.
    pub format: u32,
    /// The method; letters, digits, `-` and `_`.
    pub name: String,
    /// The name in tables.
    pub title: Option<String>,
    /// Who sends it.
    pub by: String,
}

impl Submission {
    fn read(folder: &Path) -> Result<Self, String> {
        let path = folder.join(FILE);
        let text = fs::read_to_string(&path).map_err(|error| {
            format!("{}: cannot be read: {error}; write format = 1, name and by", path.display())
        })?;
        let submission: Self = toml::from_str(&text).map_err(|error| {
            format!("{}: {}", path.display(), error.message().replace('\n', " "))
        })?;
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if submission.format != 1 {
            return Err(format!(
                "{}: format is {}; this version reads 1",
                path.display(),
                submission.format
            ));
        }
        if submission.name.is_empty() || !submission.name.chars().all(plain) {
            let name = &submission.name;
            return Err(format!(
                "{}: name {name:?} cannot name a folder; use letters, digits, - and _",
                path.display()
            ));
        }
        // A link could lead to the truth that the maps are scored against.
        match link_below(folder) {
            Some(link) => Err(format!("{}: is a link; put the file itself there", link.display())),
            None => Ok(submission),
        }
    }

    fn maps(folder: &Path, case: &str) -> PathBuf {
        folder.join(StageKind::Maps.folder()).join(case)
    }
}

/// The first link below a folder, if there is one.
fn link_below(folder: &Path) -> Option<PathBuf> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths.into_iter().find_map(|path| match path.is_symlink() {
        true => Some(path),
        false => path.is_dir().then(|| link_below(&path)).flatten(),
    })
}

/// Result of checking a submission.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checked {
    /// Faults for which it is refused.
    pub faults: Vec<String>,
    /// Likely faults of its maps, by case.
    pub findings: Vec<(String, Finding)>,
    /// Cases that are there, of how many.
    pub cases: usize,
    /// See `cases`.
    pub of: usize,
}

/// Looks through a submission as who scores it would: a folder of maps for the captures of a round (`public`),
/// or a run's folder with its scores, for a leaderboard.
pub fn check_submission(folder: &Path, public: Option<&Path>) -> Result<Checked, RunError> {
    if folder.join(RunFile::NAME).is_file() && !folder.join(FILE).is_file() {
        return check_scored(folder);
    }
    let mut checked = Checked::default();
    if let Err(fault) = Submission::read(folder) {
        checked.faults.push(fault);
    }
    let cases: Vec<(String, Option<PathBuf>)> = match public {
        Some(public) => {
            let round = Round::read(public)?;
            let captures = public.join(StageKind::Capture.folder());
            for case in &round.cases {
                let capture = captures.join(&case.id);
                if hash_path(&capture).ok().as_ref() != Some(&case.capture) {
                    checked.faults.push(format!(
                        "{}: is not the capture that was handed out; get it again",
                        capture.display()
                    ));
                }
            }
            round
                .cases
                .iter()
                .map(|case| (case.id.clone(), Some(captures.join(&case.id))))
                .collect()
        }
        None => {
            let listed = fs::read_dir(folder.join(StageKind::Maps.folder())).into_iter().flatten();
            let folders = listed.flatten().filter(|entry| entry.path().is_dir());
            let names = folders.map(|entry| entry.file_name().to_string_lossy().into_owned());
            let mut names: Vec<String> = names.collect();
            names.sort();
            names.into_iter().map(|name| (name, None)).collect()
        }
    };
    checked.of = cases.len();
    for (case, capture) in cases {
        let maps = Submission::maps(folder, &case);
        if !maps.is_dir() {
            checked.faults.push(format!("{}: is missing; it would have no scores", maps.display()));
            continue;
        }
        checked.cases += 1;
        let found = check::check(&maps, capture.as_deref())?;
        for finding in found {
            if finding.level == Level::Error {
                checked.faults.push(format!("{case}: {finding}"));
            } else {
                checked.findings.push((case.clone(), finding));
            }
        }
    }
    if checked.cases == 0 {
        checked.faults.push(format!("{}: holds no maps; write maps/<case>/", folder.display()));
    }
    Ok(checked)
}

/// Checks a run's folder for a leaderboard: its scores are there, and belong to its cases and methods.
fn check_scored(run: &Path) -> Result<Checked, RunError> {
    let mut checked = Checked::default();
    let manifest = match RunFile::open(run) {
        Ok(manifest) => manifest,
        Err(fault) => {
            checked.faults.push(fault.to_string());
            return Ok(checked);
        }
    };
    for (case, method) in manifest.methods() {
        let Some(file) = &method.scores else { continue };
        checked.of += 1;
        match Scores::read(&run.join(file)) {
            Err(error) => checked.faults.push(error.to_string()),
            Ok(scores) if scores.light != case.light || scores.solver != method.id => {
                let file = file.display();
                checked
                    .faults
                    .push(format!("{file}: is of another case or method than run.json says"));
            }
            Ok(_) => checked.cases += 1,
        }
    }
    if checked.of == 0 {
        let path = run.join(RunFile::NAME);
        checked.faults.push(format!("{}: names no scores; finish the run", path.display()));
    }
    if sealing::is_signed(run)
        && let Err(error) = sealing::verify(run, None)
    {
        checked.faults.push(error.to_string());
    }
    Ok(checked)
}

/// Relights and scores the submission `folder` against the truth in `private`, and writes scores that are
/// signed to `out`: a run's folder, for tables and leaderboards.
pub fn score_submission(
    folder: &Path,
    private: &Path,
    out: &Path,
    secret: &Secret,
    tools: &Tools,
    observer: &mut dyn Observer,
) -> Result<BTreeMap<String, String>, RunError> {
    observer.suite_begins();
    atomic::refuse_overlap(out, &[folder, private])?;
    let submission = Submission::read(folder).map_err(RunError::Submission)?;
    let round = Round::read(private)?;
    if round.public_key != secret.public_key() {
        return Err(RunError::Submission(format!(
            "{}: was sealed with another secret; name that one",
            private.display()
        )));
    }
    let target = Folder::begin(out)?;
    let scored = Scoring {
        folder,
        private,
        out: target.path(),
        submission: &submission,
        round: &round,
        tools,
    };
    match scored.all(observer).and_then(|done| scored.sign(done, secret)) {
        Ok(failed) => {
            target.commit()?;
            Ok(failed)
        }
        Err(error) => {
            target.abandon();
            Err(error)
        }
    }
}

struct Scoring<'a> {
    folder: &'a Path,
    private: &'a Path,
    out: &'a Path,
    submission: &'a Submission,
    round: &'a Round,
    tools: &'a Tools,
}

#[derive(Default)]
struct Scored {
    maps: BTreeMap<String, Option<String>>,
    failed: BTreeMap<String, String>,
}

impl Scoring<'_> {
    fn file(&self, case: &str) -> String {
        format!("scores/{case}/{}.json", self.submission.name)
    }

    fn all(&self, observer: &mut dyn Observer) -> Result<Scored, RunError> {
        let mut scored = Scored::default();
        for (at, case) in self.round.cases.iter().enumerate() {
            observer.stage_begins(&case.id, at, self.round.cases.len());
            let start = std::time::Instant::now();
            let maps = Submission::maps(self.folder, &case.id);
            let hash = if maps.is_dir() { Some(hash_path(&maps)?) } else { None };
            let missing = || Err(RunError::Submission(format!("maps/{}: is missing", case.id)));
            let step = &mut |done, total, what: &str| observer.step(&case.id, done, total, what);
            match hash.as_ref().map_or_else(missing, |_| self.one(case, &maps, step)) {
                Err(error) if error.is_of_method() => {
                    scored.failed.insert(case.id.clone(), error.to_string());
                }
                result => result?,
            }
            scored.maps.insert(case.id.clone(), hash);
            observer.stage_ends(&case.id, Some(start.elapsed().as_secs_f64()));
        }
        Ok(scored)
    }

    fn one(
        &self,
        case: &SealedCase,
        maps: &Path,
        step: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<(), RunError> {
        let capture = self.private.join(StageKind::Capture.folder()).join(&case.id);
        if hash_path(&capture)? != case.truth.clone().unwrap_or_default() {
            return Err(RunError::Folder(io::Error::other(format!(
                "{}: was changed since it was sealed",
                capture.display()
            ))));
        }
        let Relight { scales, renderer } = self.round.relight.clone().unwrap_or(Relight {
            scales: SCALES.map(str::to_owned).into(),
            renderer: RENDERERS[0].to_owned(),
        });
        let scratch = tempfile::tempdir()?;
        let pictures = scratch.path().join("relit");
        let scales: Vec<&str> = scales.iter().map(String::as_str).collect();
        let relit = stages::Relight {
            capture: &capture,
            maps,
            out: &pictures,
            renderer: &renderer,
            scales: &scales,
            light: None,
        };
        stages::relight(&relit, self.tools, step)?;
        let mut scores = score::score(&capture, maps, Some(&pictures))?;
        scores.solver.clone_from(&self.submission.name);
        let file = self.out.join(self.file(&case.id));
        fs::create_dir_all(file.parent().unwrap_or(self.out))?;
        Ok(scores.write(&file)?)
    }

    /// The case of the manifest.
    fn described(&self, case: &SealedCase, scored: &Scored) -> run::Case {
        let Submission { name, title, by, .. } = self.submission;
        let failed = scored.failed.get(&case.id).cloned();
        let scores = failed.is_none().then(|| self.file(&case.id).into());
        let method = run::Method {
            id: name.clone(),
            kind: run::Kind::Solver,
            class: run::Class::Passive,
            title: Some(title.as_ref().unwrap_or(name).clone()),
            of: None,
            seed: None,
            author: Some(by.clone()),
            content: None,
            set: serde_json::Map::new(),
            failed,
            maps: None,
            relit: None,
            scores,
        };
        run::Case {
            id: case.id.clone(),
            face: case.face.clone(),
            light: case.light.clone(),
            variant: case.variant.clone(),
            seed: None,
            capture: format!("captures/{}", case.id).into(),
            methods: vec![method],
        }
    }

    /// Writes the manifest, and the statement with its signature.
    fn sign(&self, scored: Scored, secret: &Secret) -> Result<BTreeMap<String, String>, RunError> {
        let (round, name) = (self.round, &self.submission.name);
        let renderer = self.tools.interpreter.fingerprints()?;
        let by = &self.submission.by;
        RunFile {
            format: FORMAT,
            suite: round.suite.clone(),
            title: Some(format!("{}, round {}: {name} by {by}", round.suite, round.round)),
            cases: round.cases.iter().map(|case| self.described(case, &scored)).collect(),
            versions: manifest::versions(&renderer),
            suite_toml: None,
            bytes: BTreeMap::new(),
        }
        .write(self.out)?;
        let written = round.cases.iter().filter(|case| !scored.failed.contains_key(&case.id));
        let names = written.map(|case| self.file(&case.id)).chain([RunFile::NAME.to_owned()]);
        let files = names.map(|name| Ok((name.clone(), hash_path(&self.out.join(&name))?)));
        let of = |hash: &dyn Fn(&SealedCase) -> String| {
            round.cases.iter().map(|case| (case.id.clone(), hash(case))).collect()
        };
        let statement = Statement {
            format: 1,
            suite: round.suite.clone(),
            round: round.round.clone(),
            method: name.clone(),
            by: self.submission.by.clone(),
            captures: of(&|case| case.capture.clone()),
            truths: of(&|case| case.truth.clone().unwrap_or_default()),
            maps: scored.maps,
            files: files.collect::<io::Result<_>>()?,
            versions: BTreeMap::from([("all".to_owned(), versions(&renderer))]),
        };
        sealing::write_signed(self.out, &statement, secret)?;
        Ok(scored.failed)
    }
}
