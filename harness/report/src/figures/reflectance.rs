//! Reflectance side by side: input, re-rendering, maps and a relit view, one row per method (figure 8 of Rainer et
//! al. 2023), with the truth on top.

use serde_json::json;

use super::drawing::{Block, Drawing, PanelRow, Panels};
use super::panels::PictureScores;
use super::source::Sources;
use crate::error::ReportError;
use crate::maps::MAPS;
use crate::reference::Reference;
use crate::views::Layer;

/// The maps of the figure, in the paper's order.
const SHOWN: [&str; 3] = ["diffuse_albedo", "specular_albedo", "specular_normal"];

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let maps: Vec<_> = MAPS.iter().filter(|map| SHOWN.contains(&map.subject)).collect();
    for source in sources.cases() {
        let frames = source.frames()?;
        let Some(frame) = frames.test.first() else { continue };
        let lights = source.lights();
        let Some(light) = lights.get(1).or(lights.first()) else { continue };
        let mut columns = vec!["input".to_owned(), "re-rendering".to_owned()];
        columns.extend(maps.iter().map(|map| map.title.to_lowercase()));
        columns.push(format!("relit, {light}"));
        let id = &source.case.id;
        let mut cells = vec![drawing.input(&source, &frames)?];
        let nothing = String::new;
        cells.push(drawing.picture(
            &format!("{id}-truth-view"),
            Some(&frame.image),
            &Layer::ALL,
            frame,
            nothing(),
        )?);
        for map in &maps {
            let path = source.truth(&format!("{}.exr", map.subject));
            cells.push(drawing.map(&format!("{id}-truth-{}", map.subject), Some(&path), map)?);
        }
        let truth = frames.relit_reference(frame, light);
        cells.push(drawing.picture(
            &format!("{id}-truth-relit"),
            truth.as_deref(),
            &Layer::ALL,
            frame,
            nothing(),
        )?);
        let mut rows = vec![PanelRow { title: frames.reference.word().to_owned(), cells }];
        let shown: Vec<_> = source.columns.iter().filter(|column| sources.shows(column)).collect();
        for column in shown {
            let method = &column.method.id;
            let view = source.map(column, &format!("views/{}.exr", frame.name));
            let caption = PictureScores::find(column, None, Some(&frame.name)).in_words();
            let name = format!("{id}-by-{method}");
            let mut cells = vec![
                None,
                drawing.picture(
                    &format!("{name}-view"),
                    view.as_deref(),
                    &Layer::ALL,
                    frame,
                    caption,
                )?,
            ];
            for map in &maps {
                let path = source.map(column, &format!("{}.exr", map.subject));
                let mut panel =
                    drawing.map(&format!("{name}-{}", map.subject), path.as_deref(), map)?;
                if let (Some(panel), Some(caption)) =
                    (&mut panel, caption_of_map(column, map.subject))
                {
                    panel.caption = caption;
                }
                cells.push(panel);
            }
            let relit = source.relit(column, light, &frame.name);
            let caption = PictureScores::find(column, Some(light), Some(&frame.name)).in_words();
            cells.push(drawing.picture(
                &format!("{name}-relit"),
                relit.as_deref(),
                &Layer::ALL,
                frame,
                caption,
            )?);
            rows.push(PanelRow { title: column.method.title().to_owned(), cells });
            for row in column.rows().iter().filter(|row| crate::metric::is_chosen(row)) {
                let ends = row.ci95.map_or([None; 2], |ends| ends.map(Some));
                drawing.row(json!({
                    "case": id, "method": method, "subject": row.subject, "light": row.light,
                    "metric": row.metric, "scale": row.scale, "value": row.value, "low": ends[0],
                    "high": ends[1],
                }));
            }
        }
        if rows.len() > 1 {
            let title = match frames.reference {
                Reference::Truth => format!("{}, captured in {}", source.face(), source.case.light),
                Reference::Photograph => format!("{}, photographed", source.face()),
            };
            drawing.blocks.push(Block::Panels(Panels { title, columns, rows, error: None }));
        }
    }
    if drawing.blocks.is_empty() {
        return Err(sources.nothing("maps of a solver"));
    }
    let rendered = sources.cases().any(|source| source.reference() == Reference::Truth);
    let [factor, maps] = match rendered {
        true => [
            " (albedo after its one factor)",
            "; albedo: PSNR after one factor; specular albedo: RMSE; normal: mean angle",
        ],
        false => [" in the recovered light", ""],
    };
    drawing.caption = format!(
        "Reflectance side by side: input view, the withheld view by each method itself, recovered diffuse albedo, \
         specular albedo (white is 0.05) and specular normal (object space), and the maps relit{factor}. PSNR of \
         sRGB values / SSIM / FLIP over the face{maps}."
    );
    Ok(())
}

fn caption_of_map(column: &crate::table::Column, subject: &str) -> Option<String> {
    let value = |metric: &str, scale: &str| column.find(subject, None, metric, scale)?.value;
    Some(match subject {
        "diffuse_albedo" => format!("{:.2} dB", value("psnr_srgb", "global")?),
        "specular_albedo" => format!("{:.4}", value("rmse", "none")?),
        _ => format!("{:.2}°", value("normal_mean_deg", "none")?),
    })
}
