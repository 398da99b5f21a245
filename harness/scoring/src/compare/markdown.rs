//! A comparison as Markdown, for the summary of a job and for a comment that is replaced by the next.

use std::fmt::Write;

use super::verdict::{Comparison, Judged, VERDICTS, Verdict};
use crate::tables::markdown_text;

/// Rows that are spelt out; a comment of GitHub holds 65536 characters.
const SHOWN: usize = 150;

impl Comparison {
    /// The page. Its first line is a comment by which a script finds it again.
    pub fn markdown(&self) -> String {
        let suite = markdown_text(&self.suite);
        let mut text = format!("<!-- unshade compare: {suite} -->\n");
        let mark = if self.passed() { "✅" } else { "❌" };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "### {mark} unshade, {suite}: {}\n", self.outcome());
        if let Some(line) = self.unlike() {
            let _ = writeln!(text, "**{}**\n", markdown_text(&line));
        }
        for finding in self.findings() {
            let word = if finding.worse { "**worse:**" } else { "better:" };
            let _ = writeln!(text, "- {word} {}", finding.sentence.replace('\n', " "));
        }
        text.push('\n');
        let _ = writeln!(text, "{}\n", self.counts());
        let moved: Vec<&Judged> = self
            .rows
            .iter()
            .filter(|row| !matches!(row.verdict, Verdict::Same | Verdict::CannotTell))
            .collect();
        if !moved.is_empty() {
            let _ = writeln!(text, "<details><summary>{} rows that moved</summary>\n", moved.len());
            text.push_str(
                "| row | verdict | baseline | now | allowed | |\n|---|---|--:|--:|--:|---|\n",
            );
            for row in moved.iter().take(SHOWN) {
                let value =
                    |value: Option<f64>| value.map_or("none".to_owned(), |v| format!("{v:.4}"));
                let unit =
                    if row.unit.is_empty() { String::new() } else { format!(" {}", row.unit) };
                let _ = writeln!(
                    text,
                    "| `{}` | {} | {} | {}{unit} | {:.4} | {} |",
                    row.id.replace(['|', '`', '\n'], " "),
                    row.verdict.word(),
                    value(row.baseline),
                    value(row.current),
                    row.allowed,
                    markdown_text(&row.reason)
                );
            }
            if let Some(more) = moved.len().checked_sub(SHOWN).filter(|more| *more > 0) {
                let _ = writeln!(text, "\n{more} more are in the JSON and JUnit files.");
            }
            text.push_str("\n</details>\n\n");
        }
        let _ = writeln!(text, "<sub>{}</sub>", markdown_text(&self.tolerances));
        text
    }

    /// Everything as JSON, for scripts: one object, rows by verdict.
    pub fn json(&self) -> serde_json::Value {
        let counts: serde_json::Map<String, serde_json::Value> = VERDICTS
            .into_iter()
            .map(|verdict| (verdict.word().replace(' ', "_"), self.count(verdict).into()))
            .collect();
        serde_json::json!({
            "format": 1, "suite": self.suite, "passed": self.passed(),
            "differences": self.differences, "tolerances": self.tolerances, "counts": counts,
            "findings": self.findings(), "rows": self.rows,
        })
    }
}
