//! The table of a case: one row per subject, metric, region and scale mode; one column per
//! method. A score that does not exist stays empty, it never becomes a number.

use std::collections::{HashMap, HashSet};

use scoring::metrics::{Direction, Metric};
use scoring::score::{Row, Scores};
use serde::Serialize;

use super::metric;
use super::reference;
use super::run::{Kind, Method};

/// Text of a cell without a value.
pub(super) const EMPTY: &str = "–";

/// Text of the cells of a method that did not come to its end.
pub(super) const FAILED: &str = "failed";

/// One method in one case.
pub(super) struct Column<'a> {
    pub method: &'a Method,
    pub scores: Option<&'a Scores>,
}

impl<'a> Column<'a> {
    /// Every row; none without scores.
    pub fn rows(&self) -> &'a [Row] {
        self.scores.map_or(&[], |scores| &scores.rows)
    }

    /// Likely faults of the maps, in words.
    pub fn findings(&self) -> Vec<String> {
        let findings = self.scores.into_iter().flat_map(|scores| &scores.findings);
        findings.map(ToString::to_string).collect()
    }

    /// The one factor of the diffuse albedo.
    pub fn factor(&self) -> Option<f64> {
        Some(self.scores?.scale.as_ref()?.global)
    }

    /// The row of a metric over the subject's whole region.
    pub fn find(
        &self,
        subject: &str,
        light: Option<&str>,
        metric: &str,
        scale: &str,
    ) -> Option<&'a Row> {
        self.rows().iter().find(|row| {
            row.subject == subject
                && row.light.as_deref() == light
                && row.metric == metric
                && row.scale == scale
                && metric::is_whole(row)
        })
    }

    /// The row of the trivial answer that a map's row has to beat.
    fn trivial(&self, row: &Row) -> Option<&'a Row> {
        let subject = metric::trivial(&row.subject)?;
        self.rows().iter().find(|other| {
            other.subject == subject
                && (&other.metric, &other.region, &other.label, &other.scale)
                    == (&row.metric, &row.region, &row.label, &row.scale)
        })
    }
}

/// A table as the template shows it.
#[derive(Debug, Serialize)]
pub(super) struct Table {
    pub columns: Vec<Heading>,
    pub groups: Vec<Group>,
    /// True if any row has a trivial answer or a noise floor; photographs have neither.
    pub has_bounds: bool,
}

#[derive(Debug, Serialize)]
pub(super) struct Heading {
    pub title: String,
    pub kind: &'static str,
    /// Likely faults of the maps, in words.
    pub findings: Vec<String>,
}

/// The rows of one subject.
#[derive(Debug, Serialize)]
pub(super) struct Group {
    pub title: String,
    pub rows: Vec<Line>,
}

#[derive(Debug, Serialize)]
pub(super) struct Line {
    /// `<subject>[/light]/<metric>@<region>:<scale>`, as `unshade compare` names it.
    pub id: String,
    pub name: String,
    pub unit: &'static str,
    pub direction: &'static str,
    pub region: String,
    pub space: &'static str,
    pub scale: String,
    pub cells: Vec<Cell>,
    /// The plain mesh normal, the best constant.
    pub trivial: String,
    pub trivial_best: bool,
    pub floor: String,
    /// Both in full.
    #[serde(skip)]
    pub numbers: (Option<f64>, Option<f64>),
}

#[derive(Debug, Serialize)]
pub(super) struct Cell {
    pub value: String,
    /// In full; none where nothing was scored.
    #[serde(skip)]
    pub number: Option<f64>,
    #[serde(skip)]
    pub ci95: Option<[f64; 2]>,
    pub interval: String,
    pub best: bool,
    pub kind: &'static str,
}

/// The chosen rows: whole regions and the metrics that answer the subject's question.
pub(super) fn chosen(columns: &[Column], own_light: &str) -> Table {
    build(columns, own_light, metric::is_chosen)
}

/// Every row that any column has.
pub(super) fn complete(columns: &[Column], own_light: &str) -> Table {
    build(columns, own_light, |_| true)
}

fn build(columns: &[Column], own_light: &str, keep: impl Fn(&Row) -> bool) -> Table {
    let mut ids = HashSet::new();
    let all = columns.iter().flat_map(Column::rows);
    let mut keys: Vec<&Row> = all.filter(|row| keep(row) && ids.insert(row.id())).collect();
    let by_id: Vec<HashMap<String, &Row>> = columns
        .iter()
        .map(|column| column.rows().iter().map(|row| (row.id(), row)).collect())
        .collect();
    let mut groups: Vec<Group> = Vec::new();
    keys.sort_by_key(|row| group_order(row, own_light));
    for key in keys {
        let title = group_title(key, own_light);
        if groups.last().is_none_or(|group| group.title != title) {
            groups.push(Group { title, rows: Vec::new() });
        }
        if let Some(group) = groups.last_mut() {
            group.rows.push(line(key, columns, &by_id));
        }
    }
    let columns = columns
        .iter()
        .map(|column| Heading {
            title: column.method.title().to_owned(),
            kind: column.method.role(),
            findings: column.findings(),
        })
        .collect();
    let mut lines = groups.iter().flat_map(|group| &group.rows);
    let has_bounds = lines.any(|line| line.numbers != (None, None));
    Table { columns, groups, has_bounds }
}

fn line(key: &Row, columns: &[Column], by_id: &[HashMap<String, &Row>]) -> Line {
    // A metric of another version of the scoring is shown by its id alone.
    let known = Metric::find(&key.metric).ok();
    let unit = known.map_or("", |metric| metric.unit);
    let id = key.id();
    let rows: Vec<Option<&Row>> = by_id.iter().map(|rows| rows.get(&id).copied()).collect();
    let trivial = columns.iter().find_map(|column| column.trivial(key)?.value);
    let value = |row: &Option<&Row>| row.and_then(|row| row.value);
    let decimals = decimals(unit, rows.iter().filter_map(value).chain(trivial));
    let contenders: Vec<f64> = columns
        .iter()
        .zip(&rows)
        .filter(|(column, _)| column.method.is_ranked())
        .filter_map(|(_, row)| value(row))
        .chain(trivial)
        .collect();
    let best = known.and_then(|metric| best(metric.direction, &contenders));
    let cells = columns
        .iter()
        .zip(&rows)
        .map(|(column, row)| Cell {
            value: match column.method.failed {
                Some(_) => FAILED.to_owned(),
                None => shown(value(row), decimals),
            },
            number: value(row).filter(|_| column.method.failed.is_none()),
            ci95: row.and_then(|row| row.ci95),
            interval: interval(row.and_then(|row| row.ci95), decimals),
            best: column.method.is_ranked() && value(row).is_some() && value(row) == best,
            kind: column.method.role(),
        })
        .collect();
    // The true maps' pictures, where there are some: their floor depends on no method.
    let oracle = columns.iter().zip(&rows).filter(|(column, _)| column.method.kind == Kind::Oracle);
    let floor = oracle.chain(columns.iter().zip(&rows)).find_map(|(_, row)| (*row)?.floor);
    Line {
        id,
        name: known.map_or(key.metric.as_str(), |metric| metric.name).to_owned(),
        unit,
        direction: known.map_or("", |metric| metric.direction.symbol()),
        region: metric::region(&key.region, key.label.as_deref()),
        space: known.map_or("", |metric| metric.quantity.space()),
        scale: metric::scale(&key.scale).to_owned(),
        cells,
        trivial: shown(trivial, decimals),
        trivial_best: trivial.is_some() && trivial == best,
        floor: shown(floor, decimals),
        numbers: (trivial, floor),
    }
}

/// The best of several values; with a single contender there is nothing to win.
fn best(direction: Direction, values: &[f64]) -> Option<f64> {
    let better = |a: f64, b: f64| if direction.gain(a, b) > 0.0 { b } else { a };
    if values.len() < 2 { None } else { values.iter().copied().reduce(better) }
}

/// A value with a fixed number of decimals, or the dash of an empty cell.
pub(super) fn shown(value: Option<f64>, decimals: usize) -> String {
    value.map_or(EMPTY.to_owned(), |value| format!("{value:.decimals$}"))
}

/// A 95 % confidence interval; nothing where none could be estimated.
pub(super) fn interval(ci95: Option<[f64; 2]>, decimals: usize) -> String {
    ci95.map(|[low, high]| format!("{low:.decimals$} … {high:.decimals$}")).unwrap_or_default()
}

/// Two for decibels and degrees; elsewhere enough for three digits of the largest value.
pub(super) fn decimals(unit: &str, values: impl Iterator<Item = f64>) -> usize {
    if matches!(unit, "dB" | "°") {
        return 2;
    }
    let largest = values.map(f64::abs).fold(0.0, f64::max);
    // Shares and correlations that reach one keep the decimals of those below.
    match if largest < 2.0 { largest.min(0.99) } else { largest } {
        0.0 => 3,
        largest => (2.0 - largest.log10().floor()).clamp(1.0, 6.0) as usize,
    }
}

/// Subjects in the order of the walk from maps to pictures; the capture's own light first.
fn group_order(row: &Row, own_light: &str) -> (usize, bool, String) {
    let subject = metric::SUBJECTS.iter().position(|(id, _)| *id == row.subject);
    let light = row.light.clone().unwrap_or_default();
    (subject.unwrap_or(metric::SUBJECTS.len()), light != own_light, light)
}

fn group_title(row: &Row, own_light: &str) -> String {
    let subject = metric::subject(&row.subject);
    match row.light.as_deref() {
        None => subject.to_owned(),
        Some(light) if light == own_light => format!("{subject}: {}", reference::own_light(light)),
        Some(light) => format!("{subject}, {light}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_three_digits_and_a_unit_its_own_decimals() {
        let shown_as = |unit, value: f64| shown(Some(value), decimals(unit, [value].into_iter()));
        assert_eq!(shown_as("dB", 28.114), "28.11");
        assert_eq!(shown_as("", 0.0031), "0.00310");
        assert_eq!(shown_as("", 1.0), "1.000");
        assert_eq!(shown_as("", 5.712), "5.71");
        assert_eq!(shown_as("", 0.0), "0.000");
        assert_eq!(shown(None, 2), EMPTY);
    }

    #[test]
    fn the_best_is_the_one_in_the_metric_s_direction() {
        assert_eq!(best(Direction::Higher, &[1.0, 3.0, 2.0]), Some(3.0));
        assert_eq!(best(Direction::Lower, &[1.0, 3.0, 2.0]), Some(1.0));
        assert_eq!(best(Direction::One, &[0.7, 1.2, 2.0]), Some(1.2));
        assert_eq!(best(Direction::Higher, &[1.0]), None);
    }
}
