//! Turns pictures into tiles: input, truth, what each method made of it, and its error.

use std::path::{Path, PathBuf};

use formats::picture::{self, Content, ExrFile, GrayImage, Picture};
use rayon::prelude::*;
use scoring::metrics::Metric;
use scoring::score::Row;
use serde::Serialize;

use super::difference::{self, Measure};
use super::error::ReportError;
use super::float_picture;
use super::link::WayToRun;
use super::reference::Reference;
use super::run::{Frame, Frames};
use super::save::create_parent;
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
    /// A script with the values for the viewer, of key pictures.
    pub values: Option<String>,
    /// The viewer's tone of these values.
    pub tone: Option<Tone>,
    /// The file in the run that it was made from.
    pub exr: Option<String>,
}

/// The tone in which the viewer shows a picture's values.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Tone {
    pub kind: &'static str,
    /// The value that is shown as white.
    pub white: f32,
}

/// One method's picture and errors in a row; absent where it made none.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Entry {
    pub picture: Option<Tile>,
    pub caption: String,
    /// One per entry of [`Strip::errors`].
    pub errors: Vec<Option<Tile>>,
}

/// One picture of the reference and what the methods made of it.
#[derive(Debug, Serialize)]
pub(super) struct Strip {
    pub title: String,
    /// The index of the case's input that lies nearest to the view.
    pub input: Option<usize>,
    pub truth: Tile,
    /// Quantity of each line of error pictures.
    pub errors: Vec<String>,
    /// One per column of the case.
    pub entries: Vec<Entry>,
}

/// A figure: strips with one tone and one scale of errors.
#[derive(Debug, Serialize)]
pub(super) struct ComparisonFigure {
    /// The subject and light of the scores that belong to it.
    #[serde(skip)]
    pub subject: (String, Option<String>),
    pub id: String,
    /// The name of the pictures that it compares with.
    pub reference: &'static str,
    pub title: String,
    pub tone: String,
    pub error: &'static str,
    /// The error at the end of the colour bar.
    pub top: String,
    pub unit: &'static str,
    pub strips: Vec<Strip>,
}

impl ComparisonFigure {
    /// A figure of `strips`; all have one tone and one measure.
    pub fn new(
        (subject, light): (&str, Option<&str>),
        reference: Reference,
        title: String,
        show: Show,
        measure: Measure,
        strips: Vec<Strip>,
    ) -> Self {
        let id: Vec<&str> = std::iter::once(subject).chain(light).collect();
        Self {
            id: file_name(&id.join("-")),
            subject: (subject.to_owned(), light.map(str::to_owned)),
            reference: reference.word(),
            title,
            tone: show.words(),
            error: measure.label(),
            top: measure.top().to_string(),
            unit: measure.unit(),
            strips,
        }
    }
}

/// The tone of a picture.
#[derive(Clone, Copy)]
pub(super) enum Show {
    /// Linear colour through the sRGB curve.
    Colour { exposure: f32 },
    /// One channel.
    Grey { white: f32 },
    /// Unit vectors.
    Normal,
}

impl Show {
    pub fn raster(self, picture: &Picture) -> Raster {
        match self {
            Show::Colour { exposure } => tone::colour(picture, exposure),
            Show::Grey { white } => tone::grey(picture, white),
            Show::Normal => tone::normals(picture),
        }
    }

    fn tone(self) -> Tone {
        match self {
            Show::Colour { exposure } => Tone { kind: "colour", white: 1.0 / exposure },
            Show::Grey { white } => Tone { kind: "grey", white },
            Show::Normal => Tone { kind: "normal", white: 1.0 },
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

/// One method's column and its folders below the run, which may be absent.
pub(super) struct MethodFolders<'a> {
    pub column: &'a Column<'a>,
    pub maps: Option<PathBuf>,
    pub relit: Option<PathBuf>,
}

/// A picture of the reference, which the methods' are compared with.
pub(super) struct Subject {
    /// Names its files.
    pub name: String,
    pub title: String,
    /// The index of the training view to show beside it.
    pub input: Option<usize>,
    pub truth: Picture,
    /// The file that the truth was read from.
    pub path: PathBuf,
    pub mask: Option<GrayImage>,
    pub show: Show,
    pub measure: Measure,
    /// Compare a second time after the method's one factor.
    pub scaled: bool,
    /// Keep the values for the viewer: too many bytes for every picture.
    pub values: bool,
}

/// A method's picture of a subject.
pub(super) struct Made {
    pub picture: Picture,
    /// The file that it was read from.
    pub path: PathBuf,
    /// The score that belongs to it.
    pub caption: String,
}

/// Makes the comparison figures of one case and writes their pictures.
pub(super) struct Studio<'a> {
    pub frames: &'a Frames,
    pub light: &'a str,
    pub methods: &'a [MethodFolders<'a>],
    /// The report's folder, and where below it this case's pictures go.
    pub root: &'a Path,
    pub folder: &'a str,
    /// The run, and the way there from the finished report.
    pub run: &'a Path,
    pub way: &'a WayToRun,
}

impl Studio<'_> {
    /// The training views.
    pub fn inputs(&self) -> Result<Vec<Input>, ReportError> {
        let input = |frame: &Frame| {
            let mut picture = picture::read_colour_unchecked(&frame.image)?;
            picture.blacken_not_finite(|_| true);
            let raster = tone::colour(&picture, 1.0);
            let tile = self.save("input", &frame.name, &raster)?;
            Ok(Input { title: format!("input view {}", frame.name), tile })
        };
        self.frames.train.par_iter().map(input).collect()
    }

    /// Compares what `made` reads for each method, with its score, with the subject.
    pub fn strip(
        &self,
        subject: &Subject,
        made: impl Fn(&MethodFolders) -> Result<Option<Made>, ReportError>,
    ) -> Result<Strip, ReportError> {
        let mut errors = vec!["error".to_owned()];
        if subject.scaled {
            errors.push("error after one factor".to_owned());
        }
        let mut entries = Vec::new();
        for method in self.methods {
            entries.push(match made(method)? {
                Some(made) => self.entry(subject, method, made)?,
                None => Entry::default(),
            });
        }
        let truth = self.tile("truth", subject, &subject.truth, &subject.path)?;
        Ok(Strip { title: subject.title.clone(), input: subject.input, truth, errors, entries })
    }

    fn entry(
        &self,
        subject: &Subject,
        method: &MethodFolders,
        made: Made,
    ) -> Result<Entry, ReportError> {
        // A method may be called "truth" or "input" too.
        let group = format!("by-{}", file_name(&method.column.method.id));
        let mut factors = vec![Some(1.0)];
        if subject.scaled {
            factors.push(method.column.factor());
        }
        let mut errors = Vec::new();
        for (index, factor) in factors.into_iter().enumerate() {
            let field = factor.and_then(|factor| {
                let mask = subject.mask.as_ref();
                difference::field(&made.picture, &subject.truth, mask, subject.measure, factor)
            });
            errors.push(match field {
                Some(field) => {
                    let raster = tone::false_colour(&field, subject.measure.top());
                    Some(self.save(&group, &format!("{}-error{index}", subject.name), &raster)?)
                }
                None => None,
            });
        }
        let picture = Some(self.tile(&group, subject, &made.picture, &made.path)?);
        Ok(Entry { picture, caption: made.caption, errors })
    }

    /// A picture of a subject with the link to its file, and its values if they are to be kept.
    fn tile(
        &self,
        group: &str,
        subject: &Subject,
        picture: &Picture,
        path: &Path,
    ) -> Result<Tile, ReportError> {
        let mut tile = self.save(group, &subject.name, &subject.show.raster(picture))?;
        tile.exr = path.strip_prefix(self.run).ok().map(|below| self.way.to(below));
        if subject.values {
            let script = tile.src.replace(".png", ".js");
            float_picture::write(&self.root.join(&script), &script, picture)?;
            tile.values = Some(script);
            tile.tone = Some(subject.show.tone());
        }
        Ok(tile)
    }

    /// Writes a picture below the report's folder.
    pub fn save(&self, group: &str, name: &str, raster: &Raster) -> Result<Tile, ReportError> {
        let src = format!("{}/{group}/{}.png", self.folder, file_name(name));
        let path = self.root.join(&src);
        create_parent(&path)?;
        raster.save(&path)?;
        let (width, height) = (raster.width, raster.height);
        Ok(Tile { src, width, height, values: None, tone: None, exr: None })
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
pub(super) fn caption(row: Option<&Row>, frame: Option<&str>) -> String {
    let value = row.and_then(|row| match frame {
        Some(frame) => row.per_frame.get(frame).copied(),
        None => row.value,
    });
    let (Some(row), Some(value)) = (row, value) else { return String::new() };
    let Ok(metric) = Metric::find(&row.metric) else { return String::new() };
    let decimals = table::decimals(metric.unit, std::iter::once(value));
    format!("{} {value:.decimals$} {}", metric.name, metric.unit)
}

/// Channels of a file that may be absent as a whole or lack just these layers. What may hold
/// anything is black: texels that the coverage beside a map leaves out, and what is not finite in a
/// picture, whose mask the scores have looked at.
pub(super) fn read_if_present(
    path: &Path,
    channels: &[&str],
    content: Content,
) -> Result<Option<Picture>, ReportError> {
    if !path.exists() {
        return Ok(None);
    }
    let file = ExrFile::open(path)?;
    let layered = channels.iter().any(|channel| channel.contains('.'));
    if layered {
        let present = file.channel_names();
        if !channels.iter().all(|channel| present.iter().any(|name| name == channel)) {
            return Ok(None);
        }
    }
    let mut picture = file.read(channels, content)?;
    let coverage = read_mask_if_present(&path.with_file_name("coverage.png"))?
        .filter(|found| (found.width, found.height) == (picture.width, picture.height));
    match coverage {
        Some(coverage) => picture.blacken_not_finite(|texel| coverage.data[texel] == 0),
        None => picture.blacken_not_finite(|_| content == Content::Colour),
    }
    picture.require_finite(path, channels)?;
    Ok(Some(picture))
}

/// A mask that may be absent.
pub(super) fn read_mask_if_present(path: &Path) -> Result<Option<GrayImage>, ReportError> {
    if path.exists() { Ok(Some(picture::read_png_gray(path)?)) } else { Ok(None) }
}
