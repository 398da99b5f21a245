//! Contact sheets of what a solve leaves behind beside its maps: the recovered light, its
//! confidence, the maps after each stage, the layers of the training views. All of it optional.

use std::fs;
use std::path::{Path, PathBuf};

use formats::maps::read_deviation;
use formats::picture::{Content, Picture};
use scoring::metrics::{Metric, resample};
use serde::Serialize;

use super::comparison_figures::{self, MethodFolders, Studio, Tile};
use super::difference::{self, Measure};
use super::error::ReportError;
use super::maps::{MAPS, MapKind};
use super::reference::Reference;
use super::tone::{self, Raster};
use super::views::Layer;
use super::{light, table};

/// Longest side of the small pictures.
const STAGE_SIDE: usize = 256;
const VIEW_SIDE: usize = 160;
/// The error in stated deviations at the end of its colours.
const MOST_DEVIATIONS: f32 = 3.0;

/// Small pictures in rows and columns.
#[derive(Debug, Serialize)]
pub(super) struct ContactSheet {
    pub title: &'static str,
    pub caption: String,
    pub columns: Vec<String>,
    pub rows: Vec<SheetRow>,
    /// Width of a picture on the page, as a multiple of the text's size.
    pub tile_rem: f32,
    /// Starts folded: the many pictures are looked at rarely.
    pub folded: bool,
}

#[derive(Debug, Serialize)]
pub(super) struct SheetRow {
    pub title: String,
    /// One per column; none where nothing was made.
    pub tiles: Vec<Option<Tile>>,
}

impl Studio<'_> {
    /// Every sheet that the files of a method allow.
    pub fn sheets(
        &self,
        method: &MethodFolders,
        maps: &Path,
    ) -> Result<Vec<ContactSheet>, ReportError> {
        let group = format!("solve-{}", comparison_figures::file_name(&method.column.method.id));
        let sheets = [
            self.light_sheet(&group, maps)?,
            self.relit_sheet(&group, method)?,
            self.confidence_sheet(&group, method, maps)?,
            self.stage_sheet(&group, maps)?,
            self.layer_sheet(&group, maps)?,
        ];
        Ok(sheets.into_iter().flatten().collect())
    }

    fn light_sheet(&self, group: &str, maps: &Path) -> Result<Option<ContactSheet>, ReportError> {
        let Some(found) = read_colour(&maps.join("light.exr"), Layer::ALL.channels)? else {
            return Ok(None);
        };
        let path = self.frames.root.join("truth/light.exr");
        let truth = read_colour(&path, Layer::ALL.channels)?;
        let averaged = truth.as_ref().and_then(|t| light::in_cells(t, found.width, found.height));
        let (mut columns, mut tiles) = (Vec::new(), Vec::new());
        for (title, name, picture) in [
            ("truth", "light-exact", truth.as_ref()),
            ("truth, mean of each cell", "light-cells", averaged.as_ref()),
            ("recovered", "light", Some(&found)),
        ] {
            if let Some(picture) = picture {
                columns.push(title.to_owned());
                tiles.push(Some(self.save(group, name, &light::raster(picture))?));
            }
        }
        Ok(Some(ContactSheet {
            title: "Light",
            caption: format!(
                "The environment that the method recovered, {} x {} cells, latitude over longitude; \
                 radiance L in the pictures' exposure, shown as L / (1 + L), sRGB curve.",
                found.height, found.width
            ),
            columns,
            rows: vec![SheetRow { title: String::new(), tiles }],
            tile_rem: 16.0,
            folded: false,
        }))
    }

    /// The withheld views of photographs in every light, most of which have no reference.
    fn relit_sheet(
        &self,
        group: &str,
        method: &MethodFolders,
    ) -> Result<Option<ContactSheet>, ReportError> {
        let photographed = self.frames.reference == Reference::Photograph;
        let relit = method.relit.as_ref().filter(|_| photographed);
        let lights = relit.map_or(Ok(Vec::new()), |relit| folders(&relit.join("none")))?;
        let mut rows = Vec::new();
        for frame in &self.frames.test {
            let tile = |folder: &PathBuf| {
                let path = folder.join(format!("{}.exr", frame.name));
                let Some(picture) = read_colour(&path, Layer::ALL.channels)? else {
                    return Ok(None);
                };
                let raster = tone::colour(&tone::shrink(&picture, STAGE_SIDE), 1.0);
                let light = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
                self.save(group, &format!("relit-{light}-{}", frame.name), &raster).map(Some)
            };
            let tiles: Vec<_> = lights.iter().map(tile).collect::<Result<_, ReportError>>()?;
            if tiles.iter().any(Option::is_some) {
                rows.push(SheetRow { title: format!("view {}", frame.name), tiles });
            }
        }
        let names = lights.iter().filter_map(|light| light.file_name());
        let columns = names.map(|name| name.to_string_lossy().into_owned()).collect();
        let caption = "The withheld views with the recovered maps, path-traced in the recovered light \
                       (found), if the method recovers one, and in other lights; linear colour, sRGB curve.";
        Ok((!rows.is_empty()).then(|| ContactSheet {
            title: "Relit",
            caption: caption.to_owned(),
            columns,
            rows,
            tile_rem: 9.5,
            folded: false,
        }))
    }

    fn confidence_sheet(
        &self,
        group: &str,
        method: &MethodFolders,
        maps: &Path,
    ) -> Result<Option<ContactSheet>, ReportError> {
        let Some(found) = comparison_figures::read_if_present(
            &maps.join("confidence.exr"),
            &["Y"],
            Content::Data,
        )?
        else {
            return Ok(None);
        };
        let mut columns = vec!["confidence".to_owned()];
        let mut tiles = vec![Some(self.save(group, "confidence", &tone::grey(&found, 1.0))?)];
        let [error, over_deviation] = self.albedo_errors(method, maps)?;
        for (title, file, raster) in [
            ("error of the diffuse albedo", "confidence-error", error),
            ("error over the stated deviation", "error-over-deviation", over_deviation),
        ] {
            if let Some(raster) = raster {
                columns.push(title.to_owned());
                tiles.push(Some(self.save(group, file, &raster)?));
            }
        }
        let scores = [
            ("confidence", "confidence_rank"),
            ("confidence", "sparsification"),
            ("diffuse_albedo_std", "deviation_68"),
            ("diffuse_albedo_std", "deviation_95"),
        ];
        let scores = scores.into_iter().filter_map(|(subject, id)| {
            let value = method.column.find(subject, None, id, "global")?.value?;
            Some(format!("{} {}", Metric::find(id).ok()?.name, table::shown(Some(value), 2)))
        });
        let scores: Vec<String> = scores.collect();
        let over_deviation = match columns.len() {
            3 => format!(", over the stated standard deviation from 0 to {MOST_DEVIATIONS}"),
            _ => String::new(),
        };
        let error = match columns.len() {
            1 => String::new(),
            _ => format!(
                " Error: {} after one factor, from 0 to {}{over_deviation}; larger values take the last colour, grey \
                 is not scored.",
                Measure::ColourDifference.label(),
                Measure::ColourDifference.top(),
            ),
        };
        let scored =
            if scores.is_empty() { String::new() } else { format!(" {}.", scores.join("; ")) };
        Ok(Some(ContactSheet {
            title: "Confidence",
            caption: format!(
                "The method's confidence in its texels, black 0, white 1.{error}{scored}"
            ),
            columns,
            rows: vec![SheetRow { title: String::new(), tiles }],
            tile_rem: 12.0,
            folded: false,
        }))
    }

    /// The diffuse albedo after its one factor against the truth, in false colour: its error, and the error over the
    /// deviation that the method states.
    fn albedo_errors(
        &self,
        method: &MethodFolders,
        maps: &Path,
    ) -> Result<[Option<Raster>; 2], ReportError> {
        let folder = self.frames.root.join("truth");
        let read =
            |folder: &Path| read_colour(&folder.join("diffuse_albedo.exr"), Layer::ALL.channels);
        let (Some(albedo), Some(truth)) = (read(maps)?, read(&folder)?) else {
            return Ok([None, None]);
        };
        let albedo = resample(&albedo, truth.width, truth.height);
        let mask = comparison_figures::read_mask_if_present(&folder.join("coverage.png"))?;
        let (measure, factor) = (Measure::ColourDifference, method.column.factor().unwrap_or(1.0));
        let field = difference::field(&albedo, &truth, mask.as_ref(), measure, factor);
        let error = field.map(|field| tone::false_colour(&field, measure.top()));
        let stated = read_deviation(maps, "diffuse_albedo", Layer::ALL.channels);
        let field = stated.map_err(ReportError::from)?.and_then(|stated| {
            let stated = resample(&stated, truth.width, truth.height);
            difference::over_deviation(&albedo, &truth, &stated, mask.as_ref(), factor)
        });
        Ok([error, field.map(|field| tone::false_colour(&field, MOST_DEVIATIONS))])
    }

    fn stage_sheet(&self, group: &str, maps: &Path) -> Result<Option<ContactSheet>, ReportError> {
        let stages = folders(&maps.join("stages"))?;
        let truth = self.truth();
        let mut rows = Vec::new();
        for kind in &MAPS {
            let file = format!("{}.exr", kind.subject);
            if !stages.iter().any(|stage| stage.join(&file).is_file()) {
                continue;
            }
            let columns = stages.iter().map(PathBuf::as_path).chain([maps]);
            let tiles = (columns.chain(truth.as_deref()))
                .enumerate()
                .map(|(column, folder)| self.stage_tile(group, kind, column, &folder.join(&file)))
                .collect::<Result<_, _>>()?;
            rows.push(SheetRow { title: kind.title.to_owned(), tiles });
        }
        if rows.is_empty() {
            return Ok(None);
        }
        let mut columns: Vec<String> = stages.iter().map(|stage| stage_title(stage)).collect();
        columns.push("result".to_owned());
        columns.extend(truth.map(|_| Reference::Truth.word().to_owned()));
        Ok(Some(ContactSheet {
            title: "Maps after each stage",
            caption: "What each stage changed, with the factors of the result; shown as above."
                .to_owned(),
            columns,
            rows,
            tile_rem: 9.5,
            folded: false,
        }))
    }

    /// The folder of the truth, of a capture that has one.
    fn truth(&self) -> Option<PathBuf> {
        let rendered = self.frames.reference == Reference::Truth;
        rendered.then(|| self.frames.root.join("truth"))
    }

    fn stage_tile(
        &self,
        group: &str,
        kind: &MapKind,
        column: usize,
        path: &Path,
    ) -> Result<Option<Tile>, ReportError> {
        let Some(map) = comparison_figures::read_if_present(path, kind.channels, kind.content())?
        else {
            return Ok(None);
        };
        let raster = kind.show.raster(&tone::shrink(&map, STAGE_SIDE));
        Ok(Some(self.save(group, &format!("stage-{column:02}-{}", kind.subject), &raster)?))
    }

    fn layer_sheet(&self, group: &str, maps: &Path) -> Result<Option<ContactSheet>, ReportError> {
        let folder = maps.join("layers");
        let of = |name: &str| folder.join(format!("{name}.exr"));
        let frames: Vec<_> =
            self.frames.train.iter().filter(|frame| of(&frame.name).is_file()).collect();
        if frames.is_empty() {
            return Ok(None);
        }
        let truth = self.truth().map(|truth| truth.join("layers"));
        let mut rows = Vec::new();
        for (title, name, layer, folder) in [
            ("input", "input", Layer::ALL, None),
            ("recovered", "whole", Layer::ALL, Some(&folder)),
            ("diffuse, truth", "diffuse-exact", Layer::DIFFUSE, truth.as_ref()),
            ("diffuse, recovered", "diffuse", Layer::DIFFUSE, Some(&folder)),
            ("specular, truth", "specular-exact", Layer::SPECULAR, truth.as_ref()),
            ("specular, recovered", "specular", Layer::SPECULAR, Some(&folder)),
        ] {
            if folder.is_none() && name != "input" {
                continue;
            }
            let tile = |frame: &&super::run::Frame| {
                let path = match folder {
                    Some(folder) => folder.join(format!("{}.exr", frame.name)),
                    None => frame.image.clone(),
                };
                let Some(picture) = read_colour(&path, layer.channels)? else {
                    return Ok(None);
                };
                let small = tone::shrink(&picture, VIEW_SIDE);
                let raster = tone::colour(&small, layer.exposure);
                self.save(group, &format!("layer-{}-{name}", frame.name), &raster).map(Some)
            };
            let tiles: Vec<_> = frames.iter().map(tile).collect::<Result<_, ReportError>>()?;
            if tiles.iter().any(Option::is_some) {
                rows.push(SheetRow { title: title.to_owned(), tiles });
            }
        }
        let beside = if truth.is_some() { " beside the true one" } else { "" };
        Ok(Some(ContactSheet {
            title: "Layers of the training views",
            caption: format!(
                "The method's split of the inputs into layers{beside}; linear colour, sRGB curve, the \
                 specular layer × {}.",
                Layer::SPECULAR.exposure
            ),
            columns: frames.iter().map(|frame| frame.name.clone()).collect(),
            rows,
            tile_rem: 7.0,
            folded: true,
        }))
    }
}

/// A picture or layer that may be absent.
fn read_colour(path: &Path, channels: &[&str]) -> Result<Option<Picture>, ReportError> {
    comparison_figures::read_if_present(path, channels, Content::Colour)
}

/// The folders below one that may be absent, by name.
fn folders(folder: &Path) -> Result<Vec<PathBuf>, ReportError> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let read = |error| ReportError::read(folder, error);
    let mut folders = Vec::new();
    for entry in fs::read_dir(folder).map_err(read)? {
        folders.push(entry.map_err(read)?.path());
    }
    folders.retain(|path| path.is_dir());
    folders.sort();
    Ok(folders)
}

/// The stage's name without its number.
fn stage_title(folder: &Path) -> String {
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match name.split_once('-') {
        Some((number, title)) if number.bytes().all(|byte| byte.is_ascii_digit()) => {
            title.to_owned()
        }
        _ => name,
    }
}
