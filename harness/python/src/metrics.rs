//! `unshade.metrics`.

use std::collections::HashMap;

use formats::picture::{GrayImage, Picture};
use numpy::PyArray3;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scoring::metrics::{
    METRICS, Metric, MetricError, Pair, Region, Scale, ScaleMode, black_outside, measured,
};

use super::arrays::Argument;
use super::errors::{named_error, raise};
use super::pictures::array;
use super::threads::detached;

/// (id, name, unit, direction, definition, link, needs) of every metric; `needs` is the argument
/// that it takes beside prediction, truth and mask, or empty.
#[pyfunction]
pub(super) fn metric_definitions() -> Vec<[&'static str; 7]> {
    let row = |m: &Metric| {
        let needs = m.quantity.needs().unwrap_or_default();
        [m.id, m.name, m.unit, m.direction.symbol(), m.definition, m.link, needs]
    };
    METRICS.iter().map(row).collect()
}

fn argument(name: &str) -> Argument<'_> {
    Argument { name, class: "MetricError" }
}

/// Metrics of a prediction against its truth inside a mask; None where one is not defined. What lies
/// outside the mask is as good as black, as in scores. `beside` holds what the metrics need.
#[pyfunction]
#[pyo3(signature = (metrics, prediction, truth, mask=None, *, erode=false, scale="none",
                    beside=None))]
#[allow(clippy::too_many_arguments)]
pub(super) fn measure(
    py: Python<'_>,
    metrics: Vec<String>,
    prediction: &Bound<PyAny>,
    truth: &Bound<PyAny>,
    mask: Option<&Bound<PyAny>>,
    erode: bool,
    scale: &str,
    beside: Option<&Bound<PyDict>>,
) -> PyResult<Vec<Option<f64>>> {
    let metrics: Vec<&'static Metric> =
        metrics.iter().map(|id| Metric::find(id)).collect::<Result<_, _>>().map_err(raise)?;
    let compared = Compared::new(prediction, truth, mask, scale)?;
    let truth = &compared.truth;
    let needed = |name: &str| metrics.iter().any(|metric| metric.quantity.needs() == Some(name));
    let given = |name: &str| match beside.filter(|_| needed(name)) {
        Some(beside) => Ok(beside.get_item(name)?.filter(|value| !value.is_none())),
        None => Ok::<_, PyErr>(None),
    };
    let labels = given("labels")?.map(|given| argument("labels").bytes(&given)).transpose()?;
    if let Some(labels) = &labels {
        check_size("labels", (labels.width, labels.height), truth)?;
    }
    let mut pictures = HashMap::new();
    for name in ["shading", "specular", "mesh_normal", "confidence", "deviation", "area"] {
        let Some(given) = given(name)? else { continue };
        let picture = argument(name).picture(&given)?;
        check_size(name, (picture.width, picture.height), truth)?;
        let fits = if matches!(name, "confidence" | "area") { &[1][..] } else { &[1, 3] };
        if !fits.contains(&picture.channels) {
            let reason = format!("has {} channels, expected {fits:?}", picture.channels);
            return Err(argument(name).refused(&reason));
        }
        pictures.insert(name, picture);
    }
    let halves = given("halves")?.map(|given| halves(&given, truth)).transpose()?;
    let inputs = Inputs { labels, pictures, halves };
    detached(py, || values(&metrics, &compared, erode, &inputs))?.map_err(raise)
}

/// The pictures as they are looked at: sRGB values in [0, 1], black outside the region, float32 of the
/// truth's shape.
#[pyfunction]
#[pyo3(signature = (prediction, truth, mask=None, *, erode=false, scale="none"))]
pub(super) fn shown<'py>(
    py: Python<'py>,
    prediction: &Bound<PyAny>,
    truth: &Bound<PyAny>,
    mask: Option<&Bound<PyAny>>,
    erode: bool,
    scale: &str,
) -> PyResult<[Bound<'py, PyArray3<f32>>; 2]> {
    let compared = Compared::new(prediction, truth, mask, scale)?;
    let region = compared.region(erode).map_err(raise)?;
    let [prediction, truth] = compared.pair(&region).map_err(raise)?.shown();
    Ok([array(py, prediction)?, array(py, truth)?])
}

/// Arguments that all metrics have.
struct Compared {
    prediction: Picture,
    truth: Picture,
    mask: Option<GrayImage>,
    mode: ScaleMode,
}

impl Compared {
    fn new(
        prediction: &Bound<PyAny>,
        truth: &Bound<PyAny>,
        mask: Option<&Bound<PyAny>>,
        scale: &str,
    ) -> PyResult<Self> {
        let mode = ScaleMode::ALL.into_iter().find(|mode| mode.id() == scale).ok_or_else(|| {
            let reason = format!("no scale mode {scale:?}: none, global, channel, median");
            named_error("MetricError", &reason)
        })?;
        let mut prediction = argument("prediction").picture(prediction)?;
        let mut truth = argument("truth").picture(truth)?;
        if (prediction.height, prediction.width, prediction.channels)
            != (truth.height, truth.width, truth.channels)
        {
            let shape = |picture: &Picture| match picture.channels {
                1 => format!("({}, {})", picture.height, picture.width),
                channels => format!("({}, {}, {channels})", picture.height, picture.width),
            };
            let reason = format!(
                "has shape {}, expected {}, as the truth",
                shape(&prediction),
                shape(&truth)
            );
            return Err(argument("prediction").refused(&reason));
        }
        let mask = match mask {
            Some(mask) => {
                let mask = argument("mask").mask(mask)?;
                check_size("mask", (mask.width, mask.height), &truth)?;
                for picture in [&mut prediction, &mut truth] {
                    *picture = black_outside(picture, &mask);
                }
                Some(mask)
            }
            None => None,
        };
        Ok(Self { prediction, truth, mask, mode })
    }

    fn region(&self, erode: bool) -> Result<Region, MetricError> {
        let (width, height) = (self.truth.width, self.truth.height);
        let whole = GrayImage { width, height, data: vec![255; width * height] };
        match (&self.mask, erode) {
            (None, false) => Region::whole(width, height),
            (mask, true) => Region::eroded("mask", mask.as_ref().unwrap_or(&whole)),
            (Some(mask), false) => Region::of_mask("mask", mask),
        }
    }

    fn pair<'a>(&'a self, region: &'a Region) -> Result<Pair<'a>, MetricError> {
        let pair = Pair::new(&self.prediction, &self.truth, region)?;
        if self.mode == ScaleMode::None {
            return Ok(pair);
        }
        let factors = Scale::fit(&pair)?.factors(self.mode);
        Ok(pair.scaled(factors))
    }
}

/// Inputs of some metrics beside prediction and truth.
struct Inputs {
    labels: Option<GrayImage>,
    pictures: HashMap<&'static str, Picture>,
    halves: Option<[Picture; 2]>,
}

impl Inputs {
    /// The pair with what a metric needs, as far as it is given.
    fn beside<'a>(&'a self, pair: Pair<'a>, metric: &Metric) -> Result<Pair<'a>, MetricError> {
        let Some(name) = metric.quantity.needs() else { return Ok(pair) };
        match (name, &self.labels, &self.halves, self.pictures.get(name)) {
            ("labels", Some(labels), ..) => pair.with_labels(labels),
            ("halves", _, Some([prediction, truth]), _) => pair.with_halves(prediction, truth),
            ("confidence", .., Some(confidence)) => pair.with_confidence(confidence),
            ("deviation", .., Some(deviation)) => pair.with_deviation(deviation),
            ("area", .., Some(area)) => pair.with_area(area),
            ("shading" | "specular" | "mesh_normal", .., Some(cause)) => pair.with_cause(cause),
            _ => Ok(pair),
        }
    }
}

/// The halves of prediction and truth: a pair of pictures of the truth's shape.
fn halves(given: &Bound<PyAny>, truth: &Picture) -> PyResult<[Picture; 2]> {
    let refused =
        || argument("halves").refused("is not a pair (half of the prediction, of the truth)");
    let pair: Vec<Bound<PyAny>> = given.extract().map_err(|_| refused())?;
    let [p, g]: [Bound<PyAny>; 2] = pair.try_into().map_err(|_| refused())?;
    let picture = |given: &Bound<PyAny>| {
        let half = argument("halves").picture(given)?;
        check_size("halves", (half.width, half.height), truth)?;
        Ok::<_, PyErr>(half)
    };
    Ok([picture(&p)?, picture(&g)?])
}

fn values(
    metrics: &[&'static Metric],
    compared: &Compared,
    erode: bool,
    inputs: &Inputs,
) -> Result<Vec<Option<f64>>, MetricError> {
    let region = compared.region(erode)?;
    let pair = compared.pair(&region)?;
    let measured =
        measured(metrics, |metric| metric.measure(&inputs.beside(pair.clone(), metric)?))?;
    let value = |metric: &&Metric| metric.statistic.value([measured[&metric.quantity].as_slice()]);
    Ok(metrics.iter().map(value).collect())
}

fn check_size(name: &str, (width, height): (usize, usize), truth: &Picture) -> PyResult<()> {
    if (width, height) == (truth.width, truth.height) {
        return Ok(());
    }
    let transposed = (height, width) == (truth.width, truth.height);
    let fix = if transposed { "; transpose it" } else { "" };
    let reason = format!(
        "has shape ({height}, {width}), expected ({}, {}), as the truth{fix}",
        truth.height, truth.width
    );
    Err(argument(name).refused(&reason))
}
