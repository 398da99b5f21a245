//! The spread of scores, from runs that differ in their seeds alone.

use std::collections::BTreeMap;

use super::CompareError;
use super::baseline::Baseline;
use super::calibration::{Calibration, MIN_RELATIVE_SD, MIN_RUNS};
use super::row_id::RowId;
use super::spread::{Column, SIMULATIONS, TAILS, critical, deviation};
use super::tolerance::Tolerances;
use crate::metrics::Direction;

/// Seed of the simulated comparisons.
const SEED: u64 = 39;

impl Calibration {
    /// Measures the spread over `runs` of one suite, of which each row must have a value in every one.
    pub fn of_runs(
        runs: &[Baseline],
        tolerances: &Tolerances,
        false_alarms: f64,
    ) -> Result<Self, CompareError> {
        let Some(first) = runs.first().filter(|_| runs.len() >= MIN_RUNS) else {
            return Err(CompareError::FewRuns { runs: runs.len(), minimum: MIN_RUNS });
        };
        if let Some(other) = runs.iter().find(|run| run.suite != first.suite) {
            let (run, baseline) = (other.suite.clone(), first.suite.clone());
            return Err(CompareError::Suites { run, baseline });
        }
        let mut columns = Vec::new();
        let mut measured = Vec::new();
        for id in first.rows.keys() {
            let values: Option<Vec<f64>> =
                runs.iter().map(|run| run.rows.get(id).and_then(|entry| entry.value)).collect();
            let Some(mut values) = values else { continue };
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let mut matters = tolerances.rule(id)?.allowed(mean);
            let error = RowId::parse(id)?.metric.direction == Direction::Lower;
            let relative = error && values.iter().all(|value| *value > 0.0);
            if relative {
                values.iter_mut().for_each(|value| *value = value.ln());
                matters = (matters / mean).ln_1p();
            }
            columns.extend(Column::new(&values, MIN_RELATIVE_SD * matters));
            measured.push((id.clone(), relative, deviation(&values), matters));
        }
        let mut calibration = Self {
            suite: first.suite.clone(),
            suite_hash: first.suite_hash.clone(),
            captures: Baseline::captures_in_all(runs),
            versions: first.versions.clone(),
            runs: runs.len(),
            false_alarms,
            critical: critical(&columns, false_alarms, Some(TAILS), SIMULATIONS, SEED),
            rows: BTreeMap::new(),
        };
        for (id, relative, sd, matters) in measured {
            let row = calibration.spread(relative, sd, matters);
            calibration.rows.insert(id, row);
        }
        Ok(calibration)
    }
}
