//! Figures, tables, leaderboards and tolerances of finished runs; rounds of sealed suites.

use std::path::PathBuf;

use harness::cli::figure_request;
use harness::suite::{
    self, CalibrationRuns, Observer, RunError, Sealing, Suite, Vary, seal_verify, secret,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use scoring::compare::{Baseline, Calibration, MIN_RUNS, Tolerances};

use super::errors::{named_error, raise};
use super::stages::{RunReporter, watched};
use super::threads::long;

type Heard<'py> = Option<&'py Bound<'py, PyAny>>;

/// Draws a figure of finished runs into a folder.
#[pyfunction]
#[pyo3(signature = (kind, runs, out, methods, cases, progress=None))]
pub(super) fn figure(
    py: Python<'_>,
    kind: &str,
    runs: Vec<PathBuf>,
    out: PathBuf,
    methods: Vec<String>,
    cases: Vec<String>,
    progress: Heard,
) -> PyResult<()> {
    let request = figure_request(kind, runs, methods, cases, &out);
    let request = request.map_err(|reason| named_error("ReportError", &reason))?;
    watched(py, progress, |tools, said| {
        let step = &mut |done, total, what: &str| said.say(done, total, what);
        suite::figure(&request, &out, tools, step)
    })
}

/// Writes the tables of finished runs to a file.
#[pyfunction]
pub(super) fn table(py: Python<'_>, runs: Vec<PathBuf>, out: PathBuf) -> PyResult<()> {
    long(py, || report::write_results(&runs, &out, "unshade.table"))?.map_err(raise)
}

/// Writes the leaderboard of finished runs; returns its page.
#[pyfunction]
pub(super) fn site(py: Python<'_>, runs: Vec<PathBuf>, out: PathBuf) -> PyResult<PathBuf> {
    Ok(long(py, || report::write_site(&runs, &out))?.map_err(raise)?.index)
}

/// Renders the captures of a sealed suite; returns the public key.
#[pyfunction]
#[pyo3(signature = (suite, seeds_from, out, round, jobs, progress=None))]
pub(super) fn seal(
    py: Python<'_>,
    suite: PathBuf,
    seeds_from: PathBuf,
    out: PathBuf,
    round: &str,
    jobs: usize,
    progress: Heard,
) -> PyResult<String> {
    watched(py, progress, |tools, said| {
        let (secret, suite) = (secret(&seeds_from)?, Suite::open(&suite)?);
        let sealing = Sealing { secret: &secret, round, jobs };
        let mut reporter = RunReporter::new(said);
        Ok(suite::seal(&suite, &out, &sealing, tools, &mut reporter)?.public_key)
    })
}

/// Scores a submission to a sealed suite and signs the scores; the cases that failed, and why.
#[pyfunction]
#[pyo3(signature = (submission, private, seeds_from, out, progress=None))]
pub(super) fn score_submission(
    py: Python<'_>,
    submission: PathBuf,
    private: PathBuf,
    seeds_from: PathBuf,
    out: PathBuf,
    progress: Heard,
) -> PyResult<std::collections::BTreeMap<String, String>> {
    watched(py, progress, |tools, said| {
        let secret = secret(&seeds_from)?;
        let mut reporter = RunReporter::new(said);
        suite::score_submission(&submission, &private, &out, &secret, tools, &mut reporter)
    })
}

/// Checks the signature of scores; the public key that signed them.
#[pyfunction]
#[pyo3(signature = (folder, key=None))]
pub(super) fn verify(py: Python<'_>, folder: PathBuf, key: Option<&str>) -> PyResult<String> {
    long(py, || seal_verify(&folder, key))?.map_err(raise)
}

/// Makes tolerances of runs, or of a suite that is run with other seeds.
#[pyfunction]
#[pyo3(signature = (out, suite, runs, seeds, vary, keep, baseline, false_alarms, rules, progress=None))]
#[allow(clippy::too_many_arguments)]
pub(super) fn calibrate(
    py: Python<'_>,
    out: PathBuf,
    suite: Option<PathBuf>,
    runs: Vec<PathBuf>,
    seeds: u32,
    vary: &str,
    keep: Option<PathBuf>,
    baseline: Option<PathBuf>,
    false_alarms: f64,
    rules: Option<PathBuf>,
    progress: Heard,
) -> PyResult<()> {
    let vary = Vary::named(vary).map_err(PyValueError::new_err)?;
    if suite.is_some() && (seeds as usize) < MIN_RUNS {
        return Err(PyValueError::new_err(format!("seeds is {seeds}; give {MIN_RUNS} or more")));
    }
    if !(0.0005..=0.5).contains(&false_alarms) {
        let reason = format!("false_alarms is {false_alarms}; give 0.0005 to 0.5");
        return Err(PyValueError::new_err(reason));
    }
    watched(py, progress, |tools, said| {
        let rules = match &rules {
            Some(path) => Tolerances::read(path)?,
            None => Tolerances::built_in()?,
        };
        let folders = match &suite {
            None => runs,
            Some(suite) => {
                let keep = keep.unwrap_or_else(|| CalibrationRuns::beside(&out));
                let begin = &mut |_| Box::new(RunReporter::new(said)) as Box<dyn Observer + '_>;
                let made = CalibrationRuns { seeds, vary, keep: keep.clone() }.make(
                    &Suite::open(suite)?,
                    tools,
                    begin,
                )?;
                made.map_err(|failed| {
                    let first = failed.into_iter().next();
                    let (name, reason) = first.unwrap_or_default();
                    RunError::Methods { name, reason, report: keep }
                })?
            }
        };
        let runs: Vec<Baseline> =
            folders.iter().map(|run| Baseline::of_run(run)).collect::<Result<_, _>>()?;
        let calibration = Calibration::of_runs(&runs, &rules, false_alarms)?;
        if let (Some(path), Some(mean)) = (&baseline, Baseline::mean(&runs)) {
            mean.write(path)?;
        }
        Ok(calibration.write(&out)?)
    })
}
