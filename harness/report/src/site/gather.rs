//! Measurements of runs, by capture: two runs are compared where the hashes of their captures are equal.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use scoring::score::{FOUND_LIGHT, Inputs, Scores};

use super::figures::FIGURES;
use crate::comparison_figures::file_name;
use crate::error::ReportError;
use crate::heads;
use crate::run::{Case, Class, Kind, Method, RunFile};
use crate::table::Column;

/// Digits of a hash that distinguish methods.
const HASH: usize = 6;

/// A capture of any of the runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Capture {
    pub hash: String,
    pub case: String,
    pub face: String,
    pub light: String,
    pub variant: String,
    /// A picture of it, below the folder of a run, and which run.
    pub picture: Option<(usize, PathBuf)>,
    /// The page of its head, likewise.
    pub head: Option<(usize, PathBuf)>,
}

/// A method as one of the runs has it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// The method's id, with a mark that distinguishes it from others of this id.
    pub name: String,
    pub title: String,
    pub role: &'static str,
    /// True if it takes part in ranks.
    pub ranked: bool,
    /// The first run that has it.
    pub run: usize,
    id: String,
    pub author: Option<String>,
    /// A hash of its settings and files.
    pub content: Option<String>,
    /// By capture: the hash of the maps, and the figures.
    pub cells: BTreeMap<usize, Cell>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell {
    maps: String,
    /// The run's folder that they lie in.
    pub run: usize,
    pub values: [Option<f64>; FIGURES.len()],
}

/// A run's folder.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    pub folder: PathBuf,
    pub name: String,
    pub suite: String,
    /// Version of the scoring; others may measure otherwise.
    pub scoring: String,
    pub has_report: bool,
}

#[derive(Default)]
pub(super) struct Board {
    pub runs: Vec<Run>,
    pub captures: Vec<Capture>,
    pub entries: Vec<Entry>,
}

/// Scores of a method on a case.
struct Scored<'r> {
    case: &'r Case,
    method: &'r Method,
    inputs: Inputs,
    values: [Option<f64>; FIGURES.len()],
}

impl Board {
    /// Reads the manifests and scores of finished runs; pictures and maps are not opened.
    pub fn of(runs: &[PathBuf]) -> Result<Self, ReportError> {
        let mut board = Self::default();
        let mut captures = BTreeMap::new();
        for (at, folder) in runs.iter().enumerate() {
            let manifest = RunFile::open(folder)?;
            let listed: Vec<(&Case, &Method)> = (manifest.cases.iter())
                .flat_map(|case| case.methods.iter().map(move |method| (case, method)))
                .collect();
            // Each file is read and dropped: of thousands, only the figures stay.
            let scored: Result<Vec<_>, ReportError> =
                listed.into_par_iter().map(|(case, method)| scored(folder, case, method)).collect();
            let scored: Vec<Scored> = scored?.into_iter().flatten().collect();
            if scored.is_empty() {
                return Err(ReportError::NoScores(folder.clone()));
            }
            let mut entries: Vec<Entry> = Vec::new();
            for scored in scored {
                let capture = *captures.entry(scored.inputs.capture.clone()).or_insert_with(|| {
                    board.captures.push(capture(folder, at, &scored));
                    board.captures.len() - 1
                });
                let Scored { method, inputs, values, .. } = scored;
                let cell = Cell { maps: inputs.maps, run: at, values };
                match entries.iter_mut().find(|entry| entry.id == method.id) {
                    Some(entry) => drop(entry.cells.insert(capture, cell)),
                    None => entries.push(Entry::new(method, at, capture, cell)),
                }
            }
            entries.into_iter().for_each(|entry| board.add(entry));
            let scoring = manifest.versions.get("scoring sources").and_then(|v| v.as_str());
            board.runs.push(Run {
                folder: folder.clone(),
                name: name_of(folder),
                suite: manifest.title.unwrap_or(manifest.suite),
                scoring: scoring.unwrap_or_default().to_owned(),
                has_report: folder.join("report/index.html").is_file(),
            });
        }
        board.name_apart();
        Ok(board)
    }

    /// Into the entry of the same method, if there is one.
    fn add(&mut self, entry: Entry) {
        match self.entries.iter_mut().find(|known| known.is_same(&entry)) {
            Some(known) => {
                for (capture, cell) in entry.cells {
                    known.cells.entry(capture).or_insert(cell);
                }
            }
            None => self.entries.push(entry),
        }
    }

    /// Adds distinguishing marks to the names of methods of the same id: authors, hashes, else their runs.
    fn name_apart(&mut self) {
        let mut of_id: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (at, entry) in self.entries.iter().enumerate() {
            of_id.entry(entry.id.clone()).or_default().push(at);
        }
        for at in of_id.into_values().filter(|at| at.len() > 1) {
            let of_all = |mark: &dyn Fn(&Entry) -> Option<String>| -> Vec<Option<String>> {
                at.iter().map(|at| mark(&self.entries[*at])).collect()
            };
            let candidates = [
                of_all(&|entry| entry.author.clone()),
                of_all(&|entry| entry.content.as_ref().map(|hash| format!("#{hash:.HASH$}"))),
                of_all(&|entry| Some(self.runs[entry.run].name.clone())),
            ];
            let mut marks = vec![Vec::new(); at.len()];
            for values in candidates {
                if distinct(&marks) < at.len() && distinct(&values) > 1 {
                    marks.iter_mut().zip(values).for_each(|(marks, value)| marks.extend(value));
                }
            }
            for (at, marks) in at.into_iter().zip(marks).filter(|(_, marks)| !marks.is_empty()) {
                let entry = &mut self.entries[at];
                entry.name = format!("{} ({})", entry.id, marks.join(", "));
            }
        }
    }
}

fn distinct<T: Ord>(values: &[T]) -> usize {
    values.iter().collect::<BTreeSet<_>>().len()
}

impl Entry {
    fn new(method: &Method, run: usize, capture: usize, cell: Cell) -> Self {
        Self {
            name: method.id.clone(),
            title: method.title().to_owned(),
            role: method.role(),
            ranked: method.is_ranked()
                && matches!(method.kind, Kind::Solver | Kind::Baseline)
                && method.class == Class::Passive,
            run,
            id: method.id.clone(),
            author: method.author.clone(),
            content: method.content.clone(),
            cells: BTreeMap::from([(capture, cell)]),
        }
    }

    /// Returns whether both are one method: of one name, author and content, and of the same maps wherever both have some. A
    /// run that does not say the content needs equal maps, or an author, as evidence.
    fn is_same(&self, other: &Self) -> bool {
        let shared =
            || self.cells.iter().filter_map(|(at, cell)| Some((cell, other.cells.get(at)?)));
        let known = self.content.is_some() || self.author.is_some() || shared().next().is_some();
        (&self.id, &self.author, &self.content) == (&other.id, &other.author, &other.content)
            && known
            && shared().all(|(cell, other)| cell.maps == other.maps)
    }
}

fn scored<'r>(
    folder: &Path,
    case: &'r Case,
    method: &'r Method,
) -> Result<Option<Scored<'r>>, ReportError> {
    let Some(path) = method.scores.as_ref().map(|path| folder.join(path)) else { return Ok(None) };
    if !path.is_file() {
        return Ok(None);
    }
    let scores = Scores::read(&path)?;
    let column = Column { method, scores: Some(&scores) };
    let values = std::array::from_fn(|at| FIGURES[at].key.value(&column, &scores.light));
    Ok(Some(Scored { case, method, inputs: scores.inputs, values }))
}

fn capture(folder: &Path, run: usize, scored: &Scored) -> Capture {
    let case = scored.case;
    // The true face in the light of the capture, as the report shows it.
    let pictures = Path::new("report/pictures").join(&case.id).join("truth");
    let mut names: Vec<String> = fs::read_dir(folder.join(&pictures))
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let own = format!("relit-{}-", case.light);
    let chosen = names.iter().find(|name| name.starts_with(&own));
    let chosen = chosen.or_else(|| names.iter().find(|name| name.starts_with("view-")));
    let head = Path::new("report").join(heads::page_of(&file_name(&case.id)));
    Capture {
        hash: scored.inputs.capture.clone(),
        case: case.id.clone(),
        face: case.face.clone(),
        light: match case.light.as_str() {
            FOUND_LIGHT => "unknown (photographs)".to_owned(),
            light => light.to_owned(),
        },
        variant: case.variant.clone().unwrap_or_default(),
        picture: chosen.map(|name| (run, pictures.join(name))),
        head: folder.join(&head).is_file().then_some((run, head)),
    }
}

fn name_of(folder: &Path) -> String {
    let real = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    real.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
