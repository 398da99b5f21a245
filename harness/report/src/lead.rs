//! The figure at the head of a case: the input, the reference, what each method made of it, and its error.

use serde::Serialize;

use super::comparison_figures::{ComparisonFigure, Tile};
use super::table::Table;

/// The figure at the head of a case.
#[derive(Debug, Serialize)]
pub(super) struct Lead {
    pub rows: Vec<LeadRow>,
    /// True if maps are compared too.
    has_maps: bool,
}

/// One comparison: a withheld view, or a map.
#[derive(Debug, Serialize)]
pub(super) struct LeadRow {
    pub title: String,
    pub input: Option<Tile>,
    pub truth: Tile,
    /// The name of the picture of the reference.
    pub reference: &'static str,
    pub made: Vec<Made>,
    /// Quantity of the error, and the value where its colours end.
    pub error: &'static str,
    pub top: String,
    pub unit: &'static str,
}

/// One method's picture and its error.
#[derive(Debug, Serialize)]
pub(super) struct Made {
    pub title: String,
    pub kind: &'static str,
    /// None where the method has no such picture.
    pub picture: Option<Tile>,
    pub error: Option<Tile>,
    pub caption: String,
}

/// A view relit in another light than the capture's, the diffuse albedo after its factor, and the specular normal;
/// of photographs, of which no other light and no map is known, the method's own view and the view relit in its
/// own light. None of a case without a reference.
pub(super) fn lead(
    views: &[ComparisonFigure],
    maps: &[ComparisonFigure],
    table: &Table,
    own: &str,
    input: Option<&Tile>,
) -> Option<Lead> {
    let relit = |figure: &&ComparisonFigure| figure.subject.0 == "relit";
    let other = |figure: &&ComparisonFigure| figure.subject.1.as_deref() != Some(own);
    let view = views.iter().filter(relit).find(other).or_else(|| views.iter().find(relit));
    let map = |subject: &str| maps.iter().find(|figure| figure.subject.0 == subject);
    let own_view = views.iter().find(|figure| figure.subject.0 == "view");
    let chosen = match maps {
        [] => [own_view, view, None],
        _ => [view.or(own_view), map("diffuse_albedo"), map("specular_normal")],
    };
    let rows: Vec<LeadRow> = chosen
        .into_iter()
        .flatten()
        .enumerate()
        .filter_map(|(at, figure)| row(figure, table, input.filter(|_| at == 0)))
        .collect();
    (!rows.is_empty()).then_some(Lead { rows, has_maps: !maps.is_empty() })
}

fn row(figure: &ComparisonFigure, table: &Table, input: Option<&Tile>) -> Option<LeadRow> {
    let strip = figure.strips.first()?;
    let made = strip.entries.iter().zip(&table.columns).map(|(entry, column)| Made {
        title: column.title.clone(),
        kind: column.kind,
        picture: entry.picture.clone(),
        // After the factor, where there is one.
        error: entry.errors.iter().rev().flatten().next().cloned(),
        caption: entry.caption.clone(),
    });
    let view = if strip.title.is_empty() { String::new() } else { format!(", {}", strip.title) };
    Some(LeadRow {
        title: format!("{}{view}", figure.title),
        input: input.cloned(),
        truth: strip.truth.clone(),
        reference: figure.reference,
        made: made.collect(),
        error: figure.error,
        top: figure.top.clone(),
        unit: figure.unit,
    })
}
