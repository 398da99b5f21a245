//! `unshade run`.

use std::ops::Deref;
use std::time::Instant;

use report::ReportError;

use super::arguments::RunArgs;
use super::exit::{CHECK_FAILED, DONE};
use super::outcome::Outcome;
use crate::suite::{self, Cluster, Observer, RunError, RunOptions, Suite};
use crate::synth::Tools;

pub(super) fn run_suite(
    arguments: RunArgs,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let suite = Suite::open(&arguments.suite)?.only(arguments.methods, arguments.cases)?;
    let jobs = usize::from(arguments.jobs);
    let store = arguments.store;
    let cluster = arguments.cluster.map(|address| Cluster { address, store, workers: jobs });
    // Outputs of a cluster are only read here.
    let options = RunOptions {
        redo: arguments.redo,
        jobs: if cluster.is_some() { 1 } else { jobs },
        cluster,
    };
    if arguments.dry_run {
        let forecast = suite::forecast(&suite, &arguments.out, &arguments.costs, &options, tools)?;
        return Ok(Outcome::line(forecast));
    }
    let start = Instant::now();
    let run = arguments.out;
    let summary = suite::run(&suite, &run, &options, tools, observer)?;
    let seconds = start.elapsed().as_secs_f64();
    match report::means_in_lines(&[run]) {
        Ok(lines) => lines.iter().for_each(|line| observer.message(line)),
        // Every method failed, which is said below.
        Err(ReportError::NoScores(_)) => {}
        Err(error) => return Err(error.into()),
    }
    let (ran, skipped) = (summary.ran, summary.skipped);
    observer.message(&format!("{ran} stages run, {skipped} still valid, {seconds:.0} s"));
    let count = summary.failed.len();
    if count > 0 {
        // Each reason was shown when it arose.
        let reasons = "the reasons are above and in the report";
        observer.message(&format!("unshade: {count} failed; {reasons}"));
    }
    let failure = summary.failed.into_iter().next().map(|(name, reason)| RunError::Methods {
        name,
        reason,
        report: summary.report.clone(),
    });
    let code = if failure.is_some() { CHECK_FAILED } else { DONE };
    Ok(Outcome { code, failure, ..Outcome::line(summary.report.display()) })
}
