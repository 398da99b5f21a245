//! Many metrics of one comparison: what they share is measured once.

use std::collections::HashMap;

use rayon::prelude::*;

use super::{Metric, Quantity};

/// Applies `measure` to the quantity of every metric, on all cores. Metrics of one quantity (FLIP's mean and
/// percentile, all of the angle) share it.
pub fn measured<T: Send, E: Send>(
    metrics: &[&'static Metric],
    measure: impl Fn(&'static Metric) -> Result<T, E> + Sync,
) -> Result<HashMap<Quantity, T>, E> {
    let first = |(at, metric): &(usize, &&'static Metric)| {
        metrics.iter().position(|other| other.quantity == metric.quantity) == Some(*at)
    };
    let quantities: Vec<&'static Metric> =
        metrics.iter().enumerate().filter(first).map(|(_, metric)| *metric).collect();
    quantities.into_par_iter().map(|metric| Ok((metric.quantity, measure(metric)?))).collect()
}
