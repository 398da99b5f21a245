//! Everything the page shows, gathered from a run and laid out by the templates.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, UndefinedBehavior};
use serde::Serialize;
use serde_json::Value as Json;

use super::matrix::{self, Matrix};
use super::plates::{self, Input, Method, Plate, Studio};
use super::run::{self, Case, Frames, RunFile, Timing};
use super::scores::Scores;
use super::table::{self, Column, Table};
use super::{MARK, ReportError, curve, metric, tone};
use crate::metrics::{METRICS, Metric};

/// The page as the templates see it.
#[derive(Serialize)]
pub(super) struct Page {
    title: String,
    suite: String,
    heat: String,
    mark: &'static str,
    summary: Vec<SummaryCase>,
    matrices: Vec<Matrix>,
    cases: Vec<CaseView>,
    metrics: Vec<Definition>,
    /// Name and statements of each protocol that the scores were made by.
    protocols: Vec<(String, Vec<String>)>,
    versions: Vec<(String, String)>,
    suite_toml: Option<String>,
    times: Times,
    #[serde(skip)]
    pictures: usize,
}

/// The figures that decide, of one case.
#[derive(Serialize)]
struct SummaryCase {
    id: String,
    anchor: String,
    rows: Vec<SummaryRow>,
}

#[derive(Serialize)]
struct SummaryRow {
    title: String,
    kind: &'static str,
    cells: Vec<String>,
}

#[derive(Serialize)]
struct CaseView {
    id: String,
    anchor: String,
    face: String,
    light: String,
    train: usize,
    test: usize,
    inputs: Vec<Input>,
    table: Table,
    complete: Table,
    regions: Vec<Region>,
    maps: Vec<Plate>,
    views: Vec<Plate>,
    layers: Vec<Plate>,
    solves: Vec<Solve>,
    hashes: Vec<Hashes>,
    scene_toml: Option<String>,
}

/// How much of the truth a region holds.
#[derive(Serialize)]
struct Region {
    name: String,
    pixels: usize,
    share: String,
    /// Per column: the share for which the method had data.
    solved: Vec<String>,
}

/// What a method says about itself in `solve.json`.
#[derive(Serialize)]
struct Solve {
    title: String,
    curve: Option<String>,
    facts: Vec<(String, String)>,
}

/// The contents that one column's scores were computed from.
#[derive(Serialize)]
struct Hashes {
    title: String,
    data: Option<String>,
    inputs: Vec<(&'static str, String)>,
    factor: Option<String>,
}

#[derive(Serialize)]
struct Definition {
    id: &'static str,
    name: &'static str,
    unit: &'static str,
    direction: &'static str,
    space: &'static str,
    text: &'static str,
    link: &'static str,
}

#[derive(Serialize)]
struct Times {
    stages: Vec<TimeRow>,
    total: String,
}

#[derive(Serialize)]
struct TimeRow {
    id: String,
    seconds: String,
    /// Share of the longest stage, per cent.
    share: f64,
    cached: bool,
}

/// One entry of the key figures: heading, subject, metric, scale, and whether the light is
/// absent, the capture's own or any other.
struct KeyFigure {
    subject: &'static str,
    metric: &'static str,
    scale: &'static str,
    light: KeyLight,
}

#[derive(Clone, Copy, PartialEq)]
enum KeyLight {
    None,
    Own,
    Other,
}

const KEY_FIGURES: [KeyFigure; 5] = [
    KeyFigure { subject: "diffuse_albedo", metric: "psnr_srgb", scale: "global", light: KeyLight::None },
    KeyFigure { subject: "specular_normal", metric: "normal_mean_deg", scale: "none", light: KeyLight::None },
    KeyFigure { subject: "view", metric: "psnr_srgb", scale: "none", light: KeyLight::None },
    KeyFigure { subject: "relit", metric: "psnr_srgb", scale: "global", light: KeyLight::Own },
    KeyFigure { subject: "relit", metric: "psnr_srgb", scale: "global", light: KeyLight::Other },
];

impl Page {
    /// Reads the run, and writes the pictures and the scores below `root`.
    pub fn make(
        run: &Path,
        manifest: &RunFile,
        timing: Timing,
        root: &Path,
    ) -> Result<Self, ReportError> {
        let mut page = Self {
            title: manifest.title.clone().unwrap_or_else(|| manifest.suite.clone()),
            suite: manifest.suite.clone(),
            heat: tone::heat_gradient(),
            mark: MARK,
            summary: Vec::new(),
            matrices: Vec::new(),
            cases: Vec::new(),
            metrics: METRICS.iter().map(Definition::of).collect(),
            protocols: Vec::new(),
            versions: manifest.versions.iter().map(|(k, v)| (k.clone(), plain(v))).collect(),
            suite_toml: manifest.suite_toml.clone(),
            times: Times::of(timing),
            pictures: 0,
        };
        let scores = manifest.cases.iter().map(|case| read_scores(run, case));
        let scores: Vec<Vec<Option<Scores>>> = scores.collect::<Result<_, _>>()?;
        let columns: Vec<Vec<Column>> =
            manifest.cases.iter().zip(&scores).map(|(case, scores)| columns(case, scores)).collect();
        for (case, columns) in manifest.cases.iter().zip(&columns) {
            page.summary.push(summary(case, columns));
            page.cases.push(CaseView::make(run, case, columns, root)?);
        }
        let sources: Vec<matrix::Source> = manifest
            .cases
            .iter()
            .zip(&page.cases)
            .zip(&columns)
            .map(|((case, view), columns)| matrix::Source {
                face: &case.face,
                light: &case.light,
                columns,
                plates: &view.views,
                input: view.main_input(),
            })
            .collect();
        page.matrices = matrix::matrices(&sources);
        for scores in scores.iter().flatten().flatten() {
            if !page.protocols.iter().any(|(id, _)| *id == scores.protocol.id) {
                page.protocols.push((scores.protocol.id.clone(), scores.protocol.statements.clone()));
            }
        }
        page.pictures = count_pictures(&root.join("pictures"))?;
        Ok(page)
    }

    /// How many pictures the page refers to.
    pub fn pictures(&self) -> usize {
        self.pictures
    }

    /// The page's text.
    pub fn html(&self) -> Result<String, ReportError> {
        let mut environment = Environment::new();
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment.set_syntax(
            SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build()?,
        );
        for (name, text) in [
            ("index.html", include_str!("templates/index.html")),
            ("table.html", include_str!("templates/table.html")),
            ("plate.html", include_str!("templates/plate.html")),
            ("matrix.html", include_str!("templates/matrix.html")),
            ("reading.html", include_str!("templates/reading.html")),
            ("style.css", include_str!("templates/style.css")),
            ("slider.js", include_str!("templates/slider.js")),
        ] {
            environment.add_template(name, text)?;
        }
        let html = environment.get_template("index.html")?.render(Value::from(Serde(self)))?;
        // The engine escapes the slashes of paths too, for templates without quoted attributes.
        Ok(html.replace("&#x2f;", "/"))
    }
}

fn read_scores(run: &Path, case: &Case) -> Result<Vec<Option<Scores>>, ReportError> {
    case.solvers
        .iter()
        .map(|solver| match &solver.scores {
            Some(path) => run::read_json_if_present(&run.join(path)),
            None => Ok(None),
        })
        .collect()
}

/// Solvers first, then the baselines to beat, then the oracle that bounds them.
fn columns<'a>(case: &'a Case, scores: &'a [Option<Scores>]) -> Vec<Column<'a>> {
    let mut columns: Vec<Column> = case
        .solvers
        .iter()
        .zip(scores)
        .map(|(solver, scores)| Column {
            id: &solver.id,
            title: solver.title(),
            kind: solver.kind,
            scores: scores.as_ref(),
        })
        .collect();
    columns.sort_by_key(|column| column.kind);
    columns
}

fn summary(case: &Case, columns: &[Column]) -> SummaryCase {
    let rows = columns.iter().map(|column| SummaryRow {
        title: column.title.to_owned(),
        kind: column.kind.name(),
        cells: KEY_FIGURES.iter().map(|key| key_figure(key, column, &case.light)).collect(),
    });
    SummaryCase { id: case.id.clone(), anchor: plates::file_name(&case.id), rows: rows.collect() }
}

/// One value (for normals beside that of the plain mesh), or the range over the other lights.
fn key_figure(key: &KeyFigure, column: &Column, own: &str) -> String {
    let lights: Vec<Option<&str>> = match key.light {
        KeyLight::None => vec![None],
        KeyLight::Own => vec![Some(own)],
        KeyLight::Other => {
            let rows = column.scores.map_or(&[][..], |scores| &scores.rows);
            let mut lights: Vec<Option<&str>> = rows.iter().map(|row| row.light.as_deref()).collect();
            lights.sort();
            lights.dedup();
            lights.retain(|light| light.is_some_and(|light| light != own));
            lights
        }
    };
    let value = |subject: &str, light| column.find(subject, light, key.metric, key.scale)?.value;
    let values: Vec<f64> = lights.into_iter().filter_map(|light| value(key.subject, light)).collect();
    let trivial = metric::trivial(key.subject).and_then(|trivial| value(trivial, None));
    let low = values.iter().copied().min_by(f64::total_cmp);
    let high = values.iter().copied().max_by(f64::total_cmp);
    match (low, high) {
        (Some(low), Some(high)) if low < high => format!("{low:.1} … {high:.1}"),
        (value, _) if trivial.is_some() => {
            format!("{} / {}", table::shown(value, 2), table::shown(trivial, 2))
        }
        (value, _) => table::shown(value, 1),
    }
}

fn regions(columns: &[Column]) -> Vec<Region> {
    let sizes = |column: &Column| column.scores.map_or(&[][..], |scores| &scores.regions).to_vec();
    let all: Vec<_> = columns.iter().map(sizes).collect();
    let percent = |share: Option<f64>| share.map_or(table::EMPTY.to_owned(), |s| format!("{:.1} %", s * 100.0));
    let known = all.iter().max_by_key(|sizes| sizes.len()).into_iter().flatten();
    known
        .map(|size| Region {
            name: size.region.clone(),
            pixels: size.pixels,
            share: percent(Some(size.share)),
            solved: all
                .iter()
                .map(|sizes| percent(sizes.iter().find(|other| other.region == size.region).and_then(|s| s.solved)))
                .collect(),
        })
        .collect()
}

impl CaseView {
    fn make(
        run: &Path,
        case: &Case,
        columns: &[Column],
        root: &Path,
    ) -> Result<Self, ReportError> {
        let capture = run.join(&case.capture);
        let frames = Frames::read(&capture)?;
        let entrant = |column: &Column| case.solvers.iter().find(|solver| solver.id == column.id);
        let below = |path: Option<&std::path::PathBuf>| path.map(|path| run.join(path));
        let methods: Vec<Method> = columns
            .iter()
            .map(|column| Method {
                column,
                maps: below(entrant(column).and_then(|solver| solver.maps.as_ref())),
                relit: below(entrant(column).and_then(|solver| solver.relit.as_ref())),
            })
            .collect();
        let anchor = plates::file_name(&case.id);
        let studio = Studio {
            frames: &frames,
            light: &case.light,
            methods: &methods,
            root,
            folder: &format!("pictures/{anchor}"),
        };
        let mut solves = Vec::new();
        let mut hashes = Vec::new();
        for method in &methods {
            if let Some(maps) = &method.maps {
                solves.extend(Solve::read(method.column.title, &maps.join("solve.json"))?);
            }
            let scores = entrant(method.column).and_then(|solver| solver.scores.as_ref());
            let data = match below(scores) {
                Some(path) if path.exists() => {
                    let target = format!("data/{anchor}/{}.json", plates::file_name(method.column.id));
                    copy(&path, &root.join(&target))?;
                    Some(target)
                }
                _ => None,
            };
            hashes.push(Hashes::of(method.column, data));
        }
        Ok(Self {
            id: case.id.clone(),
            face: case.face.clone(),
            light: case.light.clone(),
            train: frames.train.len(),
            test: frames.test.len(),
            inputs: studio.inputs()?,
            table: table::chosen(columns, &case.light),
            complete: table::complete(columns, &case.light),
            regions: regions(columns),
            maps: studio.map_plates()?,
            views: studio.view_plates()?,
            layers: studio.layer_plates()?,
            solves,
            hashes,
            scene_toml: fs::read_to_string(capture.join("truth/scene.toml")).ok(),
            anchor,
        })
    }

    /// The training view nearest to the first withheld one.
    fn main_input(&self) -> Option<&plates::Tile> {
        let index = self.views.first()?.strips.first()?.input?;
        Some(&self.inputs.get(index)?.tile)
    }
}

impl Solve {
    fn read(title: &str, path: &Path) -> Result<Option<Self>, ReportError> {
        let Some(solve) = run::read_json_if_present::<Json>(path)? else { return Ok(None) };
        let stages = curve::stages(&solve);
        let mut facts = Vec::new();
        if let Json::Object(entries) = &solve {
            for (key, value) in entries.iter().filter(|(key, _)| !curve::is_history(key)) {
                flatten(key, value, &mut facts);
            }
        }
        Ok(Some(Self { title: title.to_owned(), curve: curve::svg(&stages), facts }))
    }
}

/// Nested tables as dotted keys, in the order of the file.
fn flatten(key: &str, value: &Json, facts: &mut Vec<(String, String)>) {
    match value {
        Json::Object(entries) => {
            for (name, value) in entries {
                flatten(&format!("{key}.{name}"), value, facts);
            }
        }
        value => facts.push((key.to_owned(), plain(value))),
    }
}

fn plain(value: &Json) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

impl Hashes {
    fn of(column: &Column, data: Option<String>) -> Self {
        let mut inputs = Vec::new();
        if let Some(scores) = column.scores {
            inputs.push(("capture", scores.inputs.capture.clone()));
            inputs.push(("maps", scores.inputs.maps.clone()));
            inputs.extend(scores.inputs.relit.clone().map(|relit| ("relit", relit)));
        }
        Self {
            title: column.title.to_owned(),
            data,
            inputs,
            factor: column.factor().map(|factor| format!("{factor:.4}")),
        }
    }
}

impl Definition {
    fn of(metric: &'static Metric) -> Self {
        Self {
            id: metric.id,
            name: metric.name,
            unit: metric.unit,
            direction: metric.direction.symbol(),
            space: metric::space(metric),
            text: metric.definition,
            link: metric.link,
        }
    }
}

impl Times {
    fn of(timing: Timing) -> Self {
        let longest = timing.stages.iter().map(|stage| stage.seconds).fold(0.0, f64::max);
        let total: f64 = timing.stages.iter().map(|stage| stage.seconds).sum();
        let stages = timing.stages.into_iter().map(|stage| TimeRow {
            seconds: format!("{:.1}", stage.seconds),
            share: if longest > 0.0 { (stage.seconds / longest * 1000.0).round() / 10.0 } else { 0.0 },
            cached: stage.cached,
            id: stage.id,
        });
        Self { stages: stages.collect(), total: format!("{total:.1}") }
    }
}

fn copy(from: &Path, to: &Path) -> Result<(), ReportError> {
    let bytes = fs::read(from).map_err(|error| ReportError::read(from, error))?;
    if let Some(parent) = to.parent() {
        fs::create_dir_all(parent).map_err(|error| ReportError::write(parent, error))?;
    }
    fs::write(to, bytes).map_err(|error| ReportError::write(to, error))
}

fn count_pictures(folder: &Path) -> Result<usize, ReportError> {
    let mut count = 0;
    let list = |folder: &Path| -> Result<Vec<std::path::PathBuf>, ReportError> {
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        let entries = fs::read_dir(folder).map_err(|error| ReportError::read(folder, error))?;
        Ok(entries.flatten().map(|entry| entry.path()).collect())
    };
    for case in list(folder)? {
        count += list(&case)?.len();
    }
    Ok(count)
}
