//! LPIPS of a method's pictures: a network's judgement, by the Python package of its authors.

use std::io;
use std::path::Path;

use scoring::score::{self, Row, Shown};

use super::error::RunError;
use crate::synth::Request;
use crate::synth::Tools;

/// Rows of the withheld views and relit pictures that [`score::score`] compares, by the network `net`.
pub fn lpips(
    net: &str,
    capture: &Path,
    maps: &Path,
    relit: Option<&Path>,
    tools: &Tools,
) -> Result<Vec<Row>, RunError> {
    let shown = score::shown(capture, maps, relit)?;
    let values: Vec<Option<f64>> = judge(net, &shown, tools)?.into_iter().map(Some).collect();
    Ok(score::judged_rows(capture, &shown, &format!("lpips_{net}_0_1"), &values)?)
}

/// Checks that the package and the weights of `net` are there, or can be fetched.
pub(super) fn require(net: &str, tools: &Tools) -> Result<(), RunError> {
    judge(net, &[], tools).map(|_| ())
}

fn judge(net: &str, pictures: &[Shown], tools: &Tools) -> Result<Vec<f64>, RunError> {
    let answer = tools.ask(&Request::Lpips { net, pictures })?;
    Ok(serde_json::from_value(answer["values"].clone()).map_err(io::Error::other)?)
}
