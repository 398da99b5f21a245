//! The tables of means as lines for a terminal: a row for each figure, a column for each method.

use super::finished::Finished;
use super::tables::{MeansTable, groups, means};

/// Columns between two cells.
const GAP: usize = 2;

/// Every table of every run, each with its title.
pub(super) fn lines(runs: &[Finished]) -> Vec<String> {
    let mut lines = Vec::new();
    for run in runs {
        for group in groups(run) {
            for table in means(run, &group) {
                lines.push(format!("{}, {}: {}", run.title(), group.title(), table.title));
                lines.extend(aligned(&cells(&table)));
                lines.push(String::new());
            }
        }
    }
    lines.pop();
    lines
}

/// The table on its side; the best of a row has a star.
fn cells(table: &MeansTable) -> Vec<Vec<String>> {
    let head = table.rows.iter().map(|row| row.title.clone());
    let mut rows = vec![std::iter::once(String::new()).chain(head).collect::<Vec<_>>()];
    for (at, (figure, heading)) in table.figures.iter().zip(&table.headings).enumerate() {
        let name = format!("{heading} {}", figure.key.direction().symbol());
        let values = table.rows.iter().map(|row| {
            let cell = &row.cells[at];
            format!("{}{}", cell.text, if cell.best { "*" } else { "" })
        });
        rows.push(std::iter::once(name).chain(values).collect());
    }
    rows
}

fn aligned(rows: &[Vec<String>]) -> Vec<String> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max()
    };
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let padded = row.iter().zip(&widths).map(|(cell, width)| {
            format!("{cell}{}", " ".repeat(width + GAP - cell.chars().count()))
        });
        padded.collect::<String>().trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_longest_cell() {
        let rows = [["", "a", "longer"], ["figure ↑", "1.0*", "–"]];
        let rows: Vec<Vec<String>> =
            rows.iter().map(|row| row.iter().map(|cell| (*cell).to_owned()).collect()).collect();
        assert_eq!(aligned(&rows), ["          a     longer", "figure ↑  1.0*  –"]);
    }
}
