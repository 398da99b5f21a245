//! The Digital Emily matrix (figure 9 of Rainer et al. 2023): a face captured in two lights; per input light the
//! withheld view by the method itself, its maps relit in the same light, and in the opposite one, each as
//! observation, result and error.

use serde_json::json;

use super::drawing::{Block, Drawing, PanelRow, Panels};
use super::panels::{ERROR, PictureScores};
use super::source::{CaseSource, Sources};
use crate::error::ReportError;
use crate::views::Layer;

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let mut faces: Vec<(String, Vec<CaseSource>)> = Vec::new();
    for source in sources.cases() {
        let face = source.face();
        match faces.iter_mut().find(|(known, _)| *known == face) {
            Some((_, cases)) => cases.push(source),
            None => faces.push((face, vec![source])),
        }
    }
    for (face, cases) in faces {
        // The two extremes; a suite with more lights names its cases.
        let [first, second, ..] = &cases[..] else { continue };
        if first.case.light == second.case.light {
            continue;
        }
        let parts = ["view synthesis, same light", "relit, same light", "relit, opposite light"];
        let mut columns = vec!["input".to_owned()];
        for part in parts {
            columns.extend([part.to_owned(), "result".to_owned(), "error".to_owned()]);
        }
        for (case, other) in [(first, second), (second, first)] {
            let rows = matrix_rows(sources, drawing, case, &other.case.light)?;
            let title = format!("{face}, captured in {}", case.case.light);
            let error = Some((ERROR.label().to_owned(), ERROR.top()));
            let columns = columns.clone();
            drawing.blocks.push(Block::Panels(Panels { title, columns, rows, error }));
        }
    }
    if drawing.rows.is_empty() {
        return Err(
            sources.nothing("captures of one face in two lights, and a method that is shown")
        );
    }
    drawing.caption = format!(
        "The Digital Emily matrix: each row begins with a picture of the capture. Observation, result and error \
         against it ({} from 0 to {}) of the withheld view by the method itself, of its maps relit in the same light, \
         and relit in the opposite light (albedo after its one factor). PSNR of sRGB values / SSIM / FLIP over the \
         face, all withheld views.",
        ERROR.label(),
        ERROR.top()
    );
    Ok(())
}

fn matrix_rows(
    sources: &Sources,
    drawing: &mut Drawing,
    source: &CaseSource,
    opposite: &str,
) -> Result<Vec<PanelRow>, ReportError> {
    let frames = source.frames()?;
    let Some(frame) = frames.test.first() else { return Ok(Vec::new()) };
    let (id, own) = (&source.case.id, source.case.light.as_str());
    let mut rows = Vec::new();
    for column in source.columns.iter().filter(|column| sources.shows(column)) {
        let method = &column.method.id;
        let mut cells = vec![drawing.input(source, &frames)?];
        for (part, light) in
            [("view", None), ("relit-same", Some(own)), ("relit-opposite", Some(opposite))]
        {
            let truth = match light {
                None => Some(frame.image.clone()),
                Some(light) => frames.relit_reference(frame, light),
            };
            let made = match light {
                None => source.map(column, &format!("views/{}.exr", frame.name)),
                Some(light) => source.relit(column, light, &frame.name),
            };
            let scores = PictureScores::find(column, light, None);
            let name = format!("{id}-by-{method}-{part}");
            let all = &Layer::ALL;
            cells.push(drawing.picture(
                &format!("{id}-{part}-truth"),
                truth.as_deref(),
                all,
                frame,
                String::new(),
            )?);
            cells.push(drawing.picture(&name, made.as_deref(), all, frame, scores.in_words())?);
            cells.push(drawing.error(
                &format!("{name}-error"),
                made.as_deref(),
                truth.as_deref(),
                frame,
            )?);
            let [psnr, ssim, flip] = scores.values();
            drawing.row(json!({
                "face": source.face(), "input light": own, "method": method, "comparison": part,
                "light": light.unwrap_or(own), "psnr_srgb": psnr, "ssim": ssim, "flip_mean": flip,
            }));
        }
        rows.push(PanelRow { title: column.method.title().to_owned(), cells });
    }
    Ok(rows)
}
