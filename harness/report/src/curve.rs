//! The loss of a solver over its iterations, as an inline SVG with a logarithmic axis.

use std::fmt::Write;

use serde_json::Value;

/// Losses of one stage of the optimisation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stage {
    pub name: String,
    /// `(iteration within the stage, loss)`; only positive, finite losses.
    pub points: Vec<(f64, f64)>,
}

/// The entry of `solve.json` that holds the losses.
pub(super) const HISTORY: &str = "stages";

/// The stages of a `solve.json`; empty for a method that keeps no history.
pub(super) fn stages(solve: &Value) -> Vec<Stage> {
    let history = solve.get(HISTORY).and_then(Value::as_array);
    let stages = history.into_iter().flatten().filter_map(stage);
    stages.filter(|stage| stage.points.len() > 1).collect()
}

fn stage(value: &Value) -> Option<Stage> {
    let losses = value.get("loss")?.as_array()?.iter().map(Value::as_f64).enumerate();
    let points = losses.filter_map(|(iteration, loss)| Some((iteration as f64, loss?)));
    Some(Stage {
        name: value.get("name")?.as_str()?.to_owned(),
        points: points.filter(|(_, loss)| *loss > 0.0 && loss.is_finite()).collect(),
    })
}

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 280.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 14.0;
/// Height of a row of stage names.
const NAME_ROW: f64 = 14.0;
/// Width of a letter of the stage names, generously, and the least between two of them.
const LETTER: f64 = 7.2;
const GAP: f64 = 8.0;
/// Room that the number of an iteration takes on its axis.
const NUMBER: f64 = 38.0;
const BOTTOM: f64 = 40.0;

/// More points than this per stage are thinned to the mean of their neighbours.
const POINTS_PER_STAGE: usize = 300;

/// Draws the stages one after the other; `None` without a history.
pub(super) fn svg(stages: &[Stage]) -> Option<String> {
    let losses = || stages.iter().flat_map(|stage| &stage.points).map(|point| point.1);
    let low = losses().min_by(f64::total_cmp)?.log10();
    let high = losses().max_by(f64::total_cmp)?.log10();
    let pad = ((high - low) * 0.06).max(0.02);
    let (low, high) = (low - pad, high + pad);
    let length = |stage: &Stage| stage.points.last().map_or(0.0, |point| point.0) + 1.0;
    let total: f64 = stages.iter().map(length).sum();
    let x = |iteration: f64| LEFT + iteration / total * (WIDTH - LEFT - RIGHT);
    let starts: Vec<f64> = (stages.iter())
        .scan(0.0, |start, stage| Some(x(std::mem::replace(start, *start + length(stage)))))
        .collect();
    let names = placed_names(stages, &starts);
    let rows = names.iter().map(|name| name.row + 1).max().unwrap_or(0);
    let top = 8.0 + NAME_ROW * rows as f64;
    let y = |log: f64| top + (high - log) / (high - low) * (HEIGHT - top - BOTTOM);

    let mut svg = format!(
        "<svg class=\"curve\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
         aria-label=\"loss over iterations\">"
    );
    for (value, text) in ticks(low, high) {
        let place = y(value.log10());
        let _ = write!(
            svg,
            "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{:.1}\" y1=\"{place:.1}\" y2=\"{place:.1}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
            WIDTH - RIGHT,
            LEFT - 8.0,
            place + 4.0,
        );
    }
    let (mut start, mut numbered) = (0.0, f64::NEG_INFINITY);
    for (index, (stage, name)) in stages.iter().zip(&names).enumerate() {
        let (from, to) = (x(start), x(start + length(stage)));
        if index % 2 == 1 {
            let _ = write!(
                svg,
                "<rect class=\"band\" x=\"{from:.1}\" y=\"{top}\" width=\"{:.1}\" height=\"{:.1}\"/>",
                to - from,
                HEIGHT - top - BOTTOM,
            );
        }
        let _ = write!(
            svg,
            "<text class=\"stage\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            name.x,
            top - 6.0 - NAME_ROW * name.row as f64,
            escape(&stage.name),
        );
        if from - numbered >= NUMBER {
            numbered = from;
            let low = HEIGHT - BOTTOM + 16.0;
            let _ = write!(svg, "<text x=\"{from:.1}\" y=\"{low:.1}\">{start}</text>");
        }
        let points: Vec<String> = thinned(&stage.points)
            .into_iter()
            .map(|(iteration, loss)| format!("{:.1},{:.1}", x(start + iteration), y(loss.log10())))
            .collect();
        let _ = write!(svg, "<polyline points=\"{}\"/>", points.join(" "));
        start += length(stage);
    }
    let _ = write!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">iteration (of {total})</text></svg>",
        WIDTH - RIGHT,
        HEIGHT - 6.0,
    );
    Some(svg)
}

/// The place of a stage's name: from `x` to the right, `row` rows above the lowest.
struct Name {
    x: f64,
    row: usize,
}

/// Each name above the begin of its stage, in the lowest row in which it meets no other.
fn placed_names(stages: &[Stage], starts: &[f64]) -> Vec<Name> {
    let mut ends: Vec<f64> = Vec::new();
    let place = |(stage, start): (&Stage, &f64)| {
        let width = stage.name.chars().count() as f64 * LETTER;
        let x = (start + 2.0).min(WIDTH - RIGHT - width).max(0.0);
        let row = ends.iter().position(|end| end + GAP <= x).unwrap_or(ends.len());
        ends.resize(ends.len().max(row + 1), 0.0);
        ends[row] = x + width;
        Name { x, row }
    };
    stages.iter().zip(starts).map(place).collect()
}

/// Values 1, 2 and 5 times a power of ten between two logarithms.
fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let decades = low.floor() as i32..=high.ceil() as i32;
    // Over many decades the powers of ten alone.
    let steps: &[f64] = if high - low > 2.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    decades
        .flat_map(|decade| steps.iter().map(move |step| (step * 10f64.powi(decade), decade)))
        .filter(|(value, _)| (low..=high).contains(&value.log10()))
        .map(|(value, decade)| (value, format!("{value:.*}", (-decade).max(0) as usize)))
        .collect()
}

fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let bin = points.len().div_ceil(POINTS_PER_STAGE).max(1);
    let mean = |bin: &[(f64, f64)], part: fn(&(f64, f64)) -> f64| {
        bin.iter().map(part).sum::<f64>() / bin.len() as f64
    };
    points.chunks(bin).map(|bin| (mean(bin, |p| p.0), mean(bin, |p| p.1))).collect()
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn stages_follow_each_other_and_lower_losses_lie_lower() {
        let solve = json!({"stages": [
            {"name": "warm-up", "loss": [1.0, 0.1]},
            {"name": "<b>", "loss": [0.01, 0.001]},
        ]});
        let svg = svg(&stages(&solve)).unwrap();
        let lines: Vec<Vec<f64>> = svg
            .split("<polyline points=\"")
            .skip(1)
            .map(|rest| {
                let points = rest.split('"').next().unwrap();
                points.split([' ', ',']).map(|number| number.parse().unwrap()).collect()
            })
            .collect();
        assert_eq!(lines.len(), 2);
        assert!(lines[0][2] < lines[1][0], "the second stage begins after the first");
        let heights = [lines[0][1], lines[0][3], lines[1][1], lines[1][3]];
        let steps: Vec<f64> = heights.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.iter().all(|step| (step - steps[0]).abs() < 0.3), "decades are equal steps");
        assert!(svg.contains("&lt;b&gt;") && !svg.contains("<b>"));
    }

    #[test]
    fn names_of_short_stages_do_not_meet_and_stay_in_the_picture() {
        let lengths = [60, 60, 16, 10, 10, 10];
        let stages: Vec<Stage> = (lengths.iter())
            .map(|count| Stage {
                name: "normals and specular".to_owned(),
                points: (0..*count).map(|i| (f64::from(i), 0.1)).collect(),
            })
            .collect();
        let starts = [62.0, 309.0, 556.0, 622.0, 663.0, 705.0];
        let names = placed_names(&stages, &starts);
        let width = 20.0 * LETTER;
        for (i, name) in names.iter().enumerate() {
            assert!(name.x + width <= WIDTH);
            for other in &names[..i] {
                let apart = (name.x - other.x).abs() >= width;
                assert!(apart || name.row != other.row, "{} {}", name.x, other.x);
            }
        }
        assert_eq!((names[0].row, names[1].row), (0, 0), "room enough for one row");
        let svg = svg(&stages).unwrap();
        assert_eq!(svg.matches("class=\"stage\"").count(), 6);
    }

    #[test]
    fn a_solver_without_a_history_has_no_curve() {
        assert!(svg(&stages(&json!({"seed": 1}))).is_none());
        let broken = json!({"stages": [{"name": "s", "loss": [-1.0, null]}]});
        assert!(svg(&stages(&broken)).is_none());
    }
}
