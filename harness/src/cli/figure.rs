//! `unshade figure`.

use std::ops::Deref;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use report::{FigureKind, FigureRequest};
use serde::Deserialize;

use super::alone::alone;
use super::command_line::{command_line, name_of};
use super::outcome::Outcome;
use crate::suite::{self, Observer, RunError};
use crate::synth::Tools;

#[derive(Args, Deserialize)]
pub(super) struct FigureArgs {
    /// The figure to draw.
    #[arg(value_enum)]
    kind: KindName,
    /// The folders of finished runs.
    #[arg(required = true)]
    runs: Vec<PathBuf>,
    /// The figure's folder.
    #[arg(short, long)]
    out: PathBuf,
    /// Only this method, by its name in the suite; may be repeated.
    #[arg(long, value_name = "NAME")]
    method: Vec<String>,
    /// Only this case, by its name in the report; may be repeated.
    #[arg(long, value_name = "NAME")]
    case: Vec<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum KindName {
    /// Relighting in several lights.
    Fig6,
    /// Reflectance side by side.
    Fig8,
    /// The Digital Emily matrix.
    Fig9,
    /// The decomposition under each light.
    Fig10,
    /// The gain of each method or variant over the first one.
    Ablations,
    /// The gain of a solver that is given parts of the truth, by light.
    Bias,
    /// Albedo and relighting over exposure, specular reflectance and roughness, by skin.
    Robustness,
    /// The gain from one method to the next, with the flat map and the oracle as bounds.
    Waterfall,
    /// The recovered share of the albedo's detail, by spatial frequency.
    Detail,
    /// The error against the observability of each texel, and texels that are wrong with high confidence.
    Observability,
}

impl KindName {
    fn kind(self) -> FigureKind {
        match self {
            Self::Fig6 => FigureKind::Relighting,
            Self::Fig8 => FigureKind::Reflectance,
            Self::Fig9 => FigureKind::Emily,
            Self::Fig10 => FigureKind::Decomposition,
            Self::Ablations => FigureKind::Ablations,
            Self::Bias => FigureKind::Bias,
            Self::Robustness => FigureKind::Robustness,
            Self::Waterfall => FigureKind::Waterfall,
            Self::Detail => FigureKind::Detail,
            Self::Observability => FigureKind::Observability,
        }
    }
}

/// Gathers and draws the figure.
pub(super) fn figure(
    arguments: &FigureArgs,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let FigureArgs { kind, runs, out, method, case } = arguments;
    let methods = method.iter().map(|name| format!("--method {name}"));
    let options: Vec<String> =
        methods.chain(case.iter().map(|name| format!("--case {name}"))).collect();
    let name = format!("figure {}", name_of(kind));
    let request = FigureRequest {
        kind: kind.kind(),
        runs: runs.clone(),
        methods: method.clone(),
        cases: case.clone(),
        command: command_line(&name, runs, &options, Some(out)),
    };
    alone("figure", observer, |step| suite::figure(&request, out, tools, step))?;
    Ok(Outcome::line(out.join("figure.png").display()))
}
