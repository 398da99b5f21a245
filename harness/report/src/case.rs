//! One case of the page: its table, pictures, optimisation and provenance.

use std::fs;
use std::path::{Path, PathBuf};

use scoring::score::RegionSize;
use serde::Serialize;

use super::comparison_figures::{self, ComparisonFigure, Input, MethodFolders, Studio, Tile};
use super::error::ReportError;
use super::exports::{Export, Links};
use super::heads::Head;
use super::lead::{self, Lead};
use super::link::WayToRun;
use super::methods::{self as made, MethodRow};
use super::reference::Reference;
use super::run::{Case, Frames, Timing};
use super::save::write_file;
use super::solve::Solve;
use super::table::{self, Column, Table};

/// A case as the templates see it.
#[derive(Serialize)]
pub(super) struct CaseView {
    id: String,
    anchor: String,
    face: String,
    light: String,
    variant: Option<String>,
    photographed: bool,
    train: usize,
    test: usize,
    inputs: Vec<Input>,
    methods: Vec<MethodRow>,
    table: Table,
    complete: Table,
    regions: Vec<Region>,
    maps: Vec<ComparisonFigure>,
    lead: Option<Lead>,
    head: Head,
    exports: [Links; 2],
    pub views: Vec<ComparisonFigure>,
    layers: Vec<ComparisonFigure>,
    solves: Vec<Solve>,
    hashes: Vec<Hashes>,
    scene_toml: Option<String>,
}

/// The part of the truth that a region holds.
#[derive(Serialize)]
struct Region {
    name: String,
    pixels: usize,
    mask_percent: String,
    /// Per column: the share for which the method had data.
    solved: Vec<String>,
}

/// The contents that one column's scores were computed from.
#[derive(Serialize)]
struct Hashes {
    title: String,
    data: Option<String>,
    inputs: Vec<(&'static str, String)>,
    factor: Option<String>,
}

fn regions(columns: &[Column]) -> Vec<Region> {
    let sizes = |column: &Column| column.scores.map_or_else(Vec::new, |s| s.regions.clone());
    let all: Vec<Vec<RegionSize>> = columns.iter().map(sizes).collect();
    let percent = |fraction: Option<f64>| {
        fraction.map_or(table::EMPTY.to_owned(), |fraction| format!("{:.1} %", fraction * 100.0))
    };
    let solved = |sizes: &Vec<RegionSize>, region: &str| {
        percent(sizes.iter().find(|size| size.region == region).and_then(|size| size.solved))
    };
    // A method without views has fewer regions than one with them.
    let known = all.iter().max_by_key(|sizes| sizes.len()).into_iter().flatten();
    known
        .map(|size| Region {
            name: size.region.clone(),
            pixels: size.pixels,
            mask_percent: percent(Some(size.share)),
            solved: all.iter().map(|sizes| solved(sizes, &size.region)).collect(),
        })
        .collect()
}

impl CaseView {
    /// Reads the case from the run, and writes its pictures and scores below `root`.
    pub fn make(
        run: &Path,
        case: &Case,
        columns: &[Column],
        timing: &Timing,
        root: &Path,
        way: &WayToRun,
    ) -> Result<Self, ReportError> {
        let capture = run.join(&case.capture);
        let frames = Frames::read(&capture)?;
        let below = |path: &Option<PathBuf>| path.as_ref().map(|path| run.join(path));
        let methods: Vec<MethodFolders> = columns
            .iter()
            .map(|column| MethodFolders {
                column,
                maps: below(&column.method.maps),
                relit: below(&column.method.relit),
            })
            .collect();
        let anchor = comparison_figures::file_name(&case.id);
        let studio = Studio {
            frames: &frames,
            light: &case.light,
            methods: &methods,
            root,
            folder: &format!("pictures/{anchor}"),
            run,
            way,
        };
        let mut solves = Vec::new();
        let mut hashes = Vec::new();
        for method in &methods {
            let MethodFolders { column, maps, .. } = method;
            if let Some(maps) = maps {
                solves.extend(studio.solve(method, maps)?);
            }
            let mut data = None;
            if let Some(path) = below(&column.method.scores).filter(|path| path.exists()) {
                let name = comparison_figures::file_name(&column.method.id);
                let target = format!("data/{anchor}/{name}.json");
                copy(&path, &root.join(&target))?;
                data = Some(target);
            }
            hashes.push(Hashes::of(column, data));
        }
        let (table, complete) =
            (table::chosen(columns, &case.light), table::complete(columns, &case.light));
        let save = |table: &Table, name: &str| {
            Export::of_scores(table).write(root, &format!("tables/{anchor}"), name)
        };
        let exports = [save(&table, "scores")?, save(&complete, "every-score")?];
        let (inputs, maps, views) =
            (studio.inputs()?, studio.map_figures()?, studio.view_figures()?);
        let input = main_input(&inputs, &views);
        let lead = lead::lead(&views, &maps, &table, &case.light, input);
        Ok(Self {
            id: case.id.clone(),
            face: case.face.clone(),
            light: case.light.clone(),
            variant: case.variant.clone(),
            photographed: frames.reference == Reference::Photograph,
            train: frames.train.len(),
            test: frames.test.len(),
            inputs,
            methods: made::rows(run, case, columns, timing, root)?,
            table,
            complete,
            lead,
            head: Head::write(case, &capture, &methods, &anchor, root)?,
            exports,
            regions: regions(columns),
            maps,
            views,
            layers: studio.layer_figures()?,
            solves,
            hashes,
            scene_toml: fs::read_to_string(capture.join("truth/scene.toml")).ok(),
            anchor,
        })
    }

    /// The training view nearest to the first withheld one.
    pub fn main_input(&self) -> Option<&Tile> {
        main_input(&self.inputs, &self.views)
    }
}

fn main_input<'a>(inputs: &'a [Input], views: &[ComparisonFigure]) -> Option<&'a Tile> {
    let index = views.first()?.strips.first()?.input?;
    Some(&inputs.get(index)?.tile)
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
            title: column.method.title().to_owned(),
            data,
            inputs,
            factor: column.factor().map(|factor| format!("{factor:.4}")),
        }
    }
}

fn copy(from: &Path, to: &Path) -> Result<(), ReportError> {
    let bytes = fs::read(from).map_err(|error| ReportError::read(from, error))?;
    write_file(to, bytes)
}
