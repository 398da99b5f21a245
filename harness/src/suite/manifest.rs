//! `run.json`: what a run consists of, where everything lies, and which methods failed.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::file::Suite;
use super::sources::{SCORE_SOURCES, SOLVER_SOURCES};

/// The content of `run.json`. `failed` says why, by `<case>/<method>`: what an earlier run left of such
/// a method is not named.
pub(super) fn manifest(suite: &Suite, renderer: &str, failed: &BTreeMap<String, String>) -> Value {
    let cases: Vec<Value> = suite
        .cases
        .iter()
        .map(|case| {
            let solvers: Vec<Value> = suite
                .methods
                .iter()
                .map(|method| {
                    let name = format!("{}/{}", case.id, method.id);
                    let below = |folder| format!("{folder}/{name}");
                    let mut solver = json!({
                        "id": method.id, "kind": method.role(), "class": method.class().name(),
                        "title": method.title,
                    });
                    if let Some((name, seed)) = &method.replicate {
                        solver["of"] = json!(name);
                        solver["seed"] = json!(seed);
                    }
                    if let Some(reason) = failed.get(&name) {
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
