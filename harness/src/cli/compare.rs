//! `unshade compare`.

use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use clap::Args;
use formats::atomic;
use scoring::compare::{self, Acceptances, CompareError, Places, Tolerances};
use serde::Deserialize;

use super::baseline_branch;
use super::exit::{CHECK_FAILED, DONE};
use super::outcome::Outcome;
use crate::suite::{Observer, RunError, Suite, case_places};
use crate::synth::{Request, Tools};

#[derive(Args, Deserialize)]
pub(super) struct CompareArgs {
    /// The run: its folder or its `run.json`; or a file of scores, or a baseline.
    run: PathBuf,
    /// The other side: an earlier run, a `baseline.json` of `unshade report`, or a file of scores.
    #[arg(required_unless_present = "baseline_branch", conflicts_with = "baseline_branch")]
    baseline: Option<PathBuf>,
    /// Use the baseline of the merge base with this branch, or of the nearest commit before it.
    #[arg(long, value_name = "BRANCH", requires = "baselines")]
    baseline_branch: Option<String>,
    /// The folder of the branch's baselines: <commit>.json.
    #[arg(long, value_name = "DIR", requires = "baseline_branch")]
    baselines: Option<PathBuf>,
    /// A file of `unshade calibrate`, or of rules; by default scenes/tolerances.toml.
    #[arg(long, value_name = "FILE")]
    tolerances: Option<PathBuf>,
    /// Also write the verdicts as JUnit XML.
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Also write a page of Markdown: the summary of a job, or a comment.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Also write everything as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Print GitHub annotations before the table.
    #[arg(long)]
    #[serde(default)]
    github: bool,
    /// Also write small pictures of each change into this folder: before (if the baseline is a run), after, the
    /// reference, and the difference.
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Also append this run to a history of the suite, as a line of JSON.
    #[arg(long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Draw the history as an SVG with its detected steps (needs the extra `history`).
    #[arg(long, value_name = "FILE", requires = "history")]
    chart: Option<PathBuf>,
    /// The run's suite, so that JUnit and annotations name the file and line of each case.
    #[arg(long, value_name = "SUITE")]
    suite: Option<PathBuf>,
    /// Accept the regressions whose rows match this (`*` matches any text), in the file of --acceptances.
    #[arg(long, value_name = "ROW", requires_all = ["reason", "acceptances"])]
    accept: Option<String>,
    /// Why they are accepted.
    #[arg(long, value_name = "TEXT", requires = "accept")]
    reason: Option<String>,
    /// The last day of the acceptance, YYYY-MM-DD.
    #[arg(long, value_name = "DATE", requires = "accept")]
    until: Option<String>,
    /// A TOML file of accepted regressions.
    #[arg(long, value_name = "FILE")]
    acceptances: Option<PathBuf>,
}

/// Judges the run and writes what is asked for; exit code 1 on a regression.
pub(super) fn compare(
    arguments: &CompareArgs,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let tolerances = tolerances_of(arguments.tolerances.as_deref())?;
    let places: Places = match &arguments.suite {
        Some(suite) => case_places(&Suite::open(suite)?),
        None => Places::new(),
    };
    let source = source(arguments)?;
    let [current, baseline] = compare::sides(&arguments.run, &source)?;
    let mut comparison = compare::compare(&current, &baseline, &tolerances)?;
    if let Some(path) = &arguments.acceptances {
        let today = now("%Y-%m-%d");
        comparison.accept(&Acceptances::read(path)?, &today);
        if let (Some(rows), Some(reason)) = (&arguments.accept, &arguments.reason) {
            let until = arguments.until.as_deref();
            let count = comparison.write_acceptance(path, rows, reason, until)?;
            observer.message(&format!("{count} rows accepted in {}", path.display()));
            comparison.accept(&Acceptances::read(path)?, &today);
        }
    }
    if let Some(path) = &arguments.junit {
        write(path, &comparison.junit(&places)?)?;
    }
    if let Some(path) = &arguments.markdown {
        write(path, &comparison.markdown())?;
    }
    if let Some(path) = &arguments.json {
        write(path, &format!("{:#}\n", comparison.json()))?;
    }
    if let Some(folder) = &arguments.pictures {
        let Some(new) = compare::run_folder(&arguments.run) else {
            return Err(CompareError::NoPictures(arguments.run.clone()).into());
        };
        let old = compare::run_folder(&source);
        report::write_changes(&comparison.findings(), &new, old.as_deref(), folder)?;
    }
    if let Some(path) = &arguments.history {
        comparison.append_history(
            path,
            &now("%Y-%m-%dT%H:%M:%SZ"),
            baseline_branch::head().as_deref(),
        )?;
        if let Some(chart) = &arguments.chart {
            tools.ask(&Request::History { history: path, out: chart })?;
        }
    }
    let mut lines = if arguments.github { comparison.annotations(&places) } else { Vec::new() };
    lines.push(comparison.table().trim_end().to_owned());
    let code = if comparison.passed() { DONE } else { CHECK_FAILED };
    Outcome { code, lines, ..Outcome::default() }.with(&comparison.passed())
}

/// The tolerances of a file, or the built-in ones without a file.
pub(super) fn tolerances_of(path: Option<&Path>) -> Result<Tolerances, CompareError> {
    path.map_or_else(Tolerances::built_in, Tolerances::read)
}

/// The baseline: the file or folder that was named, or the branch's.
fn source(arguments: &CompareArgs) -> Result<PathBuf, RunError> {
    let CompareArgs { baseline, baseline_branch, baselines, .. } = arguments;
    match (baseline, baseline_branch, baselines) {
        (_, Some(branch), Some(folder)) => Ok(baseline_branch::baseline(branch, folder)?),
        // The parser asks for one of the two.
        (baseline, ..) => Ok(baseline.clone().unwrap_or_default()),
    }
}

/// The time in UTC.
fn now(form: &str) -> String {
    chrono::DateTime::<chrono::Utc>::from(SystemTime::now()).format(form).to_string()
}

fn write(path: &Path, text: &str) -> Result<(), RunError> {
    let written = atomic::write_file(path, text.as_bytes());
    written.map_err(|reason| RunError::File { path: path.to_path_buf(), reason })
}
