//! A comparison as GitHub's workflow commands: lines that mark a file in a pull request.

use super::junit::Places;
use super::verdict::Comparison;

/// GitHub shows ten of a kind for a step.
const SHOWN: usize = 10;

impl Comparison {
    /// `::error file=...,line=...,title=...::...`, a line for each finding, and one for what differs.
    pub fn annotations(&self, places: &Places) -> Vec<String> {
        let mut lines = Vec::new();
        if let Some(line) = self.unlike() {
            lines.push(format!("::notice title={}::{}", property(&self.suite), data(&line)));
        }
        for finding in self.findings().iter().take(SHOWN) {
            let (kind, word) =
                if finding.worse { ("error", "worse") } else { ("notice", "better") };
            let place = finding.cases.iter().find_map(|case| places.get(case));
            let place = place.map_or(String::new(), |(file, line)| {
                format!("file={},line={line},", property(file))
            });
            let title = property(&format!(
                "{}: {} of {} is {word}",
                self.suite, finding.subject, finding.method
            ));
            lines.push(format!("::{kind} {place}title={title}::{}", data(&finding.sentence)));
        }
        lines
    }
}

fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}
