//! Relighting in several environments, one row per case: input, then truth and each method in every light
//! (figure 6 of Rainer et al. 2023, with the truth that a rendered face has).

use serde_json::json;

use super::drawing::{Block, Drawing, PanelRow, Panels};
use super::panels::PictureScores;
use super::source::{CaseSource, Sources};
use crate::error::ReportError;
use crate::reference::Reference;
use crate::run::Frames;
use crate::table::Column;
use crate::views::Layer;

/// More lights than this fill no page.
const LIGHTS: usize = 4;

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let cases: Vec<CaseSource> = sources.cases().collect();
    // The columns are the same for every case.
    let mut lights: Vec<String> = cases.iter().flat_map(CaseSource::lights).collect();
    lights.sort();
    lights.dedup();
    // With other lights than the capture's alone there is no need to show its own.
    let captured = |light: &String| cases.iter().all(|source| source.case.light == *light);
    if lights.iter().any(|light| !captured(light)) {
        lights.retain(|light| !captured(light));
    }
    lights.truncate(LIGHTS);
    let mut names: Vec<(String, String)> = Vec::new();
    for column in cases.iter().flat_map(|source| &source.columns) {
        let name = (column.method.id.clone(), column.method.title().to_owned());
        if sources.shows(column) && !names.contains(&name) {
            names.push(name);
        }
    }
    let reference = Reference::common_word(cases.iter().map(CaseSource::reference));
    let mut panels = Panels { columns: vec!["input".to_owned()], ..Panels::default() };
    for light in &lights {
        panels.columns.push(format!("{reference}, {light}"));
        panels.columns.extend(names.iter().map(|(_, title)| format!("{title}, {light}")));
    }
    for source in &cases {
        let frames = source.frames()?;
        let Some(frame) = frames.test.first() else { continue };
        let mut cells = vec![drawing.input(source, &frames)?];
        for light in &lights {
            let truth = frames.relit_reference(frame, light);
            let id = &source.case.id;
            let name = format!("{id}-{light}");
            let nothing = String::new();
            cells.push(drawing.picture(
                &format!("{name}-truth"),
                truth.as_deref(),
                &Layer::ALL,
                frame,
                nothing,
            )?);
            for (method, _) in &names {
                let column = source.columns.iter().find(|column| column.method.id == *method);
                let (path, scores) = match column {
                    Some(column) => (
                        source.relit(column, light, &frame.name),
                        Some(PictureScores::find(column, Some(light), Some(&frame.name))),
                    ),
                    None => (None, None),
                };
                let caption = scores.as_ref().map_or(String::new(), PictureScores::in_words);
                let name = format!("{name}-by-{method}");
                cells.push(drawing.picture(&name, path.as_deref(), &Layer::ALL, frame, caption)?);
            }
        }
        let scored = source.columns.iter().filter(|column| sources.shows(column));
        for column in scored {
            add_rows(drawing, source, column, &lights, &frames);
        }
        let title = format!("{}, {}", source.face(), source.case.light);
        panels.rows.push(PanelRow { title, cells });
    }
    if drawing.rows.is_empty() {
        return Err(sources.nothing("relit pictures of a solver"));
    }
    drawing.blocks.push(Block::Panels(panels));
    let compared = match reference {
        "photograph" => {
            "a withheld photograph, and that view path-traced with the recovered maps in the recovered light (found)"
        }
        "truth" => {
            "a withheld view under each light, path-traced with the true maps and with the recovered ones (albedo after its one factor)"
        }
        _ => {
            "a withheld view: of rendered faces under each light, path-traced with the true maps and with the \
              recovered ones (albedo after its one factor); of photographed ones the photograph, and the view \
              path-traced with the recovered maps in the recovered light (found)"
        }
    };
    drawing.caption = format!(
        "Relighting: an input view, then {compared}. PSNR of sRGB values / SSIM / FLIP, over the face."
    );
    Ok(())
}

fn add_rows(
    drawing: &mut Drawing,
    source: &CaseSource,
    column: &Column,
    lights: &[String],
    frames: &Frames,
) {
    let case = source.case;
    for light in lights {
        for frame in &frames.test {
            let scores = PictureScores::find(column, Some(light), Some(&frame.name));
            let [psnr, ssim, flip] = scores.values();
            if psnr.is_some() {
                drawing.row(json!({
                    "case": case.id, "face": source.face(), "capture light": case.light,
                    "method": column.method.id, "light": light, "view": frame.name,
                    "psnr_srgb": psnr, "ssim": ssim, "flip_mean": flip,
                }));
            }
        }
    }
}
