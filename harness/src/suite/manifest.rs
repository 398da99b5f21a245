//! `run.json`: what a run consists of, where everything lies, and which methods failed.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::file::Suite;
use super::sources::{SCORE_SOURCES, SOLVER_SOURCES};
use crate::synth::Fingerprints;

/// Facts of a run that has ended.
pub(super) struct Made<'a> {
    /// Methods that failed: `<case>/<method>` and why. What an earlier run left of such a method is not
    /// named.
    pub failed: &'a BTreeMap<String, String>,
    /// `<case>/<method>` of which nothing valid is there, and which was not to be run.
    pub left_out: BTreeSet<String>,
    /// The identity of each method, by its id, see [`MethodWork::identity`](super::method_work).
    pub contents: BTreeMap<String, String>,
    /// Bytes that the stages of each kind left, by their folders.
    pub sizes: BTreeMap<&'static str, u64>,
}

impl Default for Made<'_> {
    fn default() -> Self {
        static NOTHING: BTreeMap<String, String> = BTreeMap::new();
        Self {
            failed: &NOTHING,
            left_out: BTreeSet::new(),
            contents: BTreeMap::new(),
            sizes: BTreeMap::new(),
        }
    }
}

/// The content of `run.json`.
pub(super) fn manifest(suite: &Suite, renderer: &Fingerprints, made: &Made) -> Value {
    let cases: Vec<Value> = suite
        .cases
        .iter()
        .map(|case| {
            let solvers: Vec<Value> = suite
                .methods
                .iter()
                .filter(|method| !made.left_out.contains(&format!("{}/{}", case.id, method.id)))
                .map(|method| {
                    let name = format!("{}/{}", case.id, method.id);
                    let below = |folder| format!("{folder}/{name}");
                    let mut solver = json!({
                        "id": method.id, "kind": method.work().role(), "class": method.work().class().name(),
                        "title": method.title,
                    });
                    if let Some((name, seed)) = &method.replicate {
                        solver["of"] = json!(name);
                        solver["seed"] = json!(seed);
                    }
                    if let Some(author) = &method.author {
                        solver["author"] = json!(author);
                    }
                    if let Some(content) = made.contents.get(&method.id) {
                        solver["content"] = json!(content);
                    }
                    if !method.set.is_empty() {
                        solver["set"] = json!(method.set);
                    }
                    if let Some(reason) = made.failed.get(&name) {
                        solver["failed"] = json!(reason);
                    } else {
                        solver["maps"] = json!(below("maps"));
                        solver["relit"] = json!(below("relit"));
                        solver["scores"] = json!(format!("{}.json", below("scores")));
                    }
                    solver
                })
                .collect();
            json!({
                "id": case.id, "face": case.scene.name_of("face"),
                "light": case.scene.name_of("light"), "variant": case.variant,
                "seed": case.seed,
                "capture": match &case.photographed {
                    Some(folder) => folder.display().to_string(),
                    None => format!("captures/{}", case.id),
                },
                "solvers": solvers,
            })
        })
        .filter(|case| case["solvers"] != json!([]) || made.left_out.is_empty())
        .collect();
    let mut manifest = json!({
        "format": 1, "suite": suite.name, "title": suite.title, "cases": cases,
        "versions": {
            "unshade": env!("CARGO_PKG_VERSION"), "renderer": renderer.to_string(),
            "solver sources": SOLVER_SOURCES, "scoring sources": SCORE_SOURCES,
        },
        "suite_toml": suite.text,
    });
    if !made.sizes.is_empty() {
        manifest["bytes"] = json!(made.sizes);
    }
    manifest
}
