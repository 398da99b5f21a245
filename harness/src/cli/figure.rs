//! `unshade figure`.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use report::{FigureKind, FigureRequest};

use super::alone::alone;
use crate::suite::{self, RunError};

#[derive(Args)]
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

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
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
            Self::Robustness => FigureKind::Robustness,
            Self::Waterfall => FigureKind::Waterfall,
            Self::Detail => FigureKind::Detail,
            Self::Observability => FigureKind::Observability,
        }
    }
}

/// The request for a figure by the name of its kind, and the command that makes it; the error names the kinds.
pub fn figure_request(
    kind: &str,
    runs: Vec<PathBuf>,
    methods: Vec<String>,
    cases: Vec<String>,
    out: &Path,
) -> Result<FigureRequest, String> {
    let found = KindName::from_str(kind, false).map_err(|_| {
        let kinds = KindName::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        let kinds: Vec<String> = kinds.map(|kind| kind.get_name().to_owned()).collect();
        format!("figure {kind:?} is unknown; use one of {}", kinds.join(", "))
    })?;
    let mut words = vec![format!("unshade figure {kind}")];
    words.extend(runs.iter().map(|run| run.display().to_string()));
    words.extend(methods.iter().map(|name| format!("--method {name}")));
    words.extend(cases.iter().map(|name| format!("--case {name}")));
    words.push(format!("-o {}", out.display()));
    Ok(FigureRequest { kind: found.kind(), runs, methods, cases, command: words.join(" ") })
}

/// Gathers and draws the figure.
pub(super) fn figure(arguments: &FigureArgs) -> Result<(), RunError> {
    let FigureArgs { kind, runs, out, method, case } = arguments;
    let name = kind.to_possible_value().map_or(String::new(), |name| name.get_name().to_owned());
    let request = figure_request(&name, runs.clone(), method.clone(), case.clone(), out);
    // The parser lets no other kind through.
    let Ok(request) = request else { return Ok(()) };
    alone("figure", |tools, step| suite::figure(&request, out, tools, step))?;
    say!("{}", out.join("figure.png").display());
    Ok(())
}
