//! A comparison for a terminal.

use std::fmt::Write;

use super::verdict::{Comparison, Judged, Verdict};

impl Comparison {
    /// Text: differences beside the scores, causes, changed rows (a line each), and the sums.
    pub fn table(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        if let Some(line) = self.unlike() {
            let _ = writeln!(text, "{line}");
        }
        for finding in self.findings() {
            let word = if finding.worse { "WORSE  " } else { "better " };
            let _ = writeln!(text, "{word} {}", finding.sentence);
        }
        let moved: Vec<&Judged> = self
            .rows
            .iter()
            .filter(|row| !matches!(row.verdict, Verdict::Same | Verdict::CannotTell))
            .collect();
        let width = moved.iter().map(|row| row.id.len()).max().unwrap_or(0);
        for row in moved {
            let word = match row.verdict.is_regression() {
                true => row.verdict.word().to_uppercase(),
                false => row.verdict.word().to_owned(),
            };
            let said = match row.verdict {
                Verdict::Better | Verdict::New => row.change(),
                _ => row.explained(),
            };
            let _ = writeln!(text, "  {word:8} {:width$}  {said}", row.id);
        }
        let _ = writeln!(text, "{}: {}: {}", self.suite, self.outcome(), self.counts());
        let _ = writeln!(text, "({})", self.tolerances);
        text
    }

    /// The line that comes first where the two runs are not alike.
    pub fn unlike(&self) -> Option<String> {
        (!self.differences.is_empty())
            .then(|| format!("Not like with like: {}.", self.differences.join(", ")))
    }
}
