//! The leaderboard's data: compact for the page, and as a table for others.

use std::path::{Path, PathBuf};

use scoring::tables::{csv_line, csv_number};
use serde_json::{Value, json};

use super::figures::FIGURES;
use super::gather::{Board, Cell};
use crate::link::link;

/// All of it. Values are whole numbers in the figure's last decimal, by entry and figure, in the order of
/// the captures; null where there is none.
pub(super) fn data(board: &Board, out: &Path) -> Value {
    let figures: Vec<Value> = FIGURES
        .iter()
        .map(
            |f| json!({"name": f.name, "unit": f.unit, "higher": f.higher(), "decimals": f.decimals}),
        )
        .collect();
    let runs: Vec<Value> = board
        .runs
        .iter()
        .map(|run| {
            let report = run.has_report.then(|| link(&run.folder.join("report/index.html"), out));
            json!({"name": run.name, "suite": run.suite, "scoring": run.scoring, "report": report})
        })
        .collect();
    let column = |of: &dyn Fn(&super::gather::Capture) -> Value| -> Vec<Value> {
        board.captures.iter().map(of).collect()
    };
    let linked = |place: &Option<(usize, PathBuf)>| {
        let place = place.as_ref().map(|(run, path)| board.runs[*run].folder.join(path));
        json!(place.map(|place| link(&place, out)))
    };
    let entries: Vec<Value> = board
        .entries
        .iter()
        .map(|entry| {
            let values: Vec<Vec<Option<i64>>> = (0..FIGURES.len())
                .map(|figure| {
                    let whole = |cell: &Cell| {
                        let unit = 10f64.powi(FIGURES[figure].decimals as i32);
                        Some((cell.values[figure]? * unit).round() as i64)
                    };
                    let cells = (0..board.captures.len()).map(|at| entry.cells.get(&at));
                    cells.map(|cell| cell.and_then(whole)).collect()
                })
                .collect();
            json!({
                "name": entry.name, "title": entry.title, "role": entry.role,
                "author": entry.author, "content": entry.content,
                "ranked": entry.ranked, "run": entry.run, "values": values,
            })
        })
        .collect();
    json!({
        "format": 1, "figures": figures, "runs": runs, "entries": entries,
        "captures": {
            "case": column(&|c| json!(c.case)), "face": column(&|c| json!(c.face)),
            "light": column(&|c| json!(c.light)), "variant": column(&|c| json!(c.variant)),
            "hash": column(&|c| json!(c.hash.chars().take(12).collect::<String>())), "picture": column(&|c| linked(&c.picture)),
            "head": column(&|c| linked(&c.head)),
        },
    })
}

/// A line for each method on each capture, RFC 4180.
pub(super) fn csv(board: &Board) -> String {
    let mut head: Vec<String> =
        ["capture", "case", "face", "light", "variant", "method", "role", "run"]
            .map(String::from)
            .into();
    head.extend(FIGURES.iter().map(|figure| format!("{} ({})", figure.name, figure.unit)));
    let mut lines = vec![head];
    for entry in &board.entries {
        for (capture, cell) in &entry.cells {
            let c = &board.captures[*capture];
            let texts = [&c.hash, &c.case, &c.face, &c.light, &c.variant, &entry.name];
            let mut line: Vec<String> = texts.map(Clone::clone).into();
            line.extend([entry.role.to_owned(), board.runs[cell.run].name.clone()]);
            line.extend(cell.values.iter().copied().map(csv_number));
            lines.push(line);
        }
    }
    lines.iter().map(|line| csv_line(line) + "\r\n").collect()
}
