//! The robustness map: how good albedo and relit views are over exposure, specular reflectance and roughness of the
//! truth, for each type of skin.

use serde_json::json;

use super::drawing::{Block, Drawing, Heat};
use super::quantity::QUANTITIES;
use super::source::{CaseSource, Sources};
use super::statistics::over_faces;
use crate::error::ReportError;

/// The place of a case in the map.
struct Place {
    skin: String,
    exposure: f64,
    specular: f64,
    roughness: f64,
}

/// One measured case.
struct Found {
    place: Place,
    method: String,
    face: String,
    values: [Option<f64>; 2],
}

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let mut found = Vec::new();
    let mut titles: Vec<(String, String)> = Vec::new();
    for source in sources.cases() {
        let place = place(&source)?;
        for column in source.columns.iter().filter(|column| sources.shows(column)) {
            let id = column.method.id.clone();
            let values = [0, 1].map(|at| QUANTITIES[at].key.value(column, &source.case.light));
            let Place { skin, exposure, specular, roughness } = &place;
            drawing.row(json!({
                "case": source.case.id, "face": source.case.face, "skin": skin,
                "exposure": exposure, "specular_scale": specular, "roughness_scale": roughness,
                "method": id, "albedo": values[0], "relit": values[1],
            }));
            if !titles.iter().any(|(known, _)| *known == id) {
                titles.push((id.clone(), column.method.title().to_owned()));
            }
            let place = Place { skin: skin.clone(), ..place };
            found.push(Found { place, method: id, face: source.case.face.clone(), values });
        }
    }
    let numbers = |of: fn(&Place) -> f64| -> Vec<f64> {
        let mut all: Vec<f64> = found.iter().map(|found| of(&found.place)).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (x, y) = (numbers(|place| place.exposure), numbers(|place| place.specular));
    if x.len() < 2 && y.len() < 2 {
        return Err(sources.nothing("cases of several exposures or specular scales"));
    }
    let roughness = numbers(|place| place.roughness);
    let mut skins: Vec<&String> = found.iter().map(|found| &found.place.skin).collect();
    skins.sort();
    skins.dedup();
    for (method, title) in &titles {
        for (at, quantity) in QUANTITIES[..2].iter().enumerate() {
            // Types of skin beside each other.
            for rough in &roughness {
                for skin in &skins {
                    let cell = |exposure: f64, specular: f64| {
                        let here = found.iter().filter(|found| {
                            let place = &found.place;
                            found.method == *method
                                && (&place.skin, place.exposure, place.specular, place.roughness)
                                    == (*skin, exposure, specular, *rough)
                        });
                        let values: Vec<(String, f64)> = here
                            .filter_map(|found| Some((found.face.clone(), found.values[at]?)))
                            .collect();
                        over_faces(&values).map(|mean| mean.value)
                    };
                    let values =
                        y.iter().map(|y| x.iter().map(|x| cell(*x, *y)).collect()).collect();
                    drawing.blocks.push(Block::Heat(Heat {
                        title: format!(
                            "{title}, {}\nskin {skin}, roughness × {rough}",
                            quantity.name
                        ),
                        label: quantity.label.to_owned(),
                        x_label: "exposure ×".to_owned(),
                        y_label: "specular ×".to_owned(),
                        x: x.clone(),
                        y: y.clone(),
                        values,
                    }));
                }
            }
        }
    }
    drawing.caption = "Robustness: albedo after one factor and views relit in other lights (PSNR of sRGB values, dB) \
                       over the capture's exposure and the truth's specular reflectance, for each roughness and type \
                       of skin (Fitzpatrick); means over faces, one colour scale per quantity."
        .to_owned();
    Ok(())
}

/// From the scene that the capture was rendered from; what it leaves out is 1.
fn place(source: &CaseSource) -> Result<Place, ReportError> {
    let path = source.truth("scene.toml");
    let text = std::fs::read_to_string(&path).map_err(|error| ReportError::read(&path, error))?;
    let scene: toml::Table = text.parse().map_err(|error: toml::de::Error| ReportError::Json {
        path,
        reason: error.message().to_owned(),
    })?;
    let value = |table: &str, key: &str| scene.get(table).and_then(|table| table.get(key));
    let number = |table: &str, key: &str| {
        let value = value(table, key)?;
        value.as_float().or(value.as_integer().map(|whole| whole as f64))
    };
    Ok(Place {
        skin: value("face", "fitzpatrick")
            .and_then(toml::Value::as_str)
            .unwrap_or("own")
            .to_owned(),
        exposure: number("light", "exposure").unwrap_or(1.0),
        specular: number("face", "specular_scale").unwrap_or(1.0),
        roughness: number("face", "roughness_scale").unwrap_or(1.0),
    })
}
