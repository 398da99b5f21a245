//! `unshade run`.

use std::time::Instant;

use super::alone::tools;
use super::arguments::RunArgs;
use super::exit::{CHECK_FAILED, DONE};
use super::progress::Progress;
use crate::suite::{self, Cluster, RunError, RunOptions, Suite};

pub(super) fn run_suite(arguments: RunArgs) -> Result<u8, RunError> {
    let suite = Suite::open(&arguments.suite)?.only(arguments.methods, arguments.cases)?;
    let jobs = usize::from(arguments.jobs);
    if arguments.dry_run {
        say!("{}", suite::forecast(&suite, &arguments.out, &arguments.costs, jobs, &tools())?);
        return Ok(DONE);
    }
    let store = arguments.store;
    let cluster = arguments.cluster.map(|address| Cluster { address, store, workers: jobs });
    // What comes back is only read here.
    let options = RunOptions {
        redo: arguments.redo,
        jobs: if cluster.is_some() { 1 } else { jobs },
        cluster,
    };
    let mut progress = Progress::new();
    let start = Instant::now();
    let summary = suite::run(&suite, &arguments.out, &options, &tools(), &mut progress);
    progress.finish();
    let summary = summary?;
    let seconds = start.elapsed().as_secs_f64();
    let (ran, skipped) = (summary.ran, summary.skipped);
    eprintln!("{ran} stages run, {skipped} still valid, {seconds:.0} s");
    say!("{}", summary.report.display());
    // Each reason was printed when it arose.
    if !summary.failed.is_empty() {
        eprintln!(
            "unshade: {} failed; the reasons are above and in the report",
            summary.failed.len()
        );
    }
    Ok(if summary.failed.is_empty() { DONE } else { CHECK_FAILED })
}
