//! The figures of a paper, from finished runs: panels as PNG, the numbers behind them as CSV, LaTeX that
//! includes both, and a description that `unshade.figures` draws as one PNG and PDF.

mod ablations;
mod crop;
mod decomposition;
mod detail;
mod drawing;
mod emily;
mod mesh_scale;
mod observability;
mod panels;
mod quantity;
mod reflectance;
mod relighting;
mod request;
mod robustness;
mod source;
mod statistics;
#[cfg(test)]
mod tests;
mod waterfall;

use std::path::{Path, PathBuf};

use formats::atomic;

use super::error::ReportError;
use super::save::{write_file, write_folder};
use drawing::Drawing;
pub use request::{FigureKind, FigureRequest};
use source::Sources;

/// Writes the figure's folder `out`. `draw` makes `figure.png` and `figure.pdf` of the `figure.json` in the folder
/// that it is given, before that folder takes its place.
pub fn write_figure<E: From<ReportError>>(
    request: &FigureRequest,
    out: &Path,
    draw: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    let runs: Vec<&Path> = request.runs.iter().map(PathBuf::as_path).collect();
    atomic::refuse_overlap(out, &runs).map_err(ReportError::from)?;
    let sources = Sources::read(request)?;
    write_folder(out, |folder| {
        fill(request, &sources, folder)?;
        draw(folder)
    })
}

fn fill(request: &FigureRequest, sources: &Sources, root: &Path) -> Result<(), ReportError> {
    let mut drawing = Drawing::new(root);
    match request.kind {
        FigureKind::Relighting => relighting::draw(sources, &mut drawing),
        FigureKind::Reflectance => reflectance::draw(sources, &mut drawing),
        FigureKind::Emily => emily::draw(sources, &mut drawing),
        FigureKind::Decomposition => decomposition::draw(sources, &mut drawing),
        FigureKind::Ablations => ablations::draw(sources, &mut drawing),
        FigureKind::Bias => ablations::draw_bias(sources, &mut drawing),
        FigureKind::Robustness => robustness::draw(sources, &mut drawing),
        FigureKind::Waterfall => waterfall::draw(sources, &mut drawing),
        FigureKind::Detail => detail::draw(sources, &mut drawing),
        FigureKind::Observability => observability::draw(sources, &mut drawing),
    }?;
    drawing.caption.push_str(&sources.interrupted()?);
    write_file(&root.join("figure.csv"), drawing.csv())?;
    write_file(&root.join("figure.tex"), drawing.latex(&request.command))?;
    write_file(&root.join("figure.json"), drawing.json()?)
}
