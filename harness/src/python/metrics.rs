//! `unshade.metrics`.

use numpy::PyReadonlyArrayDyn;
use pyo3::prelude::*;
use solver::picture::GrayImage;

use super::arrays::{mask_from_array, picture_from_array};
use super::errors::{named_error, raise};
use crate::metrics::{METRICS, Metric, Pair, Region, Scale, ScaleMode};

/// (id, name, unit, direction, definition, link) of every metric.
#[pyfunction]
pub(super) fn metric_definitions() -> Vec<[&'static str; 6]> {
    let row = |m: &Metric| [m.id, m.name, m.unit, m.direction.symbol(), m.definition, m.link];
    METRICS.iter().map(row).collect()
}

/// One metric of a prediction against its truth inside a mask; None where it is not defined.
#[pyfunction]
#[pyo3(signature = (metric, prediction, truth, mask=None, *, erode=false, scale="none"))]
pub(super) fn measure(
    metric: &str,
    prediction: PyReadonlyArrayDyn<f32>,
    truth: PyReadonlyArrayDyn<f32>,
    mask: Option<PyReadonlyArrayDyn<bool>>,
    erode: bool,
    scale: &str,
) -> PyResult<Option<f64>> {
    let metric = Metric::find(metric).map_err(raise)?;
    let prediction = picture_from_array("prediction", &prediction)?;
    let truth = picture_from_array("truth", &truth)?;
    let (width, height) = (truth.width, truth.height);
    let region = match mask {
        None => Region::whole(width, height),
        Some(mask) => {
            let inside = mask_from_array("mask", &mask)?;
            if inside.len() != width * height {
                let reason =
                    format!("mask: has {} pixels, the truth {height} x {width}", inside.len());
                return Err(named_error("MetricError", &reason));
            }
            let data = inside.into_iter().map(|inside| if inside { 255 } else { 0 }).collect();
            let mask = GrayImage { width, height, data };
            if erode { Region::eroded("mask", &mask) } else { Region::of_mask("mask", &mask) }
        }
    };
    let region = region.map_err(raise)?;
    let pair = Pair::new(&prediction, &truth, &region).map_err(raise)?;
    let mode = ScaleMode::ALL.into_iter().find(|mode| mode.id() == scale).ok_or_else(|| {
        named_error(
            "MetricError",
            &format!("no scale mode {scale:?}: none, global, channel, median"),
        )
    })?;
    let pair = match mode {
        ScaleMode::None => pair,
        mode => {
            let factors = Scale::fit(&pair).map_err(raise)?.factors(mode);
            pair.scaled(factors)
        }
    };
    metric.value(&pair).map_err(raise)
}
