//! The Digital Emily matrix (figure 9 of Rainer et al. 2023): one face captured in several
//! lights; for each input light the withheld view by the method itself, relit in the same
//! light, and relit in the others, each with its error picture and numbers.

use scoring::metrics::METRICS;
use scoring::score::FOUND_LIGHT;
use serde::Serialize;

use super::comparison_figures::{ComparisonFigure, Tile};
use super::run::Kind;
use super::table::{self, Column};

/// The numbers below each panel.
const FIGURE_METRICS: [&str; 3] = ["psnr_srgb", "ssim", "flip_mean"];

/// Inputs of the matrix from one case.
pub(super) struct Source<'a> {
    pub face: &'a str,
    pub variant: Option<&'a str>,
    pub light: &'a str,
    pub columns: &'a [Column<'a>],
    pub figures: &'a [ComparisonFigure],
    pub input: Option<&'a Tile>,
}

/// The matrix of one face.
#[derive(Debug, Serialize)]
pub(super) struct Matrix {
    pub face: String,
    pub variant: Option<String>,
    pub frame: String,
    pub top: String,
    pub error: &'static str,
    pub blocks: Vec<Block>,
}

/// One input light.
#[derive(Debug, Serialize)]
pub(super) struct Block {
    pub light: String,
    pub input: Option<Tile>,
    /// The source of the pictures of each panel, and the truth that they are compared with.
    pub panels: Vec<Panel>,
    /// One per method: pictures for the solvers, numbers for all.
    pub rows: Vec<MatrixRow>,
}

#[derive(Debug, Serialize)]
pub(super) struct Panel {
    pub title: String,
    pub truth: Tile,
}

#[derive(Debug, Serialize)]
pub(super) struct MatrixRow {
    pub title: String,
    pub kind: &'static str,
    /// One per panel.
    pub cells: Vec<MatrixCell>,
}

#[derive(Debug, Serialize)]
pub(super) struct MatrixCell {
    pub picture: Option<Tile>,
    pub error: Option<Tile>,
    pub numbers: Vec<Number>,
}

#[derive(Debug, Serialize)]
pub(super) struct Number {
    pub name: &'static str,
    pub value: String,
    pub interval: String,
}

/// A matrix for every face that was captured in more than one light, variant by variant.
pub(super) fn matrices(cases: &[Source]) -> Vec<Matrix> {
    let mut groups: Vec<Vec<&Source>> = Vec::new();
    // Photographs have no light that another capture could be relit in.
    for case in cases.iter().filter(|case| case.light != FOUND_LIGHT) {
        let same = |group: &&mut Vec<&Source>| {
            (group[0].face, group[0].variant) == (case.face, case.variant)
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(case),
            None => groups.push(vec![case]),
        }
    }
    groups.iter().filter_map(|cases| matrix(cases)).collect()
}

fn matrix(cases: &[&Source]) -> Option<Matrix> {
    let lights: Vec<&str> = cases.iter().map(|case| case.light).collect();
    if lights.len() < 2 {
        return None;
    }
    let source = cases.first()?;
    let first = source.figures.iter().find(|figure| figure.id.starts_with("relit-"))?;
    Some(Matrix {
        face: source.face.to_owned(),
        variant: source.variant.map(str::to_owned),
        frame: first.strips.first()?.title.clone(),
        top: first.top.clone(),
        error: first.error,
        blocks: cases.iter().map(|case| block(case, &lights)).collect(),
    })
}

fn block(case: &Source, lights: &[&str]) -> Block {
    // Title of the panel, and the subject and light of its figure and numbers.
    let mut kinds = vec![
        ("View synthesis, same light".to_owned(), "view", None),
        ("Maps relit, same light".to_owned(), "relit", Some(case.light)),
    ];
    for light in lights.iter().filter(|light| **light != case.light) {
        kinds.push((format!("Maps relit, opposite light: {light}"), "relit", Some(light)));
    }
    let mut panels = Vec::new();
    let mut rows: Vec<MatrixRow> = case
        .columns
        .iter()
        .map(|column| MatrixRow {
            title: column.method.title().to_owned(),
            kind: column.method.role(),
            cells: Vec::new(),
        })
        .collect();
    for (title, subject, light) in kinds {
        let figure = case
            .figures
            .iter()
            .find(|figure| figure.subject.0 == subject && figure.subject.1.as_deref() == light);
        let Some(strip) = figure.and_then(|figure| figure.strips.first()) else { continue };
        panels.push(Panel { title, truth: strip.truth.clone() });
        for ((row, column), entry) in rows.iter_mut().zip(case.columns).zip(&strip.entries) {
            let pictured = column.method.kind == Kind::Solver;
            row.cells.push(MatrixCell {
                picture: entry.picture.clone().filter(|_| pictured),
                error: entry.errors.first().cloned().flatten().filter(|_| pictured),
                numbers: numbers(column, subject, light),
            });
        }
    }
    Block { light: case.light.to_owned(), input: case.input.cloned(), panels, rows }
}

/// The image metrics over all withheld views, relit pictures after the one factor.
fn numbers(column: &Column, subject: &str, light: Option<&str>) -> Vec<Number> {
    let scale = if light.is_some() { "global" } else { "none" };
    let metrics = METRICS.iter().filter(|metric| FIGURE_METRICS.contains(&metric.id));
    metrics
        .filter_map(|metric| {
            let row = column.find(subject, light, metric.id, scale)?;
            let decimals = table::decimals(metric.unit, row.value.into_iter());
            Some(Number {
                name: metric.name,
                value: table::shown(row.value, decimals),
                interval: table::interval(row.ci95, decimals),
            })
        })
        .collect()
}
