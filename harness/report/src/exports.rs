//! Each table of the page as files: CSV, JSON and LaTeX (booktabs).

use std::path::Path;

use scoring::tables::csv_line;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::error::ReportError;
use super::save::write_file;
use super::table::Table;

/// A table without its looks. A cell is a number or text; null where there is nothing.
pub(super) struct Export {
    /// Keys of CSV and JSON.
    pub keys: Vec<String>,
    pub rows: Vec<Vec<Value>>,
    /// Heading of every LaTeX column, and its cells as they are shown.
    pub headings: Vec<String>,
    pub shown: Vec<Vec<String>>,
}

/// The places of the files below the report.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Links {
    pub csv: String,
    pub json: String,
    pub tex: String,
}

impl Export {
    /// A table of scores: one row per score, three columns per method.
    pub fn of_scores(table: &Table) -> Self {
        let described = ["id", "subject", "metric", "unit", "region", "space", "scale"];
        let mut keys: Vec<String> = described.map(str::to_owned).into();
        for column in &table.columns {
            let ends = ["", " low", " high"];
            keys.extend(ends.map(|end| format!("{}{end}", column.title)));
        }
        keys.extend(["trivial".to_owned(), "noise floor".to_owned()]);
        let mut headings = vec!["subject".to_owned(), "metric".to_owned(), "scale".to_owned()];
        headings.extend(table.columns.iter().map(|column| column.title.clone()));
        let (mut rows, mut shown) = (Vec::new(), Vec::new());
        for group in &table.groups {
            for line in &group.rows {
                let words =
                    [&line.id, &group.title, &line.name, line.unit, &line.region, line.space];
                let mut row: Vec<Value> = words.into_iter().map(Value::from).collect();
                row.push(Value::from(line.scale.as_str()));
                for cell in &line.cells {
                    let end = |at: usize| cell.ci95.map(|ends| ends[at]);
                    row.extend([cell.number, end(0), end(1)].map(Value::from));
                }
                row.extend([line.numbers.0, line.numbers.1].map(Value::from));
                rows.push(row);
                let unit = if line.unit.is_empty() { "" } else { ", " };
                let mut cells = vec![
                    group.title.clone(),
                    format!("{}{unit}{}", line.name, line.unit),
                    line.scale.clone(),
                ];
                cells.extend(line.cells.iter().map(|cell| cell.value.clone()));
                shown.push(cells);
            }
        }
        Self { keys, rows, headings, shown }
    }

    /// Writes `<folder>/<name>.csv`, `.json` and `.tex` below `root`.
    pub fn write(&self, root: &Path, folder: &str, name: &str) -> Result<Links, ReportError> {
        let save = |end: &str, text: String| {
            let below = format!("{folder}/{name}.{end}");
            write_file(&root.join(&below), text)?;
            Ok::<_, ReportError>(below)
        };
        Ok(Links {
            csv: save("csv", self.csv())?,
            json: save("json", self.json())?,
            tex: save("tex", self.latex())?,
        })
    }

    /// The table as CSV (RFC 4180) with a heading; numbers in full.
    pub fn csv(&self) -> String {
        let mut text = csv_line(&self.keys) + "\r\n";
        for row in &self.rows {
            text += &(csv_line(row.iter().map(csv_cell)) + "\r\n");
        }
        text
    }

    fn json(&self) -> String {
        let object = |row: &Vec<Value>| -> Value {
            self.keys.iter().cloned().zip(row.iter().cloned()).collect::<Map<_, _>>().into()
        };
        let rows: Vec<Value> = self.rows.iter().map(object).collect();
        format!("{:#}\n", json!(rows))
    }

    /// The table as a `tabular` of the package booktabs.
    pub fn latex(&self) -> String {
        let text = self.headings.iter().zip(self.shown.first().into_iter().flatten());
        let kinds: String =
            text.map(|(_, cell)| if starts_as_number(cell) { 'r' } else { 'l' }).collect();
        let line = |cells: &Vec<String>| latex_line(cells.iter().map(|cell| latex_text(cell)));
        let body: String = self.shown.iter().map(line).collect();
        format!("% \\usepackage{{booktabs}}\n{}", tabular(&kinds, &line(&self.headings), &body))
    }
}

/// A line of a LaTeX table; the cells are LaTeX.
pub(super) fn latex_line(cells: impl IntoIterator<Item = String>) -> String {
    cells.into_iter().collect::<Vec<_>>().join(" & ") + " \\\\\n"
}

/// A `tabular` with the rules of the package booktabs; `kinds` has a letter for each column.
pub(super) fn tabular(kinds: &str, head: &str, body: &str) -> String {
    format!(
        "\\begin{{tabular}}{{{kinds}}}\n\\toprule\n{head}\\midrule\n{body}\\bottomrule\n\\end{{tabular}}\n"
    )
}

fn starts_as_number(cell: &str) -> bool {
    let start = cell.trim_start_matches(['-', '–']);
    start.is_empty() || start.starts_with(|c: char| c.is_ascii_digit())
}

fn csv_cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// Text of any characters for LaTeX.
pub(super) fn latex_text(text: &str) -> String {
    let mut out = String::new();
    for letter in text.chars() {
        match letter {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', letter]),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '\\' => out.push_str("\\textbackslash{}"),
            '<' => out.push_str("\\textless{}"),
            '>' => out.push_str("\\textgreater{}"),
            '°' => out.push_str("$^\\circ$"),
            '²' => out.push_str("$^2$"),
            '×' => out.push_str("$\\times$"),
            'Δ' => out.push_str("$\\Delta$"),
            '↑' => out.push_str("$\\uparrow$"),
            '↓' => out.push_str("$\\downarrow$"),
            '…' => out.push_str("\\dots{} "),
            '–' => out.push_str("--"),
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn export() -> Export {
        Export {
            keys: vec!["method".to_owned(), "a, \"b\"".to_owned()],
            rows: vec![vec![json!("x_y"), json!(0.1)], vec![json!("z"), Value::Null]],
            headings: vec!["method".to_owned(), "PSNR ↑".to_owned()],
            shown: vec![
                vec!["x_y".to_owned(), "0.10".to_owned()],
                vec!["z".to_owned(), "–".to_owned()],
            ],
        }
    }

    #[test]
    fn csv_is_quoted_json_has_numbers_and_latex_is_escaped() {
        assert_eq!(export().csv(), "method,\"a, \"\"b\"\"\"\r\nx_y,0.1\r\nz,\r\n");
        let back: Value = serde_json::from_str(&export().json()).unwrap();
        assert_eq!(
            back,
            json!([{"method": "x_y", "a, \"b\"": 0.1}, {"method": "z", "a, \"b\"": null}])
        );
        let latex = export().latex();
        assert!(latex.contains("\\begin{tabular}{lr}"), "{latex}");
        assert!(latex.contains("x\\_y & 0.10 \\\\\nz & -- \\\\"), "{latex}");
        assert!(latex.contains("PSNR $\\uparrow$"), "{latex}");
    }
}
