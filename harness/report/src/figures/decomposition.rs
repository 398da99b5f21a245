//! The decomposition under each light of a face (figure 10 of Rainer et al. 2023): input, maps, and the diffuse and
//! specular layers of that view, by the truth and by each method.

use std::path::PathBuf;

use serde_json::json;

use super::drawing::{Block, Drawing, Panel, PanelRow, Panels};
use super::source::{CaseSource, Sources};
use crate::error::ReportError;
use crate::maps::MAPS;
use crate::reference::Reference;
use crate::run::Frame;
use crate::table::Column;
use crate::views::Layer;

const SHOWN: [&str; 3] = ["diffuse_albedo", "specular_albedo", "specular_normal"];

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let mut panels = Panels { columns: vec!["input".to_owned()], ..Panels::default() };
    panels.columns.extend(
        MAPS.iter().filter(|map| SHOWN.contains(&map.subject)).map(|map| map.title.to_lowercase()),
    );
    panels.columns.extend(["diffuse layer", "specular layer"].map(str::to_owned));
    for source in sources.cases() {
        let frames = source.frames()?;
        let direction = frames.test.first().map_or([0.0, 0.0, 1.0], |frame| frame.direction);
        let Some(index) = frames.nearest_train(direction) else { continue };
        let frame = &frames.train[index];
        let shown: Vec<&Column> =
            source.columns.iter().filter(|column| sources.shows(column)).collect();
        if shown.is_empty() {
            continue;
        }
        let title = |by: &str| match frames.reference {
            Reference::Truth => format!("{}: {by}", source.case.light),
            Reference::Photograph => format!("{}: {by}", source.case.id),
        };
        let mut input = drawing.input(&source, &frames)?;
        if frames.reference == Reference::Truth {
            let mut cells = vec![input.take()];
            cells.extend(parts(drawing, &source, None, frame)?);
            panels.rows.push(PanelRow { title: title(Reference::Truth.word()), cells });
        }
        for column in shown {
            let mut cells = vec![input.take()];
            cells.extend(parts(drawing, &source, Some(column), frame)?);
            panels.rows.push(PanelRow { title: title(column.method.title()), cells });
            let scored = |row: &&scoring::score::Row| {
                row.light.is_none()
                    && crate::metric::is_chosen(row)
                    && (SHOWN.contains(&row.subject.as_str()) || row.subject.ends_with("_layer"))
            };
            for row in column.rows().iter().filter(scored) {
                drawing.row(json!({
                    "case": source.case.id, "light": source.case.light,
                    "method": column.method.id, "subject": row.subject, "metric": row.metric,
                    "scale": row.scale, "value": row.value,
                }));
            }
        }
    }
    if panels.rows.is_empty() {
        return Err(sources.nothing("maps of a solver"));
    }
    drawing.blocks.push(Block::Panels(panels));
    let truth = match sources.cases().any(|source| source.reference() == Reference::Truth) {
        true => "by the path tracer from the truth and ",
        false => "",
    };
    drawing.caption = format!(
        "Decomposition under each light: an input view, the maps (specular albedo: white is 0.05; normals in object \
         space), and the diffuse and specular layer of that view (the latter × {}), {truth}by each method.",
        Layer::SPECULAR.exposure
    );
    Ok(())
}

/// Maps and layers, of the truth or of a method.
fn parts(
    drawing: &Drawing,
    source: &CaseSource,
    column: Option<&Column>,
    frame: &Frame,
) -> Result<Vec<Option<Panel>>, ReportError> {
    let file = |name: String| -> Option<PathBuf> {
        match column {
            Some(column) => source.map(column, &name),
            None => Some(source.truth(&name)),
        }
    };
    let by = column.map_or("truth".to_owned(), |column| format!("by-{}", column.method.id));
    let name = |part: &str| format!("{}-{by}-{part}", source.case.id);
    let mut cells = Vec::new();
    for map in MAPS.iter().filter(|map| SHOWN.contains(&map.subject)) {
        let path = file(format!("{}.exr", map.subject));
        cells.push(drawing.map(&name(map.subject), path.as_deref(), map)?);
    }
    let layers = file(format!("layers/{}.exr", frame.name));
    for (part, layer) in [("diffuse-layer", Layer::DIFFUSE), ("specular-layer", Layer::SPECULAR)] {
        cells.push(drawing.picture(
            &name(part),
            layers.as_deref(),
            &layer,
            frame,
            String::new(),
        )?);
    }
    Ok(cells)
}
