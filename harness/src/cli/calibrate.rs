//! `unshade calibrate`.

use std::ops::{Deref, RangeInclusive};
use std::path::PathBuf;

use clap::Args;
use scoring::compare::{Baseline, Calibration, MIN_RUNS};
use serde::Deserialize;

use super::compare::tolerances_of;
use super::exit::CHECK_FAILED;
use super::outcome::Outcome;
use crate::suite::{CalibrationRuns, Observer, RunError, Suite, Vary};
use crate::synth::Tools;

/// How many of the rows that see least are named.
const NAMED: usize = 3;

/// The power below which a row is told.
const POWER: f64 = 0.9;

#[derive(Args, Deserialize)]
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

/// Rates of false alarms that a calibration can aim at.
const RATES: RangeInclusive<f64> = 0.0005..=0.5;

fn rate(text: &str) -> Result<f64, String> {
    let rate: f64 = text.parse().map_err(|_| "is not a number".to_owned())?;
    // Fewer than ten simulated comparisons decide about less.
    RATES.contains(&rate).then_some(rate).ok_or_else(|| "is not from 0.0005 to 0.5".to_owned())
}

/// Runs what is not run yet, and writes the tolerances.
pub(super) fn calibrate(
    arguments: &CalibrateArgs,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let CalibrateArgs { seeds, vary, out, keep, false_alarms, .. } = arguments;
    if arguments.suite.is_some() && (*seeds as usize) < MIN_RUNS {
        return Err(RunError::Argument(format!("seeds is {seeds}; give {MIN_RUNS} or more")));
    }
    if !RATES.contains(false_alarms) {
        let reason = format!("false_alarms is {false_alarms}; give 0.0005 to 0.5");
        return Err(RunError::Argument(reason));
    }
    let rules = tolerances_of(arguments.rules.as_deref())?;
    let folders = match &arguments.suite {
        None => arguments.runs.clone(),
        Some(suite) => {
            let keep = keep.clone().unwrap_or_else(|| CalibrationRuns::beside(out));
            let runs = CalibrationRuns { seeds: *seeds, vary: *vary, keep: keep.clone() };
            match runs.make(&Suite::open(suite)?, tools, observer)? {
                Ok(folders) => folders,
                Err(failed) => {
                    let (name, reason) = failed.into_iter().next().unwrap_or_default();
                    let failure = Some(RunError::Methods { name, reason, report: keep });
                    return Ok(Outcome { code: CHECK_FAILED, failure, ..Outcome::default() });
                }
            }
        }
    };
    let runs: Vec<Baseline> =
        folders.iter().map(|run| Baseline::of_run(run)).collect::<Result<_, _>>()?;
    let calibration = Calibration::of_runs(&runs, &rules, *false_alarms)?;
    if let (Some(path), Some(mean)) = (&arguments.baseline, Baseline::mean(&runs)) {
        mean.write(path)?;
    }
    calibration.write(out)?;
    let mut lines = summary(&calibration, runs.first().map_or(0, |run| run.rows.len()));
    lines.push(out.display().to_string());
    Ok(Outcome { lines, ..Outcome::default() })
}

/// States the changes that the tolerances detect.
fn summary(calibration: &Calibration, rows: usize) -> Vec<String> {
    let rate = 100.0 * calibration.false_alarms;
    let count = calibration.rows.len();
    let Some(critical) = calibration.critical else {
        return vec![format!("{count} rows, none of which depends on the seed")];
    };
    let mut lines = vec![format!(
        "{count} of {rows} rows in {} runs; {rate} % false alarms over all of them at {critical:.1} \
         standard deviations of a difference ({:.1} if every row were on its own)",
        calibration.runs,
        calibration.bonferroni()
    )];
    let mut blind: Vec<_> = calibration.rows.iter().filter(|(_, row)| row.power < POWER).collect();
    blind.sort_by(|a, b| (b.1.sees / b.1.matters).total_cmp(&(a.1.sees / a.1.matters)));
    lines.push(format!(
        "{} rows detect a change worth reporting with probability {POWER} or more, {} do not{}",
        count - blind.len(),
        blind.len(),
        if blind.is_empty() { "" } else { "; the least sensitive:" }
    ));
    let named = blind.iter().take(NAMED);
    lines.extend(named.map(|(id, row)| {
        format!("  {id}: {:.4} worth reporting, {:.4} detectable", row.matters, row.sees)
    }));
    lines
}
