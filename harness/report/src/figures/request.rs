//! The request for a figure.

use std::path::PathBuf;

/// Kinds of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FigureKind {
    /// Relighting in several lights (figure 6 of Rainer et al. 2023).
    Relighting,
    /// Input, re-rendering and maps of each method side by side (figure 8).
    Reflectance,
    /// The Digital Emily matrix (figure 9).
    Emily,
    /// The decomposition under each light (figure 10).
    Decomposition,
    /// The gain of each part of a method (the supplement).
    Ablations,
    /// The gain of a solver that is given parts of the truth, by light.
    Bias,
    /// Quality over exposure, specular reflectance and roughness, by skin type.
    Robustness,
    /// From one method to the next, with what bounds them.
    Waterfall,
    /// The recovered share of the albedo's detail, by its size.
    Detail,
    /// The error against what the capture could determine, and where a method is wrong and sure.
    Observability,
}

/// The figure to draw, its runs and its selection.
#[derive(Clone, Debug)]
pub struct FigureRequest {
    /// The kind of the figure.
    pub kind: FigureKind,
    /// Folders of finished runs.
    pub runs: Vec<PathBuf>,
    /// Only these methods, by their ids; empty stands for those that the figure is usually of.
    pub methods: Vec<String>,
    /// Only these cases, by their ids; empty stands for all.
    pub cases: Vec<String>,
    /// The command that the files name as theirs.
    pub command: String,
}
