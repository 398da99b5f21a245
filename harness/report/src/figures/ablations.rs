//! Gain of each part of a method: every method and variant of the runs against the first, on the same cases
//! (the supplement of Rainer et al. 2023).

use serde_json::json;

use super::drawing::{Bar, Bars, Block, Drawing};
use super::quantity::{QUANTITIES, Quantity};
use super::source::{CaseSource, Sources};
use super::statistics::{Mean, over_faces};
use crate::error::ReportError;
use crate::exports::Export;
use crate::run::Kind;
use crate::table::Column;

/// A method in a variant.
#[derive(Clone, PartialEq)]
struct Setting {
    variant: Option<String>,
    method: String,
    title: String,
}

/// A number of a setting in a case: the face, what makes the case the same one elsewhere, the value.
type Found = (String, String, f64);

/// Ablations: the passive solvers over all lights.
pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let wanted = "a second method or variant of a solver";
    let first = compare(sources, drawing, wanted, |column| sources.shows(column), false)?;
    drawing.caption = format!(
        "Ablations: the difference to {first} on the same cases, mean over faces with the 95 % interval of Student's t \
         over faces (none with a single face)."
    );
    Ok(())
}

/// The bias budget: a solver, and the same solver with parts held at their truth, in each light.
pub(super) fn draw_bias(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let shows = |column: &Column| sources.shows(column) || column.method.kind == Kind::Privileged;
    let first = compare(sources, drawing, "a solver that is `given` parts", shows, true)?;
    drawing.caption = format!(
        "Bias budget: the gain over {first} where parts are held at their truth, by light, mean over faces with the \
         95 % interval of Student's t over faces (none with a single face)."
    );
    Ok(())
}

/// Compares all settings that are shown with the first, whose name is returned; `by_light` in each light alone.
fn compare(
    sources: &Sources,
    drawing: &mut Drawing,
    wanted: &str,
    shows: impl Fn(&Column) -> bool,
    by_light: bool,
) -> Result<String, ReportError> {
    let cases: Vec<CaseSource> = sources.cases().collect();
    let settings = settings(&cases, shows);
    if settings.len() < 2 {
        return Err(sources.nothing(wanted));
    }
    let names = names(&settings);
    let mut lights = Vec::new();
    for source in &cases {
        let light = by_light.then_some(&*source.case.light);
        let is_scored = source.columns.iter().any(|column| column.scores.is_some());
        if is_scored && !lights.contains(&light) {
            lights.push(light);
        }
    }
    let mut shown = Vec::new();
    for light in lights {
        let in_light = |source: &&CaseSource| light.is_none_or(|light| source.case.light == light);
        let cases: Vec<&CaseSource> = cases.iter().filter(in_light).collect();
        shown.extend(compare_in(drawing, &cases, &settings, &names, light));
    }
    let mut headings = vec!["setting".to_owned()];
    headings.extend(QUANTITIES.iter().map(|quantity| quantity.label.to_owned()));
    drawing.table = Some(Export { keys: vec![], rows: vec![], headings, shown });
    Ok(names[0].clone())
}

/// One block of bars for each quantity; the rows of the table.
fn compare_in(
    drawing: &mut Drawing,
    cases: &[&CaseSource],
    settings: &[Setting],
    names: &[String],
    light: Option<&str>,
) -> Vec<Vec<String>> {
    let titled = |name: &str| light.map_or(name.to_owned(), |light| format!("{light}: {name}"));
    let reference = &settings[0];
    let mut shown: Vec<Vec<String>> = names.iter().map(|name| vec![titled(name)]).collect();
    for quantity in &QUANTITIES {
        let base = values(cases, reference, quantity);
        let mut bars = Vec::new();
        for ((setting, name), row) in settings.iter().zip(names).zip(&mut shown) {
            let found = values(cases, setting, quantity);
            let mean = over_faces(
                &found.iter().map(|(face, _, v)| (face.clone(), *v)).collect::<Vec<_>>(),
            );
            let paired: Vec<(String, f64)> = found
                .iter()
                .filter_map(|(face, case, value)| {
                    let (.., before) = base.iter().find(|(f, c, _)| f == face && c == case)?;
                    Some((face.clone(), value - before))
                })
                .collect();
            let difference = over_faces(&paired);
            row.push(in_words(mean));
            if setting != reference {
                bars.push(Bar {
                    name: name.clone(),
                    value: difference.map(|mean| mean.value),
                    interval: difference.and_then(|mean| mean.interval),
                });
            }
            let ends = |mean: Option<Mean>| {
                mean.and_then(|mean| mean.interval).map_or([None; 2], |e| e.map(Some))
            };
            let ([low, high], [less, more]) = (ends(mean), ends(difference));
            drawing.row(json!({
                "setting": name, "light": light, "variant": setting.variant, "method": setting.method,
                "quantity": quantity.name, "faces": mean.map_or(0, |mean| mean.faces),
                "mean": mean.map(|mean| mean.value), "low": low, "high": high,
                "reference": names[0], "difference": difference.map(|mean| mean.value),
                "difference low": less, "difference high": more,
            }));
        }
        let mean = in_words(over_faces(
            &base.into_iter().map(|(face, _, v)| (face, v)).collect::<Vec<_>>(),
        ));
        drawing.blocks.push(Block::Bars(Bars {
            title: match light {
                Some(light) => format!("{light}: {} (as it is: {mean})", quantity.name),
                None => format!("{} ({}: {mean})", quantity.label, names[0]),
            },
            label: "difference".to_owned(),
            steps: false,
            bars,
            levels: Vec::new(),
        }));
    }
    shown
}

fn settings(cases: &[CaseSource], shows: impl Fn(&Column) -> bool) -> Vec<Setting> {
    let mut found = Vec::new();
    for source in cases {
        for column in source.columns.iter().filter(|column| shows(column)) {
            let setting = Setting {
                variant: source.case.variant.clone(),
                method: column.method.id.clone(),
                title: column.method.title().to_owned(),
            };
            if !found.contains(&setting) {
                found.push(setting);
            }
        }
    }
    found
}

/// The shortest names that differ.
fn names(settings: &[Setting]) -> Vec<String> {
    let one_method = settings.iter().all(|setting| setting.method == settings[0].method);
    let name = |setting: &Setting| match &setting.variant {
        Some(variant) if one_method => variant.clone(),
        Some(variant) => format!("{}, {variant}", setting.title),
        None => setting.title.clone(),
    };
    settings.iter().map(name).collect()
}

fn values(cases: &[&CaseSource], setting: &Setting, quantity: &Quantity) -> Vec<Found> {
    let of_variant = cases.iter().filter(|source| source.case.variant == setting.variant);
    of_variant
        .filter_map(|source| {
            let column = source.columns.iter().find(|column| column.method.id == setting.method)?;
            let value = quantity.key.value(column, &source.case.light)?;
            Some((source.case.face.clone(), source.case.light.clone(), value))
        })
        .collect()
}

fn in_words(mean: Option<Mean>) -> String {
    match mean {
        None => "–".to_owned(),
        Some(Mean { value, interval: None, .. }) => format!("{value:.2}"),
        Some(Mean { value, interval: Some([_, high]), .. }) => {
            format!("{value:.2} ± {:.2}", high - value)
        }
    }
}
