//! Withheld views and relit pictures against the true ones, with their layers.

use std::path::{Path, PathBuf};

use formats::picture::{self, GrayImage, Picture};
use rayon::prelude::*;

use super::ScoreError;
use super::noise_floor;
use super::render::Render;
use super::rows::{Compared, Floors, Heading, rows};
use super::scores::{RegionSize, Row};
use super::truth::{self, Highlights, present};
use crate::metrics::{Pair, Region, scored};

const INCOMPLETE: &str = "either all withheld frames are written or none; write the folder again";

/// A withheld frame.
pub(super) struct Frame {
    name: String,
    mask: GrayImage,
    region: Region,
}

impl Frame {
    /// The withheld frames of a capture whose own light is `light`.
    pub fn withheld(capture: &Path, light: &str) -> Result<Vec<Self>, ScoreError> {
        Self::of(capture, truth::withheld(capture, light)?)
    }

    /// The frames with these names.
    pub fn of(capture: &Path, names: Vec<String>) -> Result<Vec<Self>, ScoreError> {
        let open = |name: String| {
            let path = capture.join(format!("masks/{name}.png"));
            let mask = picture::read_png_gray(&present(path, truth::AGAIN)?)?;
            let region = Region::eroded("mask-e5", &mask).map_err(ScoreError::of(&name))?;
            Ok(Self { name, mask, region })
        };
        names.into_iter().map(open).collect()
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// The pixels that are compared, row-major.
    pub fn pixels(&self) -> &[usize] {
        self.region.pixels()
    }

    /// The compared part of its mask.
    pub fn region_size(&self) -> RegionSize {
        let name = format!("{}/{}", self.region.name(), self.name);
        RegionSize::new(&self.region, &name, &self.mask, None)
    }

    fn read(&self, folder: &Path, fix: &'static str) -> Result<Render, ScoreError> {
        let path = present(folder.join(format!("{}.exr", self.name)), fix)?;
        Render::read_masked(&path, &self.mask)
    }
}

/// Rows of the solver's own synthesis of the withheld views; none if it wrote none.
pub(super) fn view_rows(
    frames: &[Frame],
    capture: &Path,
    maps: &Path,
    light: &str,
    highlights: Highlights,
) -> Result<Vec<Row>, ScoreError> {
    let views = maps.join("views");
    if !views.is_dir() {
        return Ok(Vec::new());
    }
    let true_folder = true_folder(capture, light)?;
    let subjects = ["view", "view_diffuse_layer", "view_specular_layer"];
    let heading = Heading { subject: "view", light: None, scale: "none", label: None };
    let (found, truths) =
        (read(frames, &views, INCOMPLETE)?, read(frames, &true_folder, truth::AGAIN)?);
    compare(frames, &found, &truths, heading, subjects, highlights)
}

/// Rows of the relit pictures in every light, as they are and after the global factor; none of a
/// light in which nothing was relit.
pub(super) fn relit_rows(
    frames: &[Frame],
    capture: &Path,
    relit: &Path,
    highlights: Highlights,
) -> Result<Vec<Row>, ScoreError> {
    let lights = truth::lights(capture)?;
    let rows = |(light, scale): (&String, &str)| {
        let folder = relit.join(scale).join(light);
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        let subjects = ["relit", "relit_diffuse_layer", "relit_specular_layer"];
        let truths = read(frames, &true_folder(capture, light)?, truth::AGAIN)?;
        let found = read(frames, &folder, INCOMPLETE)?;
        let light = Some(light.as_str());
        let heading = Heading { subject: "relit", light, scale, label: None };
        compare(frames, &found, &truths, heading, subjects, highlights)
    };
    let jobs: Vec<_> =
        lights.iter().flat_map(|light| ["none", "global"].map(|scale| (light, scale))).collect();
    let rows: Result<Vec<_>, ScoreError> = jobs.into_par_iter().map(rows).collect();
    Ok(rows?.concat())
}

/// Rows of pictures in `folder` against photographs: a method's views, or its maps relit in the light
/// that it found; no rows without the folder. With `own_gains`, each picture is compared after the factor
/// of each channel that fits its photograph.
pub(super) fn photograph_rows(
    frames: &[Frame],
    photographs: &Path,
    folder: &Path,
    light: Option<&str>,
    own_gains: bool,
) -> Result<Vec<Row>, ScoreError> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let subject = if light.is_some() { "relit" } else { "view" };
    let heading = Heading { subject, light, scale: "none", label: None };
    let mut found = read(frames, folder, INCOMPLETE)?;
    let truths = read(frames, photographs, truth::AGAIN)?;
    if own_gains {
        for ((frame, found), truth) in frames.iter().zip(&mut found).zip(&truths) {
            found.scale_to(truth, frame.region.pixels());
        }
    }
    compare(frames, &found, &truths, heading, [subject, "", ""], Highlights::Alike)
}

fn true_folder(capture: &Path, light: &str) -> Result<PathBuf, ScoreError> {
    present(truth::folder(capture)?.join("relit").join(light), truth::AGAIN)
}

fn read(frames: &[Frame], folder: &Path, fix: &'static str) -> Result<Vec<Render>, ScoreError> {
    frames.iter().map(|frame| frame.read(folder, fix)).collect()
}

/// Rows of the whole pictures and of both layers, where every frame has them.
fn compare(
    frames: &[Frame],
    found: &[Render],
    truths: &[Render],
    heading: Heading,
    subjects: [&'static str; 3],
    highlights: Highlights,
) -> Result<Vec<Row>, ScoreError> {
    let mut floors = Floors::new();
    for ((frame, found), truth) in frames.iter().zip(found).zip(truths) {
        // A relit picture without a variance has noise of unknown size; a view has none.
        let unknown = heading.subject == "relit" && found.variance.is_none();
        if let (Some(total), Some(variance), false) = (&truth.total, &truth.variance, unknown) {
            let region = &frame.region;
            noise_floor::add_frame(&mut floors, total, variance, found.variance.as_ref(), region);
        }
    }
    type Part = (fn(&Render) -> &Option<Picture>, &'static [&'static str]);
    let parts: [Part; 3] = [
        (|render| &render.total, &scored::PICTURE),
        (|render| &render.diffuse, &scored::LAYER),
        (
            |render| &render.specular,
            match highlights {
                Highlights::Varied => &scored::LAYER,
                Highlights::Alike => &scored::LAYER_OF_ONE_ALBEDO,
            },
        ),
    ];
    let mut all = Vec::new();
    for (subject, (part, metrics)) in subjects.into_iter().zip(parts) {
        let compared: Option<Vec<(&Frame, &Picture, &Picture)>> = frames
            .iter()
            .zip(found)
            .zip(truths)
            .map(|((frame, found), truth)| {
                Some((frame, part(found).as_ref()?, part(truth).as_ref()?))
            })
            .collect();
        let Some(compared) = compared.filter(|compared| !compared.is_empty()) else { continue };
        let compared: Vec<Compared> = compared
            .into_iter()
            .map(|(frame, found, truth)| {
                let pair = Pair::new(found, truth, &frame.region)?;
                Ok(Compared { frame: Some(&frame.name), pair })
            })
            .collect::<Result<_, _>>()
            .map_err(ScoreError::of(subject))?;
        let none = Floors::new();
        let floors = if subject == heading.subject { &floors } else { &none };
        all.extend(rows(Heading { subject, ..heading }, metrics, &compared, floors)?);
    }
    // Photographs have no layers, and along a silhouette what lies behind the face.
    if !subjects[1].is_empty() {
        all.extend(silhouette_rows(frames, found, truths, heading)?);
    }
    all.extend(unbiased_rows(frames, found, truths, heading)?);
    if heading.scale == "none" {
        all.extend(compatible_rows(frames, found, truths, heading)?);
    }
    Ok(all)
}

/// Rows of the rims that erosion takes away; none where a picture has none.
fn silhouette_rows(
    frames: &[Frame],
    found: &[Render],
    truths: &[Render],
    heading: Heading,
) -> Result<Vec<Row>, ScoreError> {
    let subject = if heading.subject == "view" { "view_silhouette" } else { "relit_silhouette" };
    let wrong = ScoreError::of(subject);
    let rims = frames.iter().map(|frame| Region::rim("mask-rim", &frame.mask));
    let rims: Vec<Region> = rims.collect::<Result<_, _>>().map_err(&wrong)?;
    let pictures = frames.iter().zip(&rims).zip(found.iter().zip(truths));
    let compared = pictures.filter_map(|((frame, rim), (found, truth))| {
        let (found, truth) = (found.total.as_ref()?, truth.total.as_ref()?);
        Some(Pair::new(found, truth, rim).map(|pair| Compared { frame: Some(&frame.name), pair }))
    });
    let compared: Vec<Compared> = compared.collect::<Result<_, _>>().map_err(&wrong)?;
    if compared.len() < frames.len() || compared.is_empty() {
        return Ok(Vec::new());
    }
    rows(Heading { subject, ..heading }, &scored::SILHOUETTE, &compared, &Floors::new())
}

/// Rows as other benchmarks score, which scale pictures themselves.
fn compatible_rows(
    frames: &[Frame],
    found: &[Render],
    truths: &[Render],
    heading: Heading,
) -> Result<Vec<Row>, ScoreError> {
    let wrong = ScoreError::of(heading.subject);
    let whole = frames.iter().map(|frame| Region::of_mask("mask", &frame.mask));
    let whole: Vec<Region> = whole.collect::<Result<_, _>>().map_err(&wrong)?;
    let eroded: Vec<&Region> = frames.iter().map(|frame| &frame.region).collect();
    let mut all = Vec::new();
    for (metrics, regions) in [
        (&scored::COMPATIBLE[..], eroded),
        (&scored::COMPATIBLE_WHOLE[..], whole.iter().collect::<Vec<_>>()),
    ] {
        let pictures = found
            .iter()
            .zip(truths)
            .filter_map(|(found, truth)| Some((found.total.as_ref()?, truth.total.as_ref()?)));
        let compared: Vec<Compared> = frames
            .iter()
            .zip(regions)
            .zip(pictures)
            .map(|((frame, region), (found, truth))| {
                Ok(Compared { frame: Some(&frame.name), pair: Pair::new(found, truth, region)? })
            })
            .collect::<Result<_, _>>()
            .map_err(&wrong)?;
        if compared.len() == frames.len() && !compared.is_empty() {
            all.extend(rows(heading, metrics, &compared, &Floors::new())?);
        }
    }
    Ok(all)
}

/// Rows without what noise adds, where truth and relit pictures come in independent halves. A view
/// of a solver has no noise and is its own half; a relit picture without a half has noise that
/// nothing is known of.
fn unbiased_rows(
    frames: &[Frame],
    found: &[Render],
    truths: &[Render],
    heading: Heading,
) -> Result<Vec<Row>, ScoreError> {
    let wrong = ScoreError::of(heading.subject);
    let mut compared = Vec::new();
    for ((frame, found), truth) in frames.iter().zip(found).zip(truths) {
        let half = if heading.subject == "view" { &found.total } else { &found.half };
        let (Some(total), Some(half), Some(true_total), Some(true_half)) =
            (&found.total, half, &truth.total, &truth.half)
        else {
            return Ok(Vec::new());
        };
        let pair = Pair::new(total, true_total, &frame.region)
            .and_then(|pair| pair.with_halves(half, true_half))
            .map_err(&wrong)?;
        compared.push(Compared { frame: Some(&frame.name), pair });
    }
    if compared.is_empty() {
        return Ok(Vec::new());
    }
    rows(heading, &scored::UNBIASED, &compared, &Floors::new())
}
