//! Parts of a page of Markdown.

pub(super) fn row(cells: impl IntoIterator<Item = String>) -> String {
    let cells: Vec<String> = cells.into_iter().collect();
    format!("| {} |\n", cells.join(" | "))
}

/// Text that is no markup, in a table neither.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '|' | '*' | '_' | '[' | ']' => escaped.extend(['\\', c]),
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '\n' => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

pub(super) fn head(first: &[&str], names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = first.iter().map(|name| (*name).to_owned()).chain(names).collect();
    format!("{}|{}\n", row(names.clone()), "---|".repeat(names.len()))
}
