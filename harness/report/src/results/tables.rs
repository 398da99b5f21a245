//! The Markdown tables: means over faces, single faces, and what the figures are.

use std::collections::{BTreeMap, BTreeSet};

use scoring::metrics::Metric;
use scoring::score::FOUND_LIGHT;
use scoring::study::interval;
use scoring::tables::{markdown_head, markdown_row, markdown_text};

use super::figures::{Figure, Found, TABLES};
use super::finished::Finished;
use super::setting;
use crate::ReportError;
use crate::page;
use crate::run::Kind;
use crate::score_key::{Lights, mean, other_lights};
use crate::table::{self, Column};

/// The cases of one light and variant.
#[derive(Clone)]
pub(super) struct Group {
    pub light: String,
    pub variant: Option<String>,
    /// Indices of the cases.
    pub cases: Vec<usize>,
}

impl Group {
    pub fn title(&self) -> String {
        let light = match self.light.as_str() {
            FOUND_LIGHT => "Photographs".to_owned(),
            light => format!("{light} light"),
        };
        match &self.variant {
            Some(variant) => format!("{light}, {variant}"),
            None => light,
        }
    }
}

/// Lights and variants in the order of the run.
pub(super) fn groups(run: &Finished) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (index, case) in run.manifest.cases.iter().enumerate() {
        let same = |group: &&mut Group| group.light == case.light && group.variant == case.variant;
        match groups.iter_mut().find(same) {
            Some(group) => group.cases.push(index),
            None => groups.push(Group {
                light: case.light.clone(),
                variant: case.variant.clone(),
                cases: vec![index],
            }),
        }
    }
    groups
}

/// One method over the cases of a group.
struct Line<'a> {
    title: String,
    kind: Kind,
    /// True if it is marked where it is best.
    ranked: bool,
    columns: Vec<Column<'a>>,
    /// The face of each.
    faces: Vec<&'a str>,
}

/// The methods of a group, solvers first and the oracle last.
fn lines<'a>(run: &'a Finished, group: &Group) -> Vec<Line<'a>> {
    let mut lines: Vec<(&str, Line)> = Vec::new();
    for index in &group.cases {
        let case = &run.manifest.cases[*index];
        for column in page::columns(case, &run.scores[*index]) {
            let method = column.method;
            match lines.iter_mut().find(|(id, _)| *id == method.id) {
                Some((_, line)) => {
                    line.columns.push(column);
                    line.faces.push(&case.face);
                }
                None => {
                    let title = method.title_and_role();
                    let (kind, ranked) = (method.kind, method.is_ranked());
                    let faces = vec![case.face.as_str()];
                    let line = Line { title, kind, ranked, columns: vec![column], faces };
                    lines.push((&method.id, line));
                }
            }
        }
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

/// The means over the faces of one light: a title, and a row for each method.
pub(super) struct MeansTable {
    pub title: &'static str,
    pub figures: Vec<&'static Figure>,
    pub headings: Vec<String>,
    pub rows: Vec<MeansRow>,
}

pub(super) struct MeansRow {
    pub title: String,
    pub cells: Vec<Cell>,
}

/// A figure of one method over the faces.
#[derive(Default)]
pub(super) struct Cell {
    /// Mean, half of its 95 % interval, and range over the faces; beside a trivial answer also that, and the ratio
    /// of the two.
    pub text: String,
    /// True if the mean, the text's first word, is the best.
    pub best: bool,
    /// The values of the faces that have one.
    pub values: Vec<f64>,
}

/// The tables of a light, without those that no method has a figure for.
pub(super) fn means(run: &Finished, group: &Group) -> Vec<MeansTable> {
    let lines = lines(run, group);
    let faces = group.cases.iter().map(|index| &run.manifest.cases[*index].face);
    let faces = faces.collect::<BTreeSet<_>>().len();
    let table = |(title, figures): &(&'static str, &'static [Figure])| {
        // A figure that no method has (confidence of a baseline's run) gets no column.
        let found = |figure: &Figure, line: &Line| by_face(figure, line, &group.light);
        let figures: Vec<&Figure> = figures
            .iter()
            .filter(|f| lines.iter().any(|line| !found(f, line).is_empty()))
            .collect();
        let of_line = |line: &Line| -> Vec<Vec<Found>> {
            figures.iter().map(|figure| found(figure, line)).collect()
        };
        let values: Vec<Vec<Vec<Found>>> = lines.iter().map(of_line).collect();
        let best: Vec<Option<String>> =
            (0..figures.len()).map(|i| best(&lines, figures[i], |line| &values[line][i])).collect();
        let headings = figures.iter().map(|figure| heading(figure, &lines, group)).collect();
        let rows = lines.iter().zip(&values).map(|(line, values)| {
            let cells = figures.iter().zip(values).zip(&best).map(|((figure, values), best)| {
                cell(figure.decimals, values, faces, best.as_deref().filter(|_| line.ranked))
            });
            MeansRow { title: line.title.clone(), cells: cells.collect() }
        });
        let rows = rows.chain(floor(&figures, &lines, &values, faces)).collect();
        (!figures.is_empty()).then_some(MeansTable { title, figures, headings, rows })
    };
    TABLES.iter().filter_map(table).collect()
}

/// The tables of a light as Markdown.
pub(super) fn markdown(group: &Group, tables: &[MeansTable]) -> String {
    let mut text = format!("\n### {}\n", markdown_text(&group.title()));
    for table in tables {
        let headings = table.headings.iter().map(|heading| markdown_text(heading));
        let head = markdown_head(std::iter::once("method".to_owned()).chain(headings));
        text.push_str(&format!("\n{}\n\n{head}", table.title));
        for line in &table.rows {
            let shown = |cell: &Cell| match cell.text.split_once(' ') {
                _ if !cell.best => cell.text.clone(),
                Some((mean, rest)) => format!("**{mean}** {rest}"),
                None => format!("**{}**", cell.text),
            };
            let cells = line.cells.iter().map(shown);
            text.push_str(&markdown_row(std::iter::once(markdown_text(&line.title)).chain(cells)));
        }
    }
    text
}

/// A figure of every face that has it, of several seeds the mean.
fn by_face(figure: &Figure, line: &Line, light: &str) -> Vec<Found> {
    let mut faces: BTreeMap<&str, Vec<Found>> = BTreeMap::new();
    for (column, face) in line.columns.iter().zip(&line.faces) {
        faces.entry(face).or_default().extend(figure.find(column, light));
    }
    faces.retain(|_, found| !found.is_empty());
    let of_face = |seeds: &Vec<Found>| Found {
        value: mean(seeds.iter().map(|found| found.value)).unwrap_or(f64::NAN),
        against: mean(seeds.iter().filter_map(|found| found.against)),
        floor: mean(seeds.iter().filter_map(|found| found.floor)),
    };
    faces.values().map(of_face).collect()
}

/// The name of a column; that of the other lights says which they are.
fn heading(figure: &Figure, lines: &[Line], group: &Group) -> String {
    if figure.key.lights != Lights::Others {
        return figure.name.to_owned();
    }
    let mut lights: Vec<&str> = lines
        .iter()
        .flat_map(|line| &line.columns)
        .flat_map(|column| other_lights(column, &group.light))
        .collect();
    lights.sort_unstable();
    lights.dedup();
    format!("{} ({})", figure.name, lights.join(", "))
}

/// The best mean as it is shown, what is made from the truth aside; none without a competition.
fn best<'a>(
    lines: &[Line],
    figure: &Figure,
    values: impl Fn(usize) -> &'a Vec<Found>,
) -> Option<String> {
    let contenders = lines.iter().enumerate().filter(|(_, line)| line.ranked);
    let means: Vec<f64> =
        contenders.filter_map(|(i, _)| mean(values(i).iter().map(|found| found.value))).collect();
    let better = |a: f64, b: f64| if figure.key.direction().gain(a, b) > 0.0 { b } else { a };
    let best = means.iter().copied().reduce(better)?;
    (means.len() > 1).then(|| table::shown(Some(best), figure.decimals))
}

fn cell(decimals: usize, values: &[Found], faces: usize, best: Option<&str>) -> Cell {
    let Some(value) = mean(values.iter().map(|found| found.value)) else {
        return Cell { text: table::EMPTY.to_owned(), ..Cell::default() };
    };
    let mut text = table::shown(Some(value), decimals);
    // Equal as they are shown is equally good.
    let best = best == Some(text.as_str());
    let missing = faces - values.len();
    let pairs: Option<Vec<(f64, f64)>> =
        values.iter().map(|found| Some((found.value, found.against?))).collect();
    let ranged: Vec<f64> = match &pairs {
        Some(pairs) => {
            let against = mean(pairs.iter().map(|pair| pair.1)).unwrap_or_default();
            let percent = 100.0 * value / against;
            text.push_str(&format!(" / {against:.decimals$} = {percent:.0} %"));
            pairs.iter().map(|(value, against)| 100.0 * value / against).collect()
        }
        None => values.iter().map(|found| found.value).collect(),
    };
    if let (true, Some(low), Some(high)) = (
        ranged.len() > 1,
        ranged.iter().copied().min_by(f64::total_cmp),
        ranged.iter().copied().max_by(f64::total_cmp),
    ) {
        let decimals = if pairs.is_some() { 0 } else { decimals };
        if let Some([below, above]) = interval(&ranged) {
            text.push_str(&format!(" ± {:.decimals$}", 0.5 * (above - below)));
        }
        text.push_str(&format!(" ({low:.decimals$} … {high:.decimals$})"));
    }
    if missing > 0 {
        text.push_str(&format!(" {} of {faces}", values.len()));
    }
    Cell { text, best, values: values.iter().map(|found| found.value).collect() }
}

/// The row of what rendering noise leaves; none where no figure has a floor.
fn floor(
    shown: &[&Figure],
    lines: &[Line],
    values: &[Vec<Vec<Found>>],
    faces: usize,
) -> Option<MeansRow> {
    // The true maps' pictures where there are some: that floor depends on no method.
    let mut order: Vec<usize> = (0..lines.len()).collect();
    order.sort_by_key(|i| lines[*i].kind != Kind::Oracle);
    let cell_of = |(column, figure): (usize, &&Figure)| {
        let floors = order.iter().map(|line| -> Vec<Found> {
            let found = values[*line][column].iter();
            found
                .filter_map(|f| Some(Found { value: f.floor?, against: None, floor: None }))
                .collect()
        });
        let floors = floors.into_iter().find(|floors| !floors.is_empty()).unwrap_or_default();
        cell(figure.decimals, &floors, faces.max(floors.len()), None)
    };
    let cells: Vec<Cell> = shown.iter().enumerate().map(cell_of).collect();
    let any = cells.iter().any(|cell| !cell.values.is_empty());
    any.then(|| MeansRow { title: "noise floor".to_owned(), cells })
}

/// One table for every face: a row for each light and method.
pub(super) fn faces(run: &Finished) -> Result<String, ReportError> {
    let mut names: Vec<&str> = Vec::new();
    for case in &run.manifest.cases {
        if !names.contains(&case.face.as_str()) {
            names.push(&case.face);
        }
    }
    let mut text = String::new();
    for name in names {
        let cases = || run.manifest.cases.iter().enumerate().filter(|(_, case)| case.face == name);
        let Some((_, first)) = cases().next() else { continue };
        let about = setting::face(first, &setting::scene(&run.folder.join(&first.capture)));
        let figures: Vec<&Figure> = TABLES
            .iter()
            .flat_map(|(_, figures)| *figures)
            .filter(|figure| {
                cases().any(|(index, case)| {
                    let columns = page::columns(case, &run.scores[index]);
                    columns.iter().any(|column| figure.find(column, &case.light).is_some())
                })
            })
            .collect();
        let headings = figures.iter().map(|figure| figure.short);
        let head = markdown_head(["light", "method"].into_iter().chain(headings));
        text.push_str(&format!("\n### {}\n\n{head}", markdown_text(&about)));
        for (index, case) in cases() {
            let light = match &case.variant {
                Some(variant) => format!("{}, {variant}", case.light),
                None => case.light.clone(),
            };
            for column in page::columns(case, &run.scores[index]) {
                let cells = figures
                    .iter()
                    .map(|figure| cell_of_face(figure, figure.find(&column, &case.light)));
                let names = [markdown_text(&light), markdown_text(&column.method.title_and_role())];
                text.push_str(&markdown_row(names.into_iter().chain(cells)));
            }
        }
    }
    Ok(text)
}

fn cell_of_face(figure: &Figure, found: Option<Found>) -> String {
    let Some(found) = found else { return table::EMPTY.to_owned() };
    let value = table::shown(Some(found.value), figure.decimals);
    match found.against {
        Some(against) => format!("{value} ({:.0} %)", 100.0 * found.value / against),
        None => value,
    }
}

/// Legend of the columns: the row of the scores, and the metric in full.
pub(super) fn legend() -> String {
    let mut text =
        "\n## Figures\n\nA figure is a row of the scores: subject, metric, region, scale. \
                    Percentages are of the trivial answer's error beside it.\n\n"
            .to_owned();
    text.push_str(&markdown_head(["figure", "row", "better", "metric"]));
    for figure in TABLES.iter().flat_map(|(_, figures)| *figures) {
        let definition = Metric::find(figure.key.metric).map_or("", |metric| metric.definition);
        let against =
            figure.against().map_or(String::new(), |subject| format!("; against `{subject}`"));
        text.push_str(&markdown_row([
            figure.short.to_owned(),
            format!("`{}`{against}", figure.key.row_id()),
            figure.key.direction().symbol().to_owned(),
            markdown_text(definition),
        ]));
    }
    text
}
