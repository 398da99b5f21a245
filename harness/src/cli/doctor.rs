//! `unshade doctor`: what was found, and what is missing with the fix.

use serde_json::Value;
use solver::Choice;
use solver::backend::gpu::{VARIABLE, adapters};

use super::exit::{CHECK_FAILED, DONE};
use super::progress::Progress;
use crate::suite::{Observer, RunError, Tools};
use crate::synth::{StageError, run_stage};

/// Shows one line a part; exit code 1 if something that a run needs is missing.
pub(super) fn examine(tools: &Tools, physics: bool) -> Result<u8, RunError> {
    say!("unshade      {}", env!("CARGO_PKG_VERSION"));
    say!("python       {}", tools.interpreter.path().display());
    say!("cpu          {} threads, {}", rayon::current_num_threads(), solver::simd_level());
    let adapters = adapters();
    if adapters.is_empty() {
        say!("gpu          none");
    }
    for adapter in adapters {
        let kind = match adapter.software {
            true => format!("software: only if {VARIABLE} names it"),
            false => "GPU".to_owned(),
        };
        say!("gpu          {} ({}, {}, {kind})", adapter.name, adapter.api, adapter.driver);
    }
    say!("backend auto {}", Choice::Auto.open().map_or_else(|e| e.to_string(), |b| b.name()));
    let mut complete = checks(tools, "doctor", &mut |_, _, _| {})?;
    if complete && physics {
        let mut progress = Progress::new();
        progress.stage_begins("physics", 0, 1);
        let passed = checks(tools, "physics", &mut |done, total, what| {
            progress.step("physics", done, total, what);
        });
        progress.finish();
        complete = passed?;
    }
    Ok(if complete { DONE } else { CHECK_FAILED })
}

/// Runs the checks of one stage and prints a line for each; whether all hold.
fn checks(
    tools: &Tools,
    stage: &str,
    step: &mut dyn FnMut(u64, u64, &str),
) -> Result<bool, RunError> {
    let found = match run_stage(&tools.interpreter, stage, &[], &tools.interrupt, step) {
        Ok(found) => found,
        Err(StageError::Interrupted) => return Err(RunError::Interrupted),
        Err(error) => {
            say!("renderer     FAILED: {error}");
            return Ok(false);
        }
    };
    let mut complete = true;
    for part in found["checks"].as_array().into_iter().flatten() {
        let text = |key: &str| part.get(key).and_then(Value::as_str).unwrap_or_default();
        if part["ok"].as_bool().unwrap_or(false) {
            say!("{:<12} {}", text("name"), text("found"));
        } else {
            complete = false;
            say!("{:<12} FAILED: {}; {}", text("name"), text("found"), text("fix"));
        }
    }
    Ok(complete)
}
