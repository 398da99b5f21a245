//! The manifest of a run: its cases and methods, where everything lies, and which methods failed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use scoring::run::{Case, FORMAT, Method, RunFile};
use serde_json::{Value, json};

use super::cases;
use super::file::Suite;
use super::method;
use super::sources::{SCORE_SOURCES, SOLVER_SOURCES};
use crate::synth::Fingerprints;

/// Facts of a run that has ended.
#[derive(Default)]
pub(super) struct Ended {
    /// Methods that failed: `<case>/<method>` and why. What an earlier run left of such a method is not
    /// named.
    pub failed: BTreeMap<String, String>,
    /// `<case>/<method>` of which nothing valid is there, and which was not to be run.
    pub left_out: BTreeSet<String>,
    /// The identity of each method, by its id, see [`MethodWork::identity`](super::method_work).
    pub contents: BTreeMap<String, String>,
    /// Bytes that the stages of each kind left, by their folders.
    pub bytes: BTreeMap<String, u64>,
}

/// The manifest of a run of `suite`.
pub(super) fn manifest(suite: &Suite, renderer: &Fingerprints, ended: Ended) -> RunFile {
    let mut cases: Vec<Case> =
        suite.cases.iter().map(|case| described(suite, case, &ended)).collect();
    cases.retain(|case| !case.methods.is_empty() || ended.left_out.is_empty());
    let mut versions = versions(renderer);
    versions.insert("solver sources".to_owned(), SOLVER_SOURCES.into());
    RunFile {
        format: FORMAT,
        suite: suite.name.clone(),
        title: Some(suite.title.clone()),
        cases,
        versions,
        suite_toml: Some(suite.text.clone()),
        bytes: ended.bytes,
    }
}

/// Versions of the program, the renderer and the scores.
pub(super) fn versions(renderer: &Fingerprints) -> BTreeMap<String, Value> {
    [
        ("unshade", env!("CARGO_PKG_VERSION").into()),
        ("renderer", renderer.to_string().into()),
        ("scoring sources", SCORE_SOURCES.into()),
    ]
    .map(|(name, version)| (name.to_owned(), version))
    .into()
}

fn described(suite: &Suite, case: &cases::Case, ended: &Ended) -> Case {
    let capture = match &case.photographed {
        // A manifest is UTF-8.
        Some(folder) => folder.to_string_lossy().into_owned(),
        None => format!("captures/{}", case.id),
    };
    let methods = suite.methods.iter().filter_map(|method| {
        let name = format!("{}/{}", case.id, method.id);
        (!ended.left_out.contains(&name)).then(|| column(method, &name, ended))
    });
    Case {
        id: case.id.clone(),
        face: case.scene.name_of("face").to_owned(),
        light: case.scene.name_of("light").to_owned(),
        variant: case.variant.clone(),
        seed: case.seed,
        capture: capture.into(),
        methods: methods.collect(),
    }
}

fn column(method: &method::Method, name: &str, ended: &Ended) -> Method {
    let failed = ended.failed.get(name).cloned();
    let below = |folder: &str| failed.is_none().then(|| PathBuf::from(format!("{folder}/{name}")));
    let replicate = method.replicate.as_ref();
    Method {
        id: method.id.clone(),
        kind: method.role(),
        class: method.work().class(),
        title: Some(method.title.clone()),
        of: replicate.map(|(name, _)| name.clone()),
        seed: replicate.map(|(_, seed)| *seed),
        author: method.author.clone(),
        content: ended.contents.get(&method.id).cloned(),
        set: json!(method.set).as_object().cloned().unwrap_or_default(),
        maps: below("maps"),
        relit: below("relit"),
        scores: failed.is_none().then(|| format!("scores/{name}.json").into()),
        failed,
    }
}
