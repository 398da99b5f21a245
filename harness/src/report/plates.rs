//! The pictures of a case: for every map and every withheld view one plate of input, truth,
//! what each method made of it, and its error in false colour.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use solver::picture::{self, GrayImage, Picture};

use super::ReportError;
use super::difference::{self, Measure};
use super::run::{Frame, Frames};
use super::scores::Row;
use super::table::{self, Column};
use super::tone::{self, Raster};

/// A training view.
#[derive(Debug, Serialize)]
pub(super) struct Input {
    pub title: String,
    pub tile: Tile,
}

/// The tile of one picture, with its place below the report's folder.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Tile {
    pub src: String,
    pub width: usize,
    pub height: usize,
}

/// One method's picture and errors in a row; absent where it made none.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Entry {
    pub picture: Option<Tile>,
    pub caption: String,
    /// One per entry of [`Strip::errors`].
    pub errors: Vec<Option<Tile>>,
}

/// One truth and what the methods made of it.
#[derive(Debug, Serialize)]
pub(super) struct Strip {
    pub title: String,
    /// Which of the case's inputs lies nearest to the view.
    pub input: Option<usize>,
    pub truth: Tile,
    /// What each line of error pictures compares.
    pub errors: Vec<String>,
    /// One per column of the case.
    pub entries: Vec<Entry>,
}

/// A figure: strips with one tone and one scale of errors.
#[derive(Debug, Serialize)]
pub(super) struct Plate {
    /// The subject and light of the scores that belong to it.
    #[serde(skip)]
    pub subject: (String, Option<String>),
    pub id: String,
    pub title: String,
    pub tone: String,
    pub error: &'static str,
    /// The error at the end of the colour bar.
    pub top: String,
    pub unit: &'static str,
    pub strips: Vec<Strip>,
}

/// How a picture becomes visible.
#[derive(Clone, Copy)]
enum Show {
    Colour { exposure: f32 },
    Grey { white: f32 },
    Normal,
}

impl Show {
    fn raster(self, picture: &Picture) -> Raster {
        match self {
            Show::Colour { exposure } => tone::colour(picture, exposure),
            Show::Grey { white } => tone::grey(picture, white),
            Show::Normal => tone::normals(picture),
        }
    }

    fn words(self) -> String {
        match self {
            Show::Colour { exposure } => format!("linear colour × {exposure}, sRGB curve"),
            Show::Grey { white } => format!("black 0, white {white}, no curve"),
            Show::Normal => "object space, n · 0.5 + 0.5, no curve".to_owned(),
        }
    }
}

/// A map as it is shown and compared.
struct MapKind {
    subject: &'static str,
    title: &'static str,
    channels: &'static [&'static str],
    show: Show,
    measure: Measure,
    metric: &'static str,
}

const RGB: &[&str] = &["R", "G", "B"];
const MAPS: [MapKind; 4] = [
    MapKind {
        subject: "diffuse_albedo",
        title: "Diffuse albedo",
        channels: RGB,
        show: Show::Colour { exposure: 1.0 },
        measure: Measure::ColourDifference,
        metric: "psnr_srgb",
    },
    MapKind {
        subject: "specular_albedo",
        title: "Specular albedo",
        channels: &["Y"],
        show: Show::Grey { white: 0.05 },
        measure: Measure::Value,
        metric: "rmse",
    },
    MapKind {
        subject: "specular_normal",
        title: "Specular normal",
        channels: RGB,
        show: Show::Normal,
        measure: Measure::Angle,
        metric: "normal_mean_deg",
    },
    MapKind {
        subject: "diffuse_normal",
        title: "Diffuse normal",
        channels: RGB,
        show: Show::Normal,
        measure: Measure::Angle,
        metric: "normal_mean_deg",
    },
];

/// One method's column and its folders below the run, which may be absent.
pub(super) struct Method<'a> {
    pub column: &'a Column<'a>,
    pub maps: Option<PathBuf>,
    pub relit: Option<PathBuf>,
}

/// Makes the plates of one case and writes their pictures.
pub(super) struct Studio<'a> {
    pub capture: &'a Path,
    pub light: &'a str,
    pub frames: &'a Frames,
    pub methods: &'a [Method<'a>],
    /// The report's folder, and where below it this case's pictures go.
    pub root: &'a Path,
    pub folder: &'a str,
}

impl Studio<'_> {
    fn save(&self, name: &str, raster: &Raster) -> Result<Tile, ReportError> {
        let src = format!("{}/{}.png", self.folder, file_name(name));
        let path = self.root.join(&src);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|error| ReportError::write(parent, error))?;
        }
        raster.save(&path)?;
        Ok(Tile { src, width: raster.width, height: raster.height })
    }

    /// The training views.
    pub fn inputs(&self) -> Result<Vec<Input>, ReportError> {
        let mut inputs = Vec::new();
        for frame in &self.frames.train {
            let raster = tone::colour(&picture::read_exr_rgb(&frame.image)?, 1.0);
            let tile = self.save(&format!("input-{}", frame.name), &raster)?;
            inputs.push(Input { title: format!("input view {}", frame.name), tile });
        }
        Ok(inputs)
    }

    /// One plate per map that the capture knows the truth of.
    pub fn map_plates(&self) -> Result<Vec<Plate>, ReportError> {
        MAPS.iter().filter_map(|kind| self.map_plate(kind).transpose()).collect()
    }

    fn map_plate(&self, kind: &MapKind) -> Result<Option<Plate>, ReportError> {
        let file = format!("{}.exr", kind.subject);
        let Some(truth) = read_if_present(&self.capture.join("truth").join(&file), kind.channels)?
        else {
            return Ok(None);
        };
        let coverage = read_mask_if_present(&self.capture.join("truth/coverage.png"))?;
        let scaled = kind.subject == "diffuse_albedo";
        let mut errors = vec!["error".to_owned()];
        if scaled {
            errors.push("error after the one factor".to_owned());
        }
        let mut entries = Vec::new();
        for method in self.methods {
            let map = match &method.maps {
                Some(maps) => read_if_present(&maps.join(&file), kind.channels)?,
                None => None,
            };
            let Some(map) = map else {
                entries.push(Entry::default());
                continue;
            };
            let map = difference::resample(&map, truth.width, truth.height);
            let global = method.column.scores.and_then(|scores| scores.scale.as_ref()?.global);
            let mut factors = vec![Some(1.0)];
            if scaled {
                factors.push(global);
            }
            let name = format!("{}-{}", method.column.id, kind.subject);
            let raster = kind.show.raster(&map);
            let compared = Compared {
                picture: &map,
                truth: &truth,
                mask: coverage.as_ref(),
                measure: kind.measure,
            };
            entries.push(Entry {
                picture: Some(self.save(&name, &raster)?),
                caption: caption(
                    method.column.find(kind.subject, None, kind.metric, "none"),
                    None,
                ),
                errors: self.errors(&name, &compared, &factors)?,
            });
        }
        let strip = Strip {
            title: String::new(),
            input: self.frames.nearest_train([0.0, 0.0, 1.0]),
            truth: self.save(&format!("truth-{}", kind.subject), &kind.show.raster(&truth))?,
            errors,
            entries,
        };
        let subject = (kind.subject.to_owned(), None);
        Ok(Some(self.plate(subject, kind.title.to_owned(), kind.show, kind.measure, vec![strip])))
    }

    fn plate(
        &self,
        subject: (String, Option<&str>),
        title: String,
        show: Show,
        measure: Measure,
        strips: Vec<Strip>,
    ) -> Plate {
        let light = subject.1.map(str::to_owned);
        let id = [Some(subject.0.as_str()), subject.1].into_iter().flatten();
        Plate {
            id: file_name(&id.collect::<Vec<_>>().join("-")),
            subject: (subject.0, light),
            title,
            tone: show.words(),
            error: measure.label(),
            top: measure.top().to_string(),
            unit: measure.unit(),
            strips,
        }
    }

    fn errors(
        &self,
        name: &str,
        compared: &Compared,
        factors: &[Option<f64>],
    ) -> Result<Vec<Option<Tile>>, ReportError> {
        let mut tiles = Vec::new();
        for (index, factor) in factors.iter().enumerate() {
            let field = factor.and_then(|factor| compared.field(factor as f32));
            tiles.push(match field {
                Some(field) => {
                    let raster = tone::false_colour(&field, compared.measure.top());
                    Some(self.save(&format!("{name}-error{index}"), &raster)?)
                }
                None => None,
            });
        }
        Ok(tiles)
    }

    /// The withheld views: by the methods themselves, then relit in every light.
    pub fn view_plates(&self) -> Result<Vec<Plate>, ReportError> {
        let relit = self.lights()?.into_iter().map(|light| self.relit(light));
        std::iter::once(Source::View)
            .chain(relit)
            .filter_map(|source| self.view_plate(&source, &Layer::ALL).transpose())
            .collect()
    }

    /// The exact split of the withheld views in the capture's light.
    pub fn layer_plates(&self) -> Result<Vec<Plate>, ReportError> {
        let sources = [Source::View, self.relit(self.light.to_owned())];
        [Layer::DIFFUSE, Layer::SPECULAR]
            .iter()
            .flat_map(|layer| sources.iter().map(move |source| (source, layer)))
            .filter_map(|(source, layer)| self.view_plate(source, layer).transpose())
            .collect()
    }

    /// Relit pictures with the albedo after its one factor, if anything was rendered so.
    fn relit(&self, light: String) -> Source {
        let mut folders = self.methods.iter().filter_map(|method| method.relit.as_ref());
        let scaled = folders.any(|folder| folder.join("global").is_dir());
        Source::Relit { light, scale: if scaled { "global" } else { "none" } }
    }

    fn view_plate(&self, source: &Source, layer: &Layer) -> Result<Option<Plate>, ReportError> {
        let mut strips = Vec::new();
        for frame in &self.frames.test {
            strips.extend(self.strip(source, frame, layer)?);
        }
        let made = strips.iter().flat_map(|strip| &strip.entries);
        if made.filter(|entry| entry.picture.is_some()).count() == 0 {
            return Ok(None);
        }
        let made_by = match source {
            Source::View => "by the method itself".to_owned(),
            Source::Relit { light, scale } => {
                let own = if light == self.light { ", the capture's light" } else { "" };
                format!("maps relit: {light}{own} (albedo {})", super::metric::scale(scale))
            }
        };
        let title = format!("Withheld view{}, {made_by}", layer.words);
        let subject = (layer.subject(source), source.light());
        let show = Show::Colour { exposure: layer.exposure };
        Ok(Some(self.plate(subject, title, show, Measure::Display, strips)))
    }

    /// The lights with a true relit picture, the capture's own first.
    fn lights(&self) -> Result<Vec<String>, ReportError> {
        let folder = self.capture.join("truth/relit");
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        let mut lights = Vec::new();
        for entry in fs::read_dir(&folder).map_err(|error| ReportError::read(&folder, error))? {
            let entry = entry.map_err(|error| ReportError::read(&folder, error))?;
            lights.push(entry.file_name().to_string_lossy().into_owned());
        }
        lights.sort_by_key(|light| (light != self.light, light.clone()));
        Ok(lights)
    }

    fn strip(
        &self,
        source: &Source,
        frame: &Frame,
        layer: &Layer,
    ) -> Result<Option<Strip>, ReportError> {
        let file = format!("{}.exr", frame.name);
        let truth = match source {
            Source::View if layer.name.is_none() => frame.image.clone(),
            Source::View => self.capture.join("truth/layers").join(&file),
            Source::Relit { light, .. } => {
                self.capture.join("truth/relit").join(light).join(&file)
            }
        };
        let Some(truth) = read_if_present(&truth, layer.channels)? else { return Ok(None) };
        let mask = match &frame.mask {
            Some(mask) => read_mask_if_present(mask)?,
            None => None,
        };
        let subject = layer.subject(source);
        let light = source.light();
        let show = Show::Colour { exposure: layer.exposure };
        let name = [Some(subject.as_str()), light, Some(&frame.name)];
        let name = name.into_iter().flatten().collect::<Vec<_>>().join("-");
        let mut entries = Vec::new();
        for method in self.methods {
            let made = match source.path(method, &file) {
                Some(path) => read_if_present(&path, layer.channels)?,
                None => None,
            };
            let Some(made) = made else {
                entries.push(Entry::default());
                continue;
            };
            let name = format!("{}-{name}", method.column.id);
            let compared = Compared {
                picture: &made,
                truth: &truth,
                mask: mask.as_ref(),
                measure: Measure::Display,
            };
            let score = method.column.find(&subject, light, "psnr_srgb", source.scale());
            entries.push(Entry {
                picture: Some(self.save(&name, &show.raster(&made))?),
                caption: caption(score, Some(&frame.name)),
                errors: self.errors(&name, &compared, &[Some(1.0)])?,
            });
        }
        Ok(Some(Strip {
            title: format!("view {}", frame.name),
            input: self.frames.nearest_train(frame.direction),
            truth: self.save(&format!("truth-{name}"), &show.raster(&truth))?,
            errors: vec!["error".to_owned()],
            entries,
        }))
    }
}

/// A picture as a whole, or one part of its exact split.
struct Layer {
    name: Option<&'static str>,
    words: &'static str,
    channels: &'static [&'static str],
    exposure: f32,
}

impl Layer {
    const ALL: Self = Self { name: None, words: "", channels: RGB, exposure: 1.0 };
    const DIFFUSE: Self = Self {
        name: Some("diffuse"),
        words: ", diffuse layer",
        channels: &["diffuse.R", "diffuse.G", "diffuse.B"],
        exposure: 1.0,
    };
    /// Several times darker than the picture it belongs to, hence the exposure.
    const SPECULAR: Self = Self {
        name: Some("specular"),
        words: ", specular layer",
        channels: &["specular.R", "specular.G", "specular.B"],
        exposure: 3.0,
    };

    fn subject(&self, source: &Source) -> String {
        match self.name {
            None => source.subject().to_owned(),
            Some(name) => format!("{}_{name}_layer", source.subject()),
        }
    }
}

/// Who made a picture of a withheld view.
enum Source {
    /// The method's own view synthesis.
    View,
    /// The path tracer, from the method's maps.
    Relit { light: String, scale: &'static str },
}

impl Source {
    fn subject(&self) -> &'static str {
        match self {
            Source::View => "view",
            Source::Relit { .. } => "relit",
        }
    }

    fn light(&self) -> Option<&str> {
        match self {
            Source::View => None,
            Source::Relit { light, .. } => Some(light),
        }
    }

    /// The scale mode of the scores that belong to the picture.
    fn scale(&self) -> &'static str {
        match self {
            Source::View => "none",
            Source::Relit { scale, .. } => scale,
        }
    }

    fn path(&self, method: &Method, file: &str) -> Option<PathBuf> {
        match self {
            Source::View => Some(method.maps.as_ref()?.join("views").join(file)),
            Source::Relit { light, scale } => {
                Some(method.relit.as_ref()?.join(scale).join(light).join(file))
            }
        }
    }
}

struct Compared<'a> {
    picture: &'a Picture,
    truth: &'a Picture,
    mask: Option<&'a GrayImage>,
    measure: Measure,
}

impl Compared<'_> {
    fn field(&self, factor: f32) -> Option<tone::Field> {
        difference::field(self.picture, self.truth, self.mask, self.measure, factor)
    }
}

/// A name of any characters as part of a file name; different names stay different.
pub(super) fn file_name(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_".contains(&byte);
    name.bytes()
        .map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("~{byte:02x}") })
        .collect()
}

/// The score that belongs under a picture; empty where there is none.
fn caption(row: Option<&Row>, frame: Option<&str>) -> String {
    let value = row.and_then(|row| match (frame, &row.per_frame) {
        (Some(frame), Some(per_frame)) => per_frame.get(frame).copied(),
        _ => row.value,
    });
    let (Some(row), Some(value)) = (row, value) else { return String::new() };
    let info = super::metric::info(&row.metric);
    let decimals = table::decimals(info.unit, std::iter::once(value));
    format!("{} {value:.decimals$} {}", info.name, info.unit)
}

/// Channels of a file that may be absent as a whole or lack just these layers.
fn read_if_present(path: &Path, channels: &[&str]) -> Result<Option<Picture>, ReportError> {
    if !path.exists() {
        return Ok(None);
    }
    let layered = channels.iter().any(|channel| channel.contains('.'));
    if layered {
        let present = picture::exr_channel_names(path)?;
        if !channels.iter().all(|channel| present.iter().any(|name| name == channel)) {
            return Ok(None);
        }
    }
    Ok(Some(picture::read_exr(path, channels)?))
}

fn read_mask_if_present(path: &Path) -> Result<Option<GrayImage>, ReportError> {
    if path.exists() { Ok(Some(picture::read_png_gray(path)?)) } else { Ok(None) }
}
