//! Change of each variant of a suite against its first one: the drop of every method, subtracted face
//! by face and then averaged.

use scoring::tables::{markdown_head, markdown_row, markdown_text};

use super::figures::{Figure, TABLES};
use super::finished::Finished;
use super::tables::Group;
use crate::page;
use crate::run::Case;
use crate::score_key::mean;
use crate::table;

/// Headings of the figures that are shown.
const SHOWN: [&str; 7] = [
    "albedo",
    "as is",
    "relit, own",
    "relit, others",
    "specular normal, °",
    "layer, correlation",
    "layer, energy",
];

/// One table for every light that has several variants; nothing where there are none.
pub(super) fn drops(run: &Finished, groups: &[Group]) -> String {
    let mut lights: Vec<&str> = Vec::new();
    for group in groups {
        if !lights.contains(&&*group.light) {
            lights.push(&group.light);
        }
    }
    let mut text = String::new();
    for light in lights {
        let mut of_light = groups.iter().filter(|group| group.light == light);
        let Some(first) = of_light.next() else { continue };
        let others: Vec<&Group> = of_light.collect();
        let Some(matched) = first.variant.as_deref().filter(|_| !others.is_empty()) else {
            continue;
        };
        let (light, matched) = (markdown_text(light), markdown_text(matched));
        text.push_str(&format!(
            "\n### {light} light: change against \"{matched}\"\n\n\
             Means over the faces of this variant's figure less that of \"{matched}\".\n\n"
        ));
        text.push_str(&changes(run, first, &others));
    }
    text
}

fn changes(run: &Finished, first: &Group, others: &[&Group]) -> String {
    let figures = || TABLES.iter().flat_map(|(_, figures)| *figures);
    let figures: Vec<&Figure> = figures().filter(|figure| SHOWN.contains(&figure.short)).collect();
    let headings = figures.iter().map(|figure| figure.short);
    let mut text = markdown_head(["variant", "method"].into_iter().chain(headings));
    let titles = |case: &Case| -> Vec<(String, String)> {
        let ids = case.methods.iter().map(|method| method.id.clone());
        ids.zip(case.methods.iter().map(|method| markdown_text(method.title()))).collect()
    };
    let methods = first.cases.first().map_or(Vec::new(), |case| titles(&run.manifest.cases[*case]));
    for group in others {
        let name = markdown_text(group.variant.as_deref().unwrap_or_default());
        for (id, title) in &methods {
            let cells = figures.iter().map(|figure| {
                let pairs = first.cases.iter().filter_map(|before| {
                    let face = &run.manifest.cases[*before].face;
                    let same = |case: &&usize| run.manifest.cases[**case].face == *face;
                    let after = group.cases.iter().find(same)?;
                    let at = |case| value(run, case, id, figure);
                    Some(at(*after)? - at(*before)?)
                });
                match mean(pairs) {
                    // What rounds to nothing has no sign.
                    Some(change) if change.abs() < 0.5 * 0.1_f64.powi(figure.decimals as i32) => {
                        table::shown(Some(0.0), figure.decimals)
                    }
                    Some(change) => table::shown(Some(change), figure.decimals),
                    None => table::EMPTY.to_owned(),
                }
            });
            text.push_str(&markdown_row([name.clone(), title.clone()].into_iter().chain(cells)));
        }
    }
    text
}

/// A method's figure in one case.
fn value(run: &Finished, case: usize, id: &str, figure: &Figure) -> Option<f64> {
    let shown = &run.manifest.cases[case];
    let columns = page::columns(shown, &run.scores[case]);
    let column = columns.into_iter().find(|column| column.method.id == id)?;
    Some(figure.find(&column, &shown.light)?.value)
}
