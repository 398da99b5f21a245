//! Sealed suites: faces that a secret makes, handed out without their truth.

use std::fs;
use std::io;
use std::path::Path;

use formats::atomic::{self, Folder};
use formats::content_hash::hash_path;
use sealing::Secret;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::error::RunError;
use super::executor::Contents;
use super::file::Suite;
use super::observer::Observer;
use super::plan::StageKind;
use super::program::copy_blind;
use super::run::{RunOptions, stages};
use super::scene::SceneError;
use crate::synth::Tools;

/// Folders of a round: for others, and to be kept here.
pub(super) const PUBLIC: &str = "public";
pub(super) const PRIVATE: &str = "private";
/// File that names the round of a folder.
pub(super) const ROUND: &str = "round.json";

/// A round of a sealed suite: `public/round.json`, and with the truth `private/round.json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Round {
    /// Version of the format.
    pub format: u32,
    /// The suite's name, and which round of it.
    pub suite: String,
    /// See `suite`.
    pub round: String,
    /// Who signs the scores.
    pub public_key: String,
    /// In the order of the suite.
    pub cases: Vec<SealedCase>,
    /// How maps are relit; of who scores alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relight: Option<Relight>,
}

/// A capture that was handed out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SealedCase {
    /// Names its folder below `captures`.
    pub id: String,
    /// Names of what is no secret.
    pub face: String,
    /// See `face`.
    pub light: String,
    /// See `face`.
    pub variant: Option<String>,
    /// Hash of the capture as it was handed out.
    pub capture: String,
    /// Hash of the capture with its truth; of who scores alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truth: Option<String>,
}

/// How the maps of a submission are relit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Relight {
    /// Under which scales of the albedo.
    pub scales: Vec<String>,
    /// By what.
    pub renderer: String,
}

/// The secret in a file of 32 bytes or more.
pub fn secret(path: &Path) -> Result<Secret, RunError> {
    Ok(Secret::read(path)?)
}

/// Checks the signature of scores, by `key` if it is given; the public key that signed them.
pub fn seal_verify(folder: &Path, key: Option<&str>) -> Result<String, RunError> {
    Ok(sealing::verify(folder, key)?.public_key)
}

impl Round {
    /// Reads the round of a public or private folder.
    pub fn read(folder: &Path) -> Result<Self, RunError> {
        let path = folder.join(ROUND);
        let wrong = |reason| RunError::File { path: path.clone(), reason };
        let text = fs::read(&path).map_err(wrong)?;
        serde_json::from_slice(&text).map_err(|error| wrong(io::Error::other(error)))
    }

    fn write(&self, folder: &Path) -> Result<(), RunError> {
        let mut text = serde_json::to_vec_pretty(self).map_err(io::Error::from)?;
        text.push(b'\n');
        Ok(atomic::write_file(&folder.join(ROUND), &text)?)
    }
}

/// Options of sealing beside the suite.
pub struct Sealing<'a> {
    /// Makes the faces, and signs.
    pub secret: &'a Secret,
    /// Another round has other faces.
    pub round: &'a str,
    /// How many captures are rendered at once.
    pub jobs: usize,
}

/// Renders the suite with the secret's faces: `out/public` for others, `out/private` with the truth.
pub fn seal(
    suite: &Suite,
    out: &Path,
    sealing: &Sealing,
    tools: &Tools,
    observer: &mut dyn Observer,
) -> Result<Round, RunError> {
    if suite.lpips.is_some() {
        let reason = "a round is scored without LPIPS; remove it".to_owned();
        return Err(SceneError::value(&suite.path, "lpips", reason).into());
    }
    if suite.metrics.is_any() {
        let reason = "a round is scored with unshade's own metrics only; remove it".to_owned();
        return Err(SceneError::value(&suite.path, "metrics", reason).into());
    }
    let mut suite = suite.clone();
    // A round has captures alone; methods are the business of those who take part.
    suite.methods.clear();
    for case in &mut suite.cases {
        let refused = |reason: &str| {
            let reason = format!("{}: {reason}", case.id);
            RunError::from(SceneError::value(&suite.path, "faces", reason))
        };
        if case.photographed.is_some() {
            return Err(refused("photographs have no truth to keep; leave captures out"));
        }
        let names = [suite.name.as_str(), sealing.round, case.scene.name_of("face")];
        let face =
            case.scene.table.get("face").and_then(Value::as_table).cloned().unwrap_or_default();
        if face.keys().any(|key| ["mesh", "path", "diffuse_albedo"].contains(&key.as_str())) {
            return Err(refused(
                "is a head of files, which others may have; name a generated face",
            ));
        }
        let seed =
            |what: &str| Value::Integer(sealing.secret.seed(&[names.as_slice(), &[what]].concat()));
        let table = |what: &str| Value::Table(Table::from_iter([("seed".to_owned(), seed(what))]));
        let changes = ["face", "render"].map(|section| (section.to_owned(), table(section)));
        case.scene = case.scene.clone().with_changes(&Table::from_iter(changes));
    }
    let private = out.join(PRIVATE);
    let options = RunOptions { jobs: sealing.jobs, ..RunOptions::default() };
    let (_lock, _, done) = stages(&suite, &private, &options, tools, observer)?;
    let public = Folder::begin(&out.join(PUBLIC))?;
    match hand_out(&suite, &private, public.path(), sealing, &done.contents) {
        Ok(round) => {
            public.commit()?;
            round.write(&private)?;
            Ok(round)
        }
        Err(error) => {
            public.abandon();
            Err(error)
        }
    }
}

/// Writes what others get; returns what stays here.
fn hand_out(
    suite: &Suite,
    private: &Path,
    public: &Path,
    sealing: &Sealing,
    contents: &Contents,
) -> Result<Round, RunError> {
    let mut cases = Vec::new();
    for case in &suite.cases {
        let blind = public.join(StageKind::Capture.folder()).join(&case.id);
        copy_blind(&private.join(StageKind::Capture.folder()).join(&case.id), &blind)?;
        cases.push(SealedCase {
            id: case.id.clone(),
            face: case.scene.name_of("face").to_owned(),
            light: case.scene.name_of("light").to_owned(),
            variant: case.variant.clone(),
            capture: hash_path(&blind)?,
            truth: contents
                .get(&StageKind::Capture.id(&case.id, None))
                .map(|capture| capture.content.clone()),
        });
    }
    let round = Round {
        format: 1,
        suite: suite.name.clone(),
        round: sealing.round.to_owned(),
        public_key: sealing.secret.public_key(),
        cases,
        relight: Some(Relight {
            scales: suite.scales.iter().map(|scale| (*scale).to_owned()).collect(),
            renderer: suite.relight.to_owned(),
        }),
    };
    let blind = |case: &SealedCase| SealedCase { truth: None, ..case.clone() };
    let cases = round.cases.iter().map(blind).collect();
    Round { cases, relight: None, ..round.clone() }.write(public)?;
    Ok(round)
}
