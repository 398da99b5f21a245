//! A figure as data: blocks of panels and of plots, and the table behind them.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use crate::error::ReportError;
use crate::exports::{Export, latex_line, latex_text};
use crate::save::create_parent;
use crate::tone::Raster;

/// A figure under construction.
#[derive(Serialize)]
pub(super) struct Drawing {
    #[serde(skip)]
    root: PathBuf,
    pub caption: String,
    pub blocks: Vec<Block>,
    /// Rows of the CSV: objects of the same keys.
    #[serde(skip)]
    pub rows: Vec<Value>,
    /// A table for LaTeX in the panels' place.
    #[serde(skip)]
    pub table: Option<Export>,
}

/// One part of a figure.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(super) enum Block {
    Panels(Panels),
    Heat(Heat),
    Lines(Lines),
    Bars(Bars),
}

/// Pictures in rows and columns.
#[derive(Default, Serialize)]
pub(super) struct Panels {
    pub title: String,
    pub columns: Vec<String>,
    pub rows: Vec<PanelRow>,
    /// Quantity of the error pictures, and the value where their colours end.
    pub error: Option<(String, f32)>,
}

#[derive(Serialize)]
pub(super) struct PanelRow {
    pub title: String,
    /// One per column; none where nothing was made.
    pub cells: Vec<Option<Panel>>,
}

#[derive(Clone, Serialize)]
pub(super) struct Panel {
    /// Below the figure's folder.
    pub file: String,
    pub height_over_width: f64,
    pub caption: String,
}

/// A value over two quantities.
#[derive(Serialize)]
pub(super) struct Heat {
    pub title: String,
    pub label: String,
    pub x_label: String,
    pub y_label: String,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// One row per `y`.
    pub values: Vec<Vec<Option<f64>>>,
}

/// Curves with intervals.
#[derive(Serialize)]
pub(super) struct Lines {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub logarithmic: bool,
    /// Values at which a line goes across.
    pub across: Vec<f64>,
    pub lines: Vec<Line>,
}

#[derive(Serialize)]
pub(super) struct Line {
    pub name: String,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub interval: Vec<Option<[f64; 2]>>,
}

/// Bars, and levels that bound them.
#[derive(Serialize)]
pub(super) struct Bars {
    pub title: String,
    pub label: String,
    /// Each bar begins where the one before ends.
    pub steps: bool,
    pub bars: Vec<Bar>,
    pub levels: Vec<(String, f64)>,
}

#[derive(Serialize)]
pub(super) struct Bar {
    pub name: String,
    pub value: Option<f64>,
    pub interval: Option<[f64; 2]>,
}

impl Drawing {
    pub fn new(root: &Path) -> Self {
        let root = root.to_path_buf();
        let caption = String::new();
        Self { root, caption, blocks: vec![], rows: vec![], table: None }
    }

    /// Saves a panel's picture under its number and what it shows.
    pub fn panel(
        &self,
        name: &str,
        raster: &Raster,
        caption: String,
    ) -> Result<Panel, ReportError> {
        let file = format!("panels/{}.png", crate::comparison_figures::file_name(name));
        let path = self.root.join(&file);
        create_parent(&path)?;
        raster.save(&path)?;
        let height_over_width = raster.height as f64 / raster.width as f64;
        Ok(Panel { file, height_over_width, caption })
    }

    /// Adds a row of the CSV: an object with the names of the columns as its keys.
    pub fn row(&mut self, row: Value) {
        self.rows.push(row);
    }

    pub fn csv(&self) -> String {
        let fields = || self.rows.iter().filter_map(Value::as_object);
        let keys = fields().next().map_or(vec![], |row| row.keys().cloned().collect());
        let rows = fields().map(|row| row.values().cloned().collect()).collect();
        Export { keys, rows, headings: vec![], shown: vec![] }.csv()
    }

    pub fn json(&self) -> Result<String, ReportError> {
        let path = self.root.join("figure.json");
        serde_json::to_string_pretty(self)
            .map(|text| text + "\n")
            .map_err(|error| ReportError::write(&path, error.into()))
    }

    /// A `figure` whose panels are single pictures with text in the document's type; plots are included as one
    /// PDF.
    pub fn latex(&self, command: &str) -> String {
        let mut text = format!(
            "% {command}\n% \\usepackage{{graphicx,booktabs}}; put this folder into \\graphicspath\n\
             \\begin{{figure*}}\n\\centering\n"
        );
        let mut plotted = false;
        for block in &self.blocks {
            match block {
                Block::Panels(panels) => text += &panels.latex(),
                _ if plotted => {}
                _ => {
                    plotted = true;
                    text += "\\includegraphics[width=\\linewidth]{figure.pdf}\n";
                }
            }
        }
        text += &format!("\\caption{{{}}}\n\\end{{figure*}}\n", latex_text(&self.caption));
        if let Some(table) = &self.table {
            text += &format!("\n\\begin{{table}}\n\\centering\n{}\\end{{table}}\n", table.latex());
        }
        text
    }
}

impl Panels {
    fn latex(&self) -> String {
        let count = self.columns.len();
        let width = 0.94 / count.max(1) as f64;
        let mut text = format!(
            "\\setlength{{\\tabcolsep}}{{1pt}}\\footnotesize\n\\begin{{tabular}}{{c{}}}\n",
            "c".repeat(count)
        );
        if !self.title.is_empty() {
            text += &format!(
                "\\multicolumn{{{}}}{{l}}{{{}}} \\\\\n",
                count + 1,
                latex_text(&self.title)
            );
        }
        let headings = self.columns.iter().map(|column| latex_text(column));
        text += &latex_line(std::iter::once(String::new()).chain(headings));
        for row in &self.rows {
            let picture = |cell: &Option<Panel>| match cell {
                Some(panel) => {
                    format!("\\includegraphics[width={width:.4}\\linewidth]{{{}}}", panel.file)
                }
                None => String::new(),
            };
            let title = format!("\\rotatebox{{90}}{{{}}}", latex_text(&row.title));
            text += &latex_line(std::iter::once(title).chain(row.cells.iter().map(picture)));
            let caption = |cell: &Option<Panel>| {
                cell.as_ref().map_or(String::new(), |panel| latex_text(&panel.caption))
            };
            let captions: Vec<String> = row.cells.iter().map(caption).collect();
            if captions.iter().any(|caption| !caption.is_empty()) {
                text += &latex_line(std::iter::once(String::new()).chain(captions));
            }
        }
        text + "\\end{tabular}\n"
    }
}
