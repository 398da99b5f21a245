//! Tables as text: lines of CSV and rows of Markdown.

/// Joins the cells of a line of CSV (RFC 4180), without the end of the line.
pub fn csv_line<T: AsRef<str>>(cells: impl IntoIterator<Item = T>) -> String {
    let quoted = |cell: T| {
        let cell = cell.as_ref();
        match cell.contains([',', '"', '\n', '\r']) {
            true => format!("\"{}\"", cell.replace('"', "\"\"")),
            false => cell.to_owned(),
        }
    };
    cells.into_iter().map(quoted).collect::<Vec<_>>().join(",")
}

/// The cell of a number in full; empty without one.
pub fn csv_number<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Escapes a text so that Markdown shows it as it is, also in a cell of a table.
pub fn markdown_text(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '|' | '*' | '_' | '[' | ']' | '`' | '\\' => escaped.extend(['\\', letter]),
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '\n' | '\r' => escaped.push(' '),
            _ => escaped.push(letter),
        }
    }
    escaped
}

/// A row of a Markdown table; the cells are Markdown.
pub fn markdown_row<T: AsRef<str>>(cells: impl IntoIterator<Item = T>) -> String {
    let mut row = "|".to_owned();
    for cell in cells {
        row.extend([" ", cell.as_ref(), " |"]);
    }
    row + "\n"
}

/// The heading of a Markdown table.
pub fn markdown_head<T: AsRef<str>>(names: impl IntoIterator<Item = T>) -> String {
    let names: Vec<T> = names.into_iter().collect();
    let rule = "---|".repeat(names.len());
    format!("{}|{rule}\n", markdown_row(names))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_and_escaped_where_they_must_be() {
        assert_eq!(csv_line(["a", "b, \"c\"", "d\ne"]), "a,\"b, \"\"c\"\"\",\"d\ne\"");
        assert_eq!(markdown_text("a|b_<c>\n`d`\\"), "a\\|b\\_&lt;c&gt; \\`d\\`\\\\");
        assert_eq!(markdown_head(["x", "y"]), "| x | y |\n|---|---|\n");
    }
}
