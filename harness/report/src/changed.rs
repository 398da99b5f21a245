//! Pictures of what a comparison found: what was, what is, the truth, and the difference.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use formats::atomic;
use formats::picture::{Content, GrayImage, Picture};
use scoring::compare::Finding;
use scoring::metrics::{black_outside, resample};

use super::comparison_figures::{Show, read_if_present, read_mask_if_present};
use super::difference::{Measure, field};
use super::error::ReportError;
use super::maps::MAPS;
use super::reference::Reference;
use super::run::{Case, Frames, Method, RunFile};
use super::save::{write_file, write_folder};
use super::tone::{self, Field};
use super::views::Layer;

/// Findings that are shown: the largest first, as they come.
const SHOWN: usize = 8;

/// Pictures of one finding.
struct Shown {
    old: Option<Picture>,
    new: Picture,
    truth: Picture,
    reference: Reference,
    mask: Option<GrayImage>,
    show: Show,
    measure: Measure,
}

/// Writes the folder `out` with small PNGs of each finding that has a picture, and `index.md`, which says
/// what they are; the number of findings that are shown. `old` is the folder of the baseline's run.
pub fn write_changes(
    findings: &[Finding],
    new: &Path,
    old: Option<&Path>,
    out: &Path,
) -> Result<usize, ReportError> {
    let inputs: Vec<&Path> = [Some(new), old].into_iter().flatten().collect();
    atomic::refuse_overlap(out, &inputs)?;
    write_folder(out, |folder| fill(findings, new, old, folder))
}

fn fill(
    findings: &[Finding],
    new: &Path,
    old: Option<&Path>,
    root: &Path,
) -> Result<usize, ReportError> {
    let manifest = RunFile::open(new)?;
    let before = old.map(RunFile::open).transpose()?;
    let reference = Reference::common_word(
        manifest.cases.iter().map(|case| Reference::of(&new.join(&case.capture))),
    );
    let mut page = format!(
        "# What changed\n\nEach row: the baseline's run, this run, the {reference}, the difference of the first two \
         (of this run and the {reference}, where the baseline's pictures are not at hand), from black (none) to pale \
         yellow (the largest, as stated); of colours the same two by FLIP, which is what an eye would see when it \
         flips between them.\n"
    );
    let mut count = 0;
    let mut seen = BTreeSet::new();
    for finding in findings {
        // What got worse in one respect and better in another is one picture.
        if !seen.insert((&finding.method, &finding.subject)) {
            continue;
        }
        let Some(shown) = shown(finding, (new, &manifest), old.zip(before.as_ref()))? else {
            continue;
        };
        count += 1;
        let Shown { old, new, truth, reference, mask, show, measure } = &shown;
        let other = old.as_ref().unwrap_or(truth);
        let Some(error) = field(new, other, mask.as_ref(), *measure, 1.0) else { continue };
        let flip = flip(new, other, mask.as_ref(), *measure);
        let seen_by = |field: &Field| tone::false_colour(field, largest(field));
        let stem = format!("{count:02}-{}-{}", finding.method, finding.subject);
        let pictures = [
            ("old", old.as_ref().map(|picture| show.raster(picture))),
            ("new", Some(show.raster(new))),
            (reference.word(), Some(show.raster(truth))),
            ("difference", Some(seen_by(&error))),
            ("flip", flip.as_ref().map(seen_by)),
        ];
        // Writing to a string cannot fail.
        let _ = writeln!(page, "\n{}\n", finding.sentence.replace('\n', " "));
        for (name, picture) in pictures {
            let Some(picture) = picture else { continue };
            let file = format!("{stem}-{name}.png");
            picture.save(&root.join(&file))?;
            let _ = writeln!(page, "![{name}]({file})");
        }
        let (label, unit) = (measure.label(), measure.unit());
        let _ = write!(page, "\n{label} up to {:.4}{unit}", largest(&error));
        let _ = match &flip {
            Some(flip) => writeln!(page, "; FLIP up to {:.4}", largest(flip)),
            None => writeln!(page),
        };
        if count == SHOWN {
            break;
        }
    }
    write_file(&root.join("index.md"), page)?;
    Ok(count)
}

/// The largest value of a field; above 0.
fn largest(field: &Field) -> f32 {
    let values = field.values.iter().copied().filter(|value| value.is_finite());
    values.fold(f32::MIN_POSITIVE, f32::max)
}

/// FLIP of two pictures of colours; none of other quantities.
fn flip(
    new: &Picture,
    other: &Picture,
    mask: Option<&GrayImage>,
    measure: Measure,
) -> Option<Field> {
    let colours = matches!(measure, Measure::Display | Measure::ColourDifference);
    let masked = |picture: &Picture| {
        mask.map_or_else(|| picture.clone(), |mask| black_outside(picture, mask))
    };
    let fits = colours && new.channels == 3;
    fits.then(|| field(&masked(new), &masked(other), mask, Measure::Flip, 1.0)).flatten()
}

/// The pictures of a finding in its first case; none if it has no picture, or the method left none.
fn shown(
    finding: &Finding,
    new: (&Path, &RunFile),
    old: Option<(&Path, &RunFile)>,
) -> Result<Option<Shown>, ReportError> {
    let Some((case, method)) = find(new.1, finding) else { return Ok(None) };
    let capture = new.0.join(&case.capture);
    if let Some(kind) = MAPS.iter().find(|kind| kind.subject == finding.subject) {
        let file = format!("{}.exr", kind.subject);
        let truth =
            read_if_present(&capture.join("truth").join(&file), kind.channels, kind.content())?;
        let Some(truth) = truth else { return Ok(None) };
        let read = |run: &Path, method: &Method| match &method.maps {
            Some(maps) => {
                read_if_present(&run.join(maps).join(&file), kind.channels, kind.content())
            }
            None => Ok(None),
        };
        let Some(now) = read(new.0, method)? else { return Ok(None) };
        let before = old.and_then(|(run, manifest)| Some((run, find(manifest, finding)?.1)));
        let before = before.map(|(run, method)| read(run, method)).transpose()?.flatten();
        let fitted = |picture: Picture| resample(&picture, truth.width, truth.height);
        return Ok(Some(Shown {
            old: before.map(fitted),
            new: fitted(now),
            mask: read_mask_if_present(&capture.join("truth/coverage.png"))?,
            truth,
            reference: Reference::Truth,
            show: kind.show,
            measure: kind.measure,
        }));
    }
    picture(finding, (&capture, case.light.as_str()), (new.0, method), old)
}

/// The first withheld view of a finding of pictures, in the light of its capture.
fn picture(
    finding: &Finding,
    (capture, light): (&Path, &str),
    (run, method): (&Path, &Method),
    old: Option<(&Path, &RunFile)>,
) -> Result<Option<Shown>, ReportError> {
    let layer = match finding.subject.split_once('_').map(|(_, rest)| rest) {
        None => Layer::ALL,
        Some("diffuse_layer") => Layer::DIFFUSE,
        Some("specular_layer") => Layer::SPECULAR,
        Some(_) => return Ok(None),
    };
    let frames = Frames::read(capture)?;
    let Some(frame) = frames.test.first() else { return Ok(None) };
    let file = format!("{}.exr", frame.name);
    let path = |run: &Path, method: &Method| -> Option<PathBuf> {
        if finding.subject.starts_with("view") {
            return Some(run.join(method.maps.as_ref()?).join("views").join(&file));
        }
        let relit = run.join(method.relit.as_ref()?);
        ["global", "none"]
            .into_iter()
            .map(|scale| relit.join(scale).join(light).join(&file))
            .find(|path| path.is_file())
    };
    let read = |path: Option<PathBuf>| match path {
        Some(path) => read_if_present(&path, layer.channels, Content::Colour),
        None => Ok(None),
    };
    // In the capture's own light the picture itself is the truth; its layers lie apart.
    let truth = match layer.channels {
        ["R", "G", "B"] => frame.image.clone(),
        _ => capture.join("truth/layers").join(&file),
    };
    let Some(truth) = read(Some(truth))? else { return Ok(None) };
    let Some(new) = read(path(run, method))? else { return Ok(None) };
    let before = old.and_then(|(run, manifest)| path(run, find(manifest, finding)?.1));
    let mask = frame.mask.as_deref().map(read_mask_if_present).transpose()?.flatten();
    let show = Show::Colour { exposure: layer.exposure };
    let (reference, measure) = (frames.reference, Measure::Display);
    Ok(Some(Shown { old: read(before)?, new, truth, reference, mask, show, measure }))
}

fn find<'m>(manifest: &'m RunFile, finding: &Finding) -> Option<(&'m Case, &'m Method)> {
    let case = manifest.cases.iter().find(|case| finding.cases.contains(&case.id))?;
    Some((case, case.methods.iter().find(|method| method.id == finding.method)?))
}
