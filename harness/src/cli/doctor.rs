//! `unshade doctor`: what was found, and what is missing with the fix.

use serde_json::Value;
use solver::Choice;
use solver::backend::gpu::{VARIABLE, adapters};

use super::alone::alone;
use super::exit::{CHECK_FAILED, DONE};
use super::outcome::Outcome;
use crate::suite::{Observer, RunError};
use crate::synth::{Request, StageError, Tools};

/// Shows one line a part; exit code 1 if something that a run needs is missing.
pub(super) fn examine(
    tools: &Tools,
    physics: bool,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let mut lines = vec![
        format!("unshade      {}", env!("CARGO_PKG_VERSION")),
        format!("python       {}", tools.interpreter.path().display()),
        format!("cpu          {} threads, {}", rayon::current_num_threads(), solver::simd_level()),
    ];
    let adapters = adapters();
    if adapters.is_empty() {
        lines.push("gpu          none".to_owned());
    }
    for adapter in adapters {
        let kind = match adapter.software {
            true => format!("software: only if {VARIABLE} names it"),
            false => "GPU".to_owned(),
        };
        let (name, api, driver) = (adapter.name, adapter.api, adapter.driver);
        lines.push(format!("gpu          {name} ({api}, {driver}, {kind})"));
    }
    let backend = Choice::Auto.open().map_or_else(|e| e.to_string(), |b| b.name());
    lines.push(format!("backend auto {backend}"));
    let mut complete = checks(tools.ask(&Request::Doctor), &mut lines)?;
    if complete && physics {
        let found = alone("physics", observer, |step| Ok(tools.run(&Request::Physics, step)))?;
        complete = checks(found, &mut lines)?;
    }
    let code = if complete { DONE } else { CHECK_FAILED };
    Ok(Outcome { code, lines, ..Outcome::default() })
}

/// Adds a line for each check of a stage; returns whether all hold.
fn checks(found: Result<Value, StageError>, lines: &mut Vec<String>) -> Result<bool, RunError> {
    let found = match found {
        Ok(found) => found,
        Err(StageError::Interrupted) => return Err(RunError::Interrupted),
        Err(error) => {
            lines.push(format!("renderer     FAILED: {error}"));
            return Ok(false);
        }
    };
    let mut complete = true;
    for part in found["checks"].as_array().into_iter().flatten() {
        let text = |key: &str| part.get(key).and_then(Value::as_str).unwrap_or_default();
        if part["ok"].as_bool().unwrap_or(false) {
            lines.push(format!("{:<12} {}", text("name"), text("found")));
        } else {
            complete = false;
            lines.push(format!("{:<12} FAILED: {}; {}", text("name"), text("found"), text("fix")));
        }
    }
    Ok(complete)
}
