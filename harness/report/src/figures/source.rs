//! The runs that a figure is made of.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use scoring::score::{FOUND_LIGHT, Scores};

use super::request::FigureRequest;
use crate::error::ReportError;
use crate::page::{columns, read_scores};
use crate::reference::Reference;
use crate::run::{Case, Class, Frames, Kind, RunFile, read_json_if_present};
use crate::solve::interrupted;
use crate::table::Column;

/// Cases of all runs, and which methods the figure is of.
pub(super) struct Sources {
    /// The runs' folders, in words.
    runs: String,
    cases: Vec<LoadedCase>,
    methods: Vec<String>,
}

struct LoadedCase {
    run: PathBuf,
    case: Case,
    scores: Vec<Option<Scores>>,
}

/// One case, with the columns of its methods in the order of the suite.
pub(super) struct CaseSource<'a> {
    pub run: &'a Path,
    pub case: &'a Case,
    pub columns: Vec<Column<'a>>,
}

impl Sources {
    pub fn read(request: &FigureRequest) -> Result<Self, ReportError> {
        let (mut cases, mut all) = (Vec::new(), Vec::new());
        for run in &request.runs {
            for case in RunFile::open(run)?.cases {
                all.push(case.id.clone());
                if request.cases.is_empty() || request.cases.contains(&case.id) {
                    let scores = read_scores(run, &case)?;
                    cases.push(LoadedCase { run: run.clone(), case, scores });
                }
            }
        }
        let runs: Vec<String> = request.runs.iter().map(|run| run.display().to_string()).collect();
        let runs = runs.join(", ");
        let unknown = |given: &[String], known: Vec<String>, what: &'static str| match given
            .iter()
            .find(|name| !known.contains(name))
        {
            Some(name) => {
                let (name, runs, known) = (name.clone(), runs.clone(), known.join(", "));
                Err(ReportError::Unknown { what, name, runs, known })
            }
            None => Ok(()),
        };
        unknown(&request.cases, all, "case")?;
        let methods = cases.iter().flat_map(|loaded| &loaded.case.methods);
        let methods = methods.map(|method| method.id.clone());
        unknown(&request.methods, distinct(methods), "method")?;
        Ok(Self { runs, cases, methods: request.methods.clone() })
    }

    pub fn cases(&self) -> impl Iterator<Item = CaseSource<'_>> {
        self.cases.iter().map(|loaded| CaseSource {
            run: &loaded.run,
            case: &loaded.case,
            columns: columns_in_order(&loaded.case, &loaded.scores),
        })
    }

    /// Returns whether a figure of solvers shows this column: one that was named, or else every solver of what all are
    /// given.
    pub fn shows(&self, column: &Column) -> bool {
        if self.methods.is_empty() {
            column.method.kind == Kind::Solver && column.method.class == Class::Passive
        } else {
            self.is_named(column)
        }
    }

    /// Returns whether a figure of all methods shows this column.
    pub fn lists(&self, column: &Column) -> bool {
        self.methods.is_empty() || self.is_named(column)
    }

    /// A sentence that names the interrupted solves among those that the figure shows; empty without one.
    pub fn interrupted(&self) -> Result<String, ReportError> {
        let mut cut = Vec::new();
        for case in self.cases() {
            for column in case.columns.iter().filter(|column| self.shows(column)) {
                let Some(maps) = &column.method.maps else { continue };
                let record = read_json_if_present(&case.run.join(maps).join("solve.json"))?;
                if record.as_ref().and_then(interrupted).is_some() {
                    cut.push(format!("{} on {}", column.method.title(), case.case.id));
                }
            }
        }
        Ok(match cut.is_empty() {
            true => String::new(),
            false => format!(" Interrupted solves, with their maps so far: {}.", cut.join(", ")),
        })
    }

    fn is_named(&self, column: &Column) -> bool {
        self.methods.contains(&column.method.id)
    }

    /// The runs hold nothing that the figure could show.
    pub fn nothing(&self, wanted: &str) -> ReportError {
        let cases = self.cases.iter().map(|loaded| {
            let Case { id, face, light, variant, .. } = &loaded.case;
            let variant = variant.as_ref().map_or(String::new(), |name| format!(", {name}"));
            match light.as_str() {
                FOUND_LIGHT => format!("{id} (photographs, light unknown)"),
                light => format!("{id} (face {face}, light {light}{variant})"),
            }
        });
        let methods = self.cases.iter().flat_map(|loaded| &loaded.case.methods);
        let methods = methods.map(|method| format!("{} ({})", method.id, method.role()));
        let chosen = match self.methods.is_empty() {
            true => "of which it shows the solvers (others with --method)".to_owned(),
            false => format!("of which it shows {}", self.methods.join(", ")),
        };
        let [cases, methods] = [distinct(cases), distinct(methods)].map(|names| names.join(", "));
        ReportError::NoFigure {
            runs: self.runs.clone(),
            wanted: wanted.to_owned(),
            has: format!("the cases {cases}; and the methods {methods}, {chosen}"),
        }
    }
}

/// Each name once, in their order.
fn distinct(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut seen = BTreeSet::new();
    names.filter(|name| seen.insert(name.clone())).collect()
}

/// In the order of the suite, not of the report.
fn columns_in_order<'a>(case: &'a Case, scores: &'a [Option<Scores>]) -> Vec<Column<'a>> {
    let mut columns = columns(case, scores);
    let place = |column: &Column| case.methods.iter().position(|m| m.id == column.method.id);
    columns.sort_by_key(place);
    columns
}

impl CaseSource<'_> {
    pub fn frames(&self) -> Result<Frames, ReportError> {
        Frames::read(&self.run.join(&self.case.capture))
    }

    /// The face, with its variant.
    pub fn face(&self) -> String {
        match &self.case.variant {
            Some(variant) => format!("{}, {variant}", self.case.face),
            None => self.case.face.clone(),
        }
    }

    /// A file of a method's maps folder.
    pub fn map(&self, column: &Column, file: &str) -> Option<PathBuf> {
        Some(self.run.join(column.method.maps.as_ref()?).join(file))
    }

    /// A picture of a method's maps in a light, after the albedo's one factor if it was rendered so.
    pub fn relit(&self, column: &Column, light: &str, frame: &str) -> Option<PathBuf> {
        let folder = self.run.join(column.method.relit.as_ref()?);
        let scale = if folder.join("global").is_dir() { "global" } else { "none" };
        Some(folder.join(scale).join(light).join(format!("{frame}.exr")))
    }

    /// A file of the truth.
    pub fn truth(&self, file: &str) -> PathBuf {
        self.run.join(&self.case.capture).join("truth").join(file)
    }

    /// The reference of its pictures.
    pub fn reference(&self) -> Reference {
        Reference::of(&self.run.join(&self.case.capture))
    }

    /// The lights that any method was relit in and scored, the capture's own first.
    pub fn lights(&self) -> Vec<String> {
        let rows = self.columns.iter().flat_map(Column::rows);
        let mut lights: Vec<String> =
            rows.filter(|row| row.subject == "relit").filter_map(|row| row.light.clone()).collect();
        lights.sort_by_key(|light| (*light != self.case.light, light.clone()));
        lights.dedup();
        lights
    }
}
