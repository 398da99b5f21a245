//! The error against the observability of texels: the number of views that see them, the least obliqueness of these,
//! the light, cast shadows, clipping, and the method's own confidence; and texels that are wrong with a high confidence.

mod errors;
mod factors;
mod wrong_and_sure;

use formats::picture::Picture;
use scoring::score::Observability;
use serde_json::{Value, json};

use self::errors::Errors;
use self::factors::{Factor, factors, of_confidence};
use self::wrong_and_sure::WrongAndSure;
use super::drawing::{Block, Drawing, Lines, Panel, PanelRow, Panels};
use super::panels::ERROR;
use super::source::{CaseSource, Sources};
use super::statistics::curve;
use crate::error::ReportError;
use crate::tone::{self, Field};

/// A point of a curve, of one case.
struct Point {
    method: usize,
    face: String,
    factor: &'static str,
    bin: usize,
    x: f64,
    decibels: f64,
}

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let mut methods: Vec<(String, String)> = Vec::new();
    let mut points: Vec<Point> = Vec::new();
    let mut labels: Vec<(&'static str, &'static str, bool)> = Vec::new();
    let mut panels: Option<Vec<Panels>> = None;
    for source in sources.cases() {
        if !source.truth("scene.toml").is_file() {
            continue;
        }
        let columns: Vec<_> =
            source.columns.iter().filter(|column| sources.shows(column)).collect();
        if columns.is_empty() {
            continue;
        }
        let seen = Observability::of(&source.run.join(&source.case.capture))?;
        let found = columns.into_iter().map(|column| Errors::of(&source, column, &seen.compared));
        let found: Vec<Errors> = found.filter_map(Result::transpose).collect::<Result<_, _>>()?;
        let of_capture = factors(&seen);
        for found in &found {
            let known = methods.iter().position(|(name, _)| *name == found.name);
            let method = known.unwrap_or_else(|| {
                methods.push((found.name.clone(), found.title.clone()));
                methods.len() - 1
            });
            for factor in of_capture.iter().chain(&found.confidence.as_ref().map(of_confidence)) {
                if labels.iter().all(|(name, ..)| *name != factor.name) {
                    labels.push((factor.name, factor.label, factor.logarithmic));
                }
                for bin in factor.bins(&found.albedo, found.normal.as_ref()) {
                    drawing.row(row(&source, found, factor.name, bin.values()));
                    points.push(Point {
                        method,
                        face: source.case.face.clone(),
                        factor: factor.name,
                        bin: bin.at,
                        x: bin.mean,
                        decibels: bin.decibels,
                    });
                }
            }
            if let Some(wrong) = WrongAndSure::of(found) {
                let share = [None, None, None, Some(wrong.share), None, None];
                drawing.row(row(&source, found, "sure half of the worst tenth", share));
            }
        }
        if panels.is_none() && !found.is_empty() {
            panels = Some(maps(drawing, &source, &of_capture, &found)?);
        }
    }
    if points.is_empty() {
        return Err(sources.nothing("the albedo map of a rendered face"));
    }
    drawing.blocks.extend(panels.into_iter().flatten().map(Block::Panels));
    let count = points.iter().map(|point| point.bin + 1).max().unwrap_or(0);
    for (factor, label, logarithmic) in labels {
        let lines = methods.iter().enumerate().map(|(method, (_, title))| {
            curve(title, 0..count, |bin| {
                let same = |p: &&Point| p.method == method && p.factor == factor && p.bin == bin;
                let here = points.iter().filter(same);
                here.map(|p| (p.face.clone(), p.x, p.decibels)).collect()
            })
        });
        drawing.blocks.push(Block::Lines(Lines {
            title: factor.to_owned(),
            x_label: label.to_owned(),
            y_label: "albedo, dB".to_owned(),
            logarithmic,
            across: vec![],
            // All of them, so that a method has its colour in every plot.
            lines: lines.collect(),
        }));
    }
    drawing.caption = format!(
        "Error against what the capture could determine. Above, of one case: what is known of every texel, and where each \
         method errs (RMS of sRGB values after the albedo's one factor, to {}); wrong and sure: the worst tenth of the \
         texels, bright where the method's confidence is in its upper half, violet where it is not. Below: PSNR of the \
         albedo over texels of like observation, means over faces with the 95 % interval of Student's t.",
        ERROR.top()
    );
    Ok(())
}

/// A row of the CSV.
fn row(source: &CaseSource, found: &Errors, factor: &str, values: [Option<f64>; 6]) -> Value {
    let [from, to, mean, share, decibels, degrees] = values;
    json!({
        "case": source.case.id, "face": source.case.face, "method": found.name, "factor": factor,
        "from": from, "to": to, "mean": mean, "share of texels": share, "albedo, dB": decibels,
        "normal, °": degrees,
    })
}

/// Panels of the observability of every texel, and below them of the error of each method.
fn maps(
    drawing: &Drawing,
    source: &CaseSource,
    factors: &[Factor],
    found: &[Errors],
) -> Result<Vec<Panels>, ReportError> {
    let save = |name: String,
                field: &Field,
                top: f32,
                caption: String|
     -> Result<Option<Panel>, ReportError> {
        let name = format!("{}-{name}", source.case.id);
        Ok(Some(drawing.panel(&name, &tone::false_colour(field, top), caption)?))
    };
    let within = |picture: &Picture| {
        let outside = &found[0].albedo.values;
        let values = picture.data.iter().zip(outside);
        let values = values.map(|(v, outside)| if outside.is_nan() { f32::NAN } else { *v });
        Field { width: picture.width, height: picture.height, values: values.collect() }
    };
    let of_capture = factors
        .iter()
        .map(|factor| {
            save(factor.name.replace(' ', "-"), &within(factor.map), factor.top, factor.scale())
        })
        .collect::<Result<_, _>>()?;
    let row = |cells| vec![PanelRow { title: String::new(), cells }];
    let title = format!("{}, {}", source.face(), source.case.light);
    let above = Panels {
        title: format!("{title}: what the capture could determine"),
        columns: factors.iter().map(|factor| factor.name.to_owned()).collect(),
        rows: row(of_capture),
        error: None,
    };
    let errors = found
        .iter()
        .map(|method| {
            let name = format!("{}-error", method.name);
            save(name, &method.albedo, ERROR.top(), String::new())
        })
        .collect::<Result<_, _>>()?;
    let below = Panels {
        title: "error of the albedo".to_owned(),
        columns: found.iter().map(|method| method.title.clone()).collect(),
        rows: row(errors),
        error: Some((ERROR.label().to_owned(), ERROR.top())),
    };
    let (mut columns, mut cells) = (Vec::new(), Vec::new());
    for method in found {
        let Some((confidence, wrong)) = method.confidence.as_ref().zip(WrongAndSure::of(method))
        else {
            continue;
        };
        let caption = format!("{:.0} % of the worst tenth are sure", 100.0 * wrong.share);
        columns
            .extend(["confidence", "wrong and sure"].map(|of| format!("{}: {of}", method.title)));
        let name = format!("{}-confidence", method.name);
        cells.push(save(name, &within(confidence), 1.0, "0 to 1".to_owned())?);
        let name = format!("{}-wrong-and-sure", method.name);
        cells.push(save(name, &wrong.field, 1.0, caption)?);
    }
    let sure = Panels { title: String::new(), columns, rows: row(cells), error: None };
    let shown = [above, below, sure].into_iter().filter(|panels| !panels.columns.is_empty());
    Ok(shown.collect())
}
