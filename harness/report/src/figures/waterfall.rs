//! From one method to the next in the order of the suite, with what bounds them: the flat map of true means, and the
//! true maps through the same pipeline.

use serde_json::json;

use super::drawing::{Bar, Bars, Block, Drawing};
use super::quantity::QUANTITIES;
use super::source::{CaseSource, Sources};
use super::statistics::over_faces;
use crate::error::ReportError;
use crate::run::Kind;
use crate::score_key::ALBEDO;

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let cases: Vec<CaseSource> = sources.cases().collect();
    let mut methods: Vec<(String, String, bool, &str)> = Vec::new();
    for column in cases.iter().flat_map(|source| &source.columns) {
        let bounds = matches!(column.method.kind, Kind::Oracle | Kind::Privileged);
        let known = methods.iter().any(|(id, ..)| *id == column.method.id);
        if !known && (bounds || sources.shows(column)) {
            let (id, title) = (column.method.id.clone(), column.method.title().to_owned());
            methods.push((id, title, bounds, column.method.role()));
        }
    }
    if methods.iter().filter(|(_, _, bounds, _)| !bounds).count() < 2 {
        return Err(sources.nothing("two solvers"));
    }
    for quantity in &QUANTITIES[..2] {
        let (mut bars, mut levels, mut before) = (Vec::new(), Vec::new(), None);
        for (id, title, bounds, role) in &methods {
            let values: Vec<(String, f64)> = cases
                .iter()
                .filter_map(|source| {
                    let column = source.columns.iter().find(|column| column.method.id == *id)?;
                    Some((
                        source.case.face.clone(),
                        quantity.key.value(column, &source.case.light)?,
                    ))
                })
                .collect();
            let Some(mean) = over_faces(&values) else { continue };
            let step = before.filter(|_| !bounds).map(|before| mean.value - before);
            let [low, high] = mean.interval.map_or([None; 2], |ends| ends.map(Some));
            drawing.row(json!({
                "quantity": quantity.name, "method": id, "role": role, "faces": mean.faces,
                "mean": mean.value, "low": low, "high": high, "step": step,
            }));
            if !bounds {
                before = Some(mean.value);
                bars.push(Bar {
                    name: title.clone(),
                    value: Some(mean.value),
                    interval: mean.interval,
                });
            } else if !(quantity.key == ALBEDO && *role == "oracle") {
                levels.push((title.clone(), mean.value));
            }
        }
        let (title, label) = (quantity.name.to_owned(), quantity.label.to_owned());
        drawing.blocks.push(Block::Bars(Bars { title, label, steps: true, bars, levels }));
    }
    drawing.caption = "What each step gains: bars go from the mean of the method before to that of the method named, \
                       over the same cases, with the 95 % interval of the mean over faces. Lines: what is made from the \
                       truth; the oracle's albedo is the truth itself and has no line."
        .to_owned();
    Ok(())
}
