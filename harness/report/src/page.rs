//! Everything the page shows, gathered from a run and laid out by the templates.

use std::collections::BTreeSet;
use std::path::Path;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, UndefinedBehavior};
use scoring::metrics::{METRICS, Metric};
use scoring::score::{Protocol, Row, Scores};
use serde::Serialize;
use serde_json::json;

use super::case::CaseView;
use super::error::ReportError;
use super::exports::{Export, Links};
use super::heads;
use super::link::WayToRun;
use super::matrix::{self, Matrix};
use super::reference::Reference;
use super::run::{self, Case, Method, RunFile, SolverTiming, Timing};
use super::solve::plain;
use super::summary::{Heading, Summary};
use super::table::Column;
use super::tone;

/// Stands in every page.
const MARK: &str = "<meta name=\"generator\" content=\"unshade report\">";

/// Observer of the work: number of cases done, number of cases, name of the next one. Returns whether to
/// continue.
pub type ProgressCallback<'a> = dyn FnMut(u64, u64, &str) -> bool + 'a;

/// Every template by the name that others include it by.
pub(super) const TEMPLATES: [(&str, &str); 11] = [
    ("index.html", include_str!("templates/index.html")),
    ("table.html", include_str!("templates/table.html")),
    ("comparison_figure.html", include_str!("templates/comparison_figure.html")),
    ("matrix.html", include_str!("templates/matrix.html")),
    ("solve.html", include_str!("templates/solve.html")),
    ("reading.html", include_str!("templates/reading.html")),
    ("lead.html", include_str!("templates/lead.html")),
    ("style.css", include_str!("templates/style.css")),
    ("slider.js", include_str!("templates/slider.js")),
    ("tables.js", include_str!("templates/tables.js")),
    ("viewer.js", include_str!("templates/viewer.js")),
];

/// The page as the templates see it.
#[derive(Serialize)]
pub(super) struct Page {
    title: String,
    suite: String,
    heat: String,
    mark: &'static str,
    summary: Summary,
    summary_export: Links,
    /// True if any case was rendered, and whether any was photographed.
    has_truth: bool,
    has_photographs: bool,
    run: String,
    matrices: Vec<Matrix>,
    cases: Vec<CaseView>,
    metrics: Vec<Definition>,
    protocols: Vec<Protocol>,
    versions: Vec<(String, String)>,
    suite_toml: Option<String>,
    times: Times,
    has_every_score: bool,
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
    /// The share of the longest stage.
    percent: f64,
    cached: bool,
    /// A part of the stage above.
    part: bool,
}

impl Page {
    /// Reads the run, and writes the pictures and the scores below `root`.
    pub fn make(
        run: &Path,
        manifest: &RunFile,
        root: &Path,
        way: &WayToRun,
        progress: &mut ProgressCallback,
    ) -> Result<Self, ReportError> {
        let scores = manifest.cases.iter().map(|case| read_scores(run, case));
        let scores: Vec<Vec<Option<Scores>>> = scores.collect::<Result<_, _>>()?;
        let pairs = manifest.cases.iter().zip(&scores);
        let columns: Vec<Vec<Column>> = pairs.map(|(case, scores)| columns(case, scores)).collect();
        let timing: Timing =
            run::read_json_if_present(&run.join("timing.json"))?.unwrap_or_default();
        let mut cases = Vec::new();
        heads::write_viewer(root)?;
        for (done, (case, columns)) in manifest.cases.iter().zip(&columns).enumerate() {
            if !progress(done as u64, manifest.cases.len() as u64, &case.id) {
                return Err(ReportError::Interrupted);
            }
            cases.push(CaseView::make(run, case, columns, &timing, root, way)?);
        }
        let references: Vec<Reference> =
            manifest.cases.iter().map(|case| Reference::of(&run.join(&case.capture))).collect();
        let summarised = manifest.cases.iter().zip(&columns).zip(&references);
        let summarised = summarised.map(|((case, columns), at)| (case, columns.as_slice(), *at));
        let summary = Summary::of(&summarised.collect::<Vec<_>>());
        let pairs = manifest.cases.iter().zip(&cases).zip(&columns);
        let sources = pairs.map(|((case, view), columns)| matrix::Source {
            face: &case.face,
            variant: case.variant.as_deref(),
            light: &case.light,
            columns,
            figures: &view.views,
            input: view.main_input(),
        });
        let rows: Vec<&Row> = columns.iter().flatten().flat_map(Column::rows).collect();
        let used = |metric: &&Metric| rows.iter().any(|row| row.metric == metric.id);
        let matrices = matrix::matrices(&sources.collect::<Vec<_>>());
        Ok(Self {
            title: manifest.title.clone().unwrap_or_else(|| manifest.suite.clone()),
            suite: manifest.suite.clone(),
            heat: tone::heat_gradient(),
            mark: MARK,
            summary_export: exported(&summary).write(root, "tables", "key-figures")?,
            run: way.to(Path::new("")).trim_end_matches('/').to_owned(),
            summary,
            has_truth: references.contains(&Reference::Truth),
            has_photographs: references.contains(&Reference::Photograph),
            matrices,
            cases,
            metrics: METRICS
                .iter()
                .filter(used)
                .chain(own_metrics(&scores))
                .map(Definition::of)
                .collect(),
            protocols: protocols(scores.iter().flatten().flatten()),
            versions: manifest.versions.iter().map(|(k, v)| (k.clone(), plain(v))).collect(),
            suite_toml: manifest.suite_toml.clone(),
            times: Times::of(run, manifest, timing)?,
            has_every_score: scores.iter().flatten().all(Option::is_some)
                && scores.iter().flatten().flatten().any(|scores| !scores.rows.is_empty()),
        })
    }

    /// Returns whether every method was scored in every case, and any of them has a score.
    pub fn has_every_score(&self) -> bool {
        self.has_every_score
    }

    /// The page's text.
    pub fn html(&self) -> Result<String, ReportError> {
        let mut environment = Environment::new();
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment
            .set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build()?);
        for (name, text) in TEMPLATES {
            environment.add_template(name, text)?;
        }
        let html = environment.get_template("index.html")?.render(Value::from(Serde(self)))?;
        // The engine escapes the slashes of paths too, for templates without quoted attributes.
        Ok(html.replace("&#x2f;", "/"))
    }
}

pub(super) fn read_scores(run: &Path, case: &Case) -> Result<Vec<Option<Scores>>, ReportError> {
    let read = |method: &Method| match &method.scores {
        Some(path) if run.join(path).exists() => Ok(Some(Scores::read(&run.join(path))?)),
        _ => Ok(None),
    };
    case.methods.iter().map(read).collect()
}

/// The key figures as files: numbers in CSV and JSON, as they are shown in LaTeX.
fn exported(summary: &Summary) -> Export {
    let described = ["case", "method"].map(str::to_owned);
    let columns = |heading: &Heading| heading.columns.iter();
    let names = summary.headings.iter().flat_map(columns).map(|(name, _)| (*name).to_owned());
    let shown_names = summary.headings.iter().map(|heading| heading.name.to_owned());
    let (mut rows, mut shown) = (Vec::new(), Vec::new());
    for case in &summary.cases {
        for row in &case.rows {
            let described = [&case.id, &row.title];
            let figures =
                summary.headings.iter().zip(&row.figures).flat_map(|(heading, figure)| {
                    columns(heading).map(|(_, number)| json!(number(figure)))
                });
            rows.push(described.map(|text| json!(text)).into_iter().chain(figures).collect());
            shown.push(described.into_iter().chain(&row.cells).cloned().collect());
        }
    }
    Export {
        keys: described.iter().cloned().chain(names).collect(),
        rows,
        headings: described.into_iter().chain(shown_names).collect(),
        shown,
    }
}

/// Each protocol once, in the order in which the scores name them.
fn protocols<'a>(scores: impl Iterator<Item = &'a Scores>) -> Vec<Protocol> {
    let mut protocols: Vec<Protocol> = Vec::new();
    for Scores { protocol, .. } in scores {
        if !protocols.contains(protocol) {
            protocols.push(protocol.clone());
        }
    }
    protocols
}

/// The metrics that users wrote, as the scores state them.
fn own_metrics(scores: &[Vec<Option<Scores>>]) -> Vec<&'static Metric> {
    let stated = scores.iter().flatten().flatten().flat_map(|scores| &scores.metrics);
    let ids: BTreeSet<&str> = stated.map(|metric| metric.id.as_str()).collect();
    ids.into_iter().filter_map(|id| Metric::find(id).ok()).collect()
}

/// Solvers first, then the baselines to beat, then the oracle that bounds them.
pub(super) fn columns<'a>(case: &'a Case, scores: &'a [Option<Scores>]) -> Vec<Column<'a>> {
    let pairs = case.methods.iter().zip(scores);
    let mut columns: Vec<Column> =
        pairs.map(|(method, scores)| Column { method, scores: scores.as_ref() }).collect();
    columns.sort_by_key(|column| (column.method.class, column.method.kind));
    columns
}

impl Definition {
    fn of(metric: &'static Metric) -> Self {
        Self {
            id: metric.id,
            name: metric.name,
            unit: metric.unit,
            direction: metric.direction.symbol(),
            space: metric.quantity.space(),
            text: metric.definition,
            link: metric.link,
        }
    }
}

impl Times {
    /// The stages of the run, each solve followed by its own stages.
    fn of(run: &Path, manifest: &RunFile, timing: Timing) -> Result<Self, ReportError> {
        let total: f64 = timing.stages.iter().map(|stage| stage.seconds).sum();
        let longest = timing.stages.iter().map(|stage| stage.seconds).fold(0.0, f64::max);
        let row = |id: String, seconds: f64, cached: bool, part: bool| TimeRow {
            id,
            seconds: format!("{seconds:.1}"),
            percent: if longest > 0.0 { (seconds / longest * 1000.0).round() / 10.0 } else { 0.0 },
            cached,
            part,
        };
        let mut stages = Vec::new();
        for stage in timing.stages {
            let solvers = manifest.cases.iter().flat_map(|case| &case.methods);
            let maps: Vec<_> = solvers.filter_map(|solver| solver.maps.as_ref()).collect();
            let solve = maps.into_iter().find(|maps| **maps == Path::new(&stage.id));
            stages.push(row(stage.id, stage.seconds, stage.cached, false));
            let Some(maps) = solve else { continue };
            let path = run.join(maps).join("timing.json");
            let parts = run::read_json_if_present::<SolverTiming>(&path)?;
            for (name, seconds) in parts.into_iter().flat_map(|parts| parts.seconds) {
                stages.extend(seconds.as_f64().map(|seconds| row(name, seconds, false, true)));
            }
        }
        Ok(Self { stages, total: format!("{total:.1}") })
    }
}
