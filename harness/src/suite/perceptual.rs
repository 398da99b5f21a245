//! LPIPS of a method's pictures: a network's judgement, by the Python package of its authors.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::Path;

use scoring::score::{self, Row, Shown};

use super::error::RunError;
use super::tools::Tools;
use crate::synth::{cli_args, run_stage};

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

fn judge(net: &str, shown: &[Shown], tools: &Tools) -> Result<Vec<f64>, RunError> {
    let mut file = tempfile::Builder::new().prefix("unshade-").suffix(".json").tempfile()?;
    file.write_all(&serde_json::to_vec(shown).map_err(io::Error::other)?)?;
    let arguments =
        cli_args(&[("--net", OsStr::new(net)), ("--pictures", file.path().as_os_str())]);
    let silent = &mut |_, _, _: &str| {};
    let said = run_stage(&tools.interpreter, "lpips", &arguments, &tools.interrupt, silent)?;
    let values: Vec<f64> =
        serde_json::from_value(said["values"].clone()).map_err(io::Error::other)?;
    Ok(values)
}
