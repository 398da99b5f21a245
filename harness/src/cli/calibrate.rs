//! `unshade calibrate`.

use std::path::{Path, PathBuf};

use clap::Args;
use scoring::compare::{Baseline, Calibration, MIN_RUNS, Tolerances};

use super::alone::tools;
use super::exit::{CHECK_FAILED, DONE};
use super::progress::Progress;
use crate::suite::{CalibrationRuns, Observer, RunError, Suite, Vary};

/// How many of the rows that see least are named.
const NAMED: usize = 3;

/// The power below which a row is told.
const POWER: f64 = 0.9;

#[derive(Args)]
pub(super) struct CalibrateArgs {
    /// The suite to repeat: a file, or the name of one that comes with unshade.
    #[arg(required_unless_present = "runs", conflicts_with = "runs")]
    suite: Option<PathBuf>,
    /// The number of runs, each with other seeds.
    #[arg(long, default_value_t = 8, value_name = "N",
          value_parser = clap::value_parser!(u32).range(MIN_RUNS as i64..=1000))]
    seeds: u32,
    /// The seeds to vary: those of renderer and methods; of the methods only, with captures made once (to compare runs
    /// with cached captures); or none, but the last digits of the solver's input.
    #[arg(long, value_enum, default_value_t = Vary::Both, conflicts_with = "runs")]
    vary: Vary,
    /// Finished runs of one suite that differ only in their seeds, instead of a suite.
    #[arg(long, value_name = "RUN", num_args = 1..)]
    runs: Vec<PathBuf>,
    /// The tolerances' file.
    #[arg(short, long)]
    out: PathBuf,
    /// The folder for the runs, one for each seed; by default next to the tolerances.
    #[arg(long, value_name = "DIR", conflicts_with = "runs")]
    keep: Option<PathBuf>,
    /// Also write the means of the runs: a baseline closer to the suite's expected scores than a single
    /// run.
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// The probability that a comparison of runs that differ only in their seeds labels any row better
    /// or worse.
    #[arg(long, default_value_t = 0.01, value_name = "RATE", value_parser = rate)]
    false_alarms: f64,
    /// The smallest changes worth reporting; by default scenes/tolerances.toml.
    #[arg(long, value_name = "FILE")]
    rules: Option<PathBuf>,
}

fn rate(text: &str) -> Result<f64, String> {
    let rate: f64 = text.parse().map_err(|_| "is not a number".to_owned())?;
    // Fewer than ten simulated comparisons decide about less.
    let valid = (0.0005..=0.5).contains(&rate);
    valid.then_some(rate).ok_or_else(|| "is not from 0.0005 to 0.5".to_owned())
}

/// Runs what is not run yet, and writes the tolerances.
pub(super) fn calibrate(arguments: &CalibrateArgs) -> Result<u8, RunError> {
    let rules = match &arguments.rules {
        Some(path) => Tolerances::read(path)?,
        None => Tolerances::built_in()?,
    };
    let folders = match &arguments.suite {
        Some(suite) => match make_runs(suite, arguments)? {
            Ok(folders) => folders,
            Err(code) => return Ok(code),
        },
        None => arguments.runs.clone(),
    };
    let runs: Vec<Baseline> =
        folders.iter().map(|run| Baseline::of_run(run)).collect::<Result<_, _>>()?;
    let calibration = Calibration::of_runs(&runs, &rules, arguments.false_alarms)?;
    if let (Some(path), Some(mean)) = (&arguments.baseline, Baseline::mean(&runs)) {
        mean.write(path)?;
    }
    calibration.write(&arguments.out)?;
    tell(&calibration, runs.first().map_or(0, |run| run.rows.len()));
    say!("{}", arguments.out.display());
    Ok(DONE)
}

/// The runs' folders, or the exit code if a method failed in one.
fn make_runs(
    suite: &Path,
    arguments: &CalibrateArgs,
) -> Result<Result<Vec<PathBuf>, u8>, RunError> {
    let suite = Suite::open(suite)?;
    let beside = || CalibrationRuns::beside(&arguments.out);
    let runs = CalibrationRuns {
        seeds: arguments.seeds,
        vary: arguments.vary,
        keep: arguments.keep.clone().unwrap_or_else(beside),
    };
    let begin = &mut |round| {
        eprintln!("calibrate: run {round} of {}", arguments.seeds);
        Box::new(Progress::new()) as Box<dyn Observer>
    };
    let made = runs.make(&suite, &tools(), begin)?;
    // The observer has told of each failure.
    Ok(made.map_err(|_| CHECK_FAILED))
}

/// Says what the tolerances can see.
fn tell(calibration: &Calibration, rows: usize) {
    let rate = 100.0 * calibration.false_alarms;
    let count = calibration.rows.len();
    let Some(critical) = calibration.critical else {
        say!("{count} rows, none of which depends on the seed");
        return;
    };
    say!(
        "{count} of {rows} rows in {} runs; {rate} % false alarms over all of them at {critical:.1} \
         standard deviations of a difference ({:.1} if every row were on its own)",
        calibration.runs,
        calibration.bonferroni()
    );
    let mut blind: Vec<_> = calibration.rows.iter().filter(|(_, row)| row.power < POWER).collect();
    blind.sort_by(|a, b| (b.1.sees / b.1.matters).total_cmp(&(a.1.sees / a.1.matters)));
    say!(
        "{} rows detect a change worth reporting with probability {POWER} or more, {} do not{}",
        count - blind.len(),
        blind.len(),
        if blind.is_empty() { "" } else { "; the least sensitive:" }
    );
    for (id, row) in blind.iter().take(NAMED) {
        say!("  {id}: {:.4} worth reporting, {:.4} detectable", row.matters, row.sees);
    }
}
