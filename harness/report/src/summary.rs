//! The key figures: the few numbers of each case that decide.

use serde::Serialize;

use super::reference::Reference;
use super::run::Case;
use super::score_key::{ALBEDO, RELIT_OTHERS, RELIT_OWN, SPECULAR_NORMAL, ScoreKey, VIEW};
use super::table::{self, Column};
use super::{comparison_figures, metric};

/// The key figures of all cases, without those that no method of any case has.
#[derive(Serialize)]
pub(super) struct Summary {
    pub headings: Vec<Heading>,
    pub cases: Vec<SummaryCase>,
}

/// The heading of a column.
#[derive(Clone, Serialize)]
pub(super) struct Heading {
    /// The compared quantity, on two lines.
    lines: [&'static str; 2],
    metric: &'static str,
    /// All of it on one line, as in LaTeX.
    #[serde(skip)]
    pub name: &'static str,
    /// The columns of CSV and JSON.
    #[serde(skip)]
    pub columns: &'static [Number],
}

/// A number of a key figure, and its name.
type Number = (&'static str, fn(&KeyFigure) -> Option<f64>);

/// The numbers of a key figure; none of what a method lacks.
#[derive(Clone, Default)]
pub(super) struct KeyFigure {
    /// The least and the largest value over the lights.
    low: Option<f64>,
    high: Option<f64>,
    /// The value of the trivial solution.
    trivial: Option<f64>,
}

/// The figures that decide, of one case.
#[derive(Serialize)]
pub(super) struct SummaryCase {
    pub id: String,
    anchor: String,
    pub rows: Vec<SummaryRow>,
    /// The reasons why methods have no figures beside photographs, one sentence each.
    missing: Vec<String>,
}

#[derive(Serialize)]
pub(super) struct SummaryRow {
    pub title: String,
    kind: &'static str,
    /// Likely faults of the maps, in words.
    findings: Vec<String>,
    pub cells: Vec<String>,
    /// The numbers behind the cells.
    #[serde(skip)]
    pub figures: Vec<KeyFigure>,
}

const DECIBELS: &str = "PSNR, sRGB, dB ↑";
const LOW: fn(&KeyFigure) -> Option<f64> = |figure| figure.low;

const KEY_FIGURES: [(Heading, ScoreKey); 5] = [
    (
        Heading {
            lines: ["diffuse albedo,", "after one factor"],
            metric: DECIBELS,
            name: "diffuse albedo, PSNR of sRGB after one factor, dB",
            columns: &[("diffuse albedo, PSNR of sRGB after one factor, dB", LOW)],
        },
        ALBEDO,
    ),
    (
        Heading {
            lines: ["specular normal,", "mean angle / plain mesh"],
            metric: "degrees ↓",
            name: "specular normal, mean angle / plain mesh, °",
            columns: &[
                ("specular normal, mean angle, °", LOW),
                ("specular normal of the plain mesh, mean angle, °", |figure| figure.trivial),
            ],
        },
        SPECULAR_NORMAL,
    ),
    (
        Heading {
            lines: ["withheld view,", "by the method itself"],
            metric: DECIBELS,
            name: "withheld view, PSNR of sRGB, dB",
            columns: &[("withheld view, PSNR of sRGB, dB", LOW)],
        },
        VIEW,
    ),
    (
        Heading {
            lines: ["maps relit,", "capture's light"],
            metric: DECIBELS,
            name: "relit, capture's light, PSNR of sRGB, dB",
            columns: &[("relit, capture's light, PSNR of sRGB, dB", LOW)],
        },
        RELIT_OWN,
    ),
    (
        Heading {
            lines: ["maps relit,", "other lights"],
            metric: DECIBELS,
            name: "relit, other lights, PSNR of sRGB, dB",
            columns: &[
                ("relit, other lights, lowest PSNR of sRGB, dB", LOW),
                ("relit, other lights, highest PSNR of sRGB, dB", |figure| figure.high),
            ],
        },
        RELIT_OTHERS,
    ),
];

impl Summary {
    /// The key figures of cases with their columns and what those are compared with.
    pub fn of(cases: &[(&Case, &[Column], Reference)]) -> Self {
        let summaries =
            cases.iter().map(|(case, columns, reference)| summary(case, columns, *reference));
        let mut cases: Vec<SummaryCase> = summaries.collect();
        let empty = |cell: &str| [table::EMPTY, table::FAILED].contains(&cell);
        let any = |at: &usize| {
            cases.iter().flat_map(|case| &case.rows).any(|row| !empty(&row.cells[*at]))
        };
        let kept: Vec<usize> = (0..KEY_FIGURES.len()).filter(any).collect();
        for row in cases.iter_mut().flat_map(|case| &mut case.rows) {
            row.cells = kept.iter().map(|at| row.cells[*at].clone()).collect();
            row.figures = kept.iter().map(|at| row.figures[*at].clone()).collect();
        }
        Self { headings: kept.iter().map(|at| KEY_FIGURES[*at].0.clone()).collect(), cases }
    }
}

fn summary(case: &Case, columns: &[Column], reference: Reference) -> SummaryCase {
    let rows = columns.iter().map(|column| {
        let failed = column.method.failed.is_some();
        let figures = KEY_FIGURES.iter().map(|(_, key)| match failed {
            true => KeyFigure::default(),
            false => KeyFigure::of(key, column, &case.light),
        });
        let figures: Vec<KeyFigure> = figures.collect();
        SummaryRow {
            title: column.method.title().to_owned(),
            kind: column.method.role(),
            findings: column.findings(),
            cells: match failed {
                true => vec![table::FAILED.to_owned(); KEY_FIGURES.len()],
                false => figures.iter().map(KeyFigure::in_words).collect(),
            },
            figures,
        }
    });
    let scored = columns.iter().filter(|column| column.scores.is_some());
    let photographed = scored.filter(|_| reference == Reference::Photograph);
    SummaryCase {
        id: case.id.clone(),
        anchor: comparison_figures::file_name(&case.id),
        rows: rows.collect(),
        missing: photographed.filter_map(missing).collect(),
    }
}

/// The reason why a method lacks scores against photographs; `None` if it has all.
fn missing(column: &Column) -> Option<String> {
    let has = |subject: &str| column.rows().iter().any(|row| row.subject == subject);
    let title = column.method.title();
    match [has("view"), has("relit")] {
        [true, true] => None,
        [true, false] => Some(format!(
            "{title} recovers no light, so its maps cannot be relit as the photographs were lit."
        )),
        [false, true] => Some(format!("{title} wrote no pictures of the withheld views (views/).")),
        [false, false] => Some(format!(
            "{title} wrote neither pictures of the withheld views (views/) nor a light (light.exr) to relight its \
             maps in, so nothing of it can be compared with the photographs."
        )),
    }
}

impl KeyFigure {
    fn of(key: &ScoreKey, column: &Column, own: &str) -> Self {
        let values: Vec<f64> = key.rows(column, own).iter().filter_map(|row| row.value).collect();
        let trivial = metric::trivial(key.subject)
            .and_then(|trivial| column.find(trivial, None, key.metric, key.scale)?.value);
        let low = values.iter().copied().min_by(f64::total_cmp);
        let high = values.iter().copied().max_by(f64::total_cmp);
        Self { low, high, trivial }
    }

    /// One value (for normals beside that of the plain mesh), or the range over the other lights.
    fn in_words(&self) -> String {
        match (self.low, self.high) {
            (Some(low), Some(high)) if low < high => format!("{low:.1} … {high:.1}"),
            (value, _) if self.trivial.is_some() => {
                format!("{} / {}", table::shown(value, 2), table::shown(self.trivial, 2))
            }
            (value, _) => table::shown(value, 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use scoring::metrics::Metric;

    use super::*;

    #[test]
    fn every_key_figure_is_a_metric_of_a_subject() {
        for (_, key) in KEY_FIGURES {
            assert!(Metric::find(key.metric).is_ok(), "{}", key.metric);
            assert_ne!(metric::subject(key.subject), key.subject);
        }
    }
}
