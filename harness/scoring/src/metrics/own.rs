//! Metrics that users write: scores state them, and everything that looks a metric up finds them from then on.

use std::sync::PoisonError;

use serde::{Deserialize, Serialize};

use super::quantity::Quantity;
use super::registry::REGISTERED;
use super::statistic::Statistic;
use super::{Direction, METRICS, Metric, MetricError};

/// A metric that is not part of this program, as scores state it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OwnMetric {
    /// As in row ids; lower-case letters, digits and `_`.
    pub id: String,
    /// As in tables.
    pub name: String,
    /// Empty for a pure number.
    pub unit: String,
    /// `higher`, `lower` or `one`: which values are better.
    pub direction: String,
    /// The formula in words.
    pub definition: String,
    /// A link to its definition, or empty.
    pub link: String,
    /// Subjects that it is scored of: `view`, `relit`, or maps.
    pub of: Vec<String>,
}

impl OwnMetric {
    /// Makes the metric known to [`Metric::find`]. An error if its id is that of another one.
    pub fn register(&self) -> Result<&'static Metric, MetricError> {
        let refused = |reason: String| MetricError::Own { id: self.id.clone(), reason };
        let direction = match self.direction.as_str() {
            "higher" => Direction::Higher,
            "lower" => Direction::Lower,
            "one" => Direction::One,
            other => {
                return Err(refused(format!("direction is {other:?}; use higher, lower or one")));
            }
        };
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if self.id.is_empty() || !self.id.chars().all(plain) {
            return Err(refused("the id has other letters than a-z, 0-9 and _".to_owned()));
        }
        if METRICS.iter().any(|metric| metric.id == self.id) {
            return Err(refused("unshade has a metric of this id; choose another".to_owned()));
        }
        let mut known = REGISTERED.write().unwrap_or_else(PoisonError::into_inner);
        if let Some(other) = known.iter().find(|metric| metric.id == self.id) {
            if other.direction != direction || other.unit != self.unit {
                let reason = "another metric of this id has another unit or direction; rename one";
                return Err(refused(reason.to_owned()));
            }
            return Ok(other);
        }
        let text = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
        let metric: &'static Metric = Box::leak(Box::new(Metric {
            id: text(&self.id),
            name: text(&self.name),
            unit: text(&self.unit),
            direction,
            definition: text(&self.definition),
            link: text(&self.link),
            quantity: Quantity::Own,
            statistic: Statistic::Mean,
        }));
        known.push(metric);
        Ok(metric)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stated_metric_is_found_and_another_of_its_id_is_refused() {
        let own = |id: &str, direction: &str| OwnMetric {
            id: id.to_owned(),
            name: "Loveliness".to_owned(),
            unit: "%".to_owned(),
            direction: direction.to_owned(),
            definition: "by eye".to_owned(),
            link: String::new(),
            of: vec!["view".to_owned()],
        };
        assert!(Metric::find("loveliness_seen").is_err());
        let metric = own("loveliness_seen", "higher").register().unwrap();
        assert!(std::ptr::eq(metric, Metric::find("loveliness_seen").unwrap()));
        assert!(own("loveliness_seen", "higher").register().is_ok());
        for (id, direction) in
            [("loveliness_seen", "lower"), ("ssim", "higher"), ("A b", "higher"), ("x", "up")]
        {
            let error = own(id, direction).register().unwrap_err().to_string();
            assert!(error.contains(id) && !error.contains('\n'), "{error}");
        }
    }
}
