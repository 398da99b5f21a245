//! Where in a TOML file something stands, for messages.

use std::fs;
use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use super::packaged::Kind;
use super::relative_path::beside;
use crate::synth::{Place, StageError};

/// The line, from 1, of a byte of a text.
pub(super) fn line_at(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|byte| *byte == b'\n').count()
}

/// A key of a TOML file, or an entry of a list.
pub(super) struct Entry {
    /// The keys that lead to it, its own last; entries of lists have their number from 0.
    pub keys: Vec<String>,
    /// From 1.
    pub line: usize,
    /// Its value, of a text.
    pub text: Option<String>,
}

impl Entry {
    pub fn key(&self) -> &str {
        self.keys.last().map_or("", String::as_str)
    }
}

/// All keys of a file, from outside to inside; none of a file that is not TOML.
pub(super) fn entries(path: &Path) -> Vec<Entry> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let mut entries = Vec::new();
    if let Ok(table) = DeTable::parse(&text) {
        add_entries(&text, table.get_ref(), &[], &mut entries);
    }
    entries.sort_by_key(|entry| entry.keys.len());
    entries
}

fn add_entries(text: &str, table: &DeTable, above: &[String], entries: &mut Vec<Entry>) {
    for (key, value) in table {
        let keys = [above, &[key.get_ref().to_string()]].concat();
        add_entry(text, key.span().start, keys, value.get_ref(), entries);
    }
}

fn add_entry(text: &str, at: usize, keys: Vec<String>, value: &DeValue, entries: &mut Vec<Entry>) {
    let text_of = value.as_str().map(str::to_owned);
    entries.push(Entry { keys: keys.clone(), line: line_at(text, at), text: text_of });
    if let Some(table) = value.as_table() {
        add_entries(text, table, &keys, entries);
    }
    for (number, value) in value.as_array().into_iter().flat_map(|list| list.iter().enumerate()) {
        let keys = [&*keys, &[number.to_string()]].concat();
        add_entry(text, value.span().start, keys, value.get_ref(), entries);
    }
}

/// The line of the file that has `key`: below the table whose `name` is this, if a name is given, and else the line of
/// that name.
pub(super) fn line_of(path: &Path, name: Option<&str>, key: &str) -> Option<usize> {
    let entries = entries(path);
    let Some(name) = name else {
        return entries.iter().find(|entry| entry.key() == key).map(|entry| entry.line);
    };
    let is_name = |entry: &&Entry| {
        entry.key() == "name" && entry.keys.len() == 3 && entry.text.as_deref() == Some(name)
    };
    let head = entries.iter().find(is_name)?;
    let table = &head.keys[..2];
    let mut within = entries.iter().filter(|entry| entry.keys.starts_with(table));
    Some(within.find(|entry| entry.key() == key).unwrap_or(head).line)
}

/// A TOML file that a suite or scene leads to, and what it is.
pub(super) struct Source {
    pub path: PathBuf,
    pub kind: Kind,
}

/// A suite's or scene's file and every TOML file that it leads to.
pub(super) fn sources(file: &Path, kind: Kind) -> Vec<Source> {
    let mut found = vec![Source { path: file.to_path_buf(), kind }];
    let mut next = 0;
    while let Some(Source { path, .. }) = found.get(next) {
        let path = path.clone();
        next += 1;
        for entry in entries(&path) {
            let Some(name) = entry.text.filter(|text| text.ends_with(".toml")) else { continue };
            let file = beside(&path, &name);
            if file.is_file() && !found.iter().any(|known| known.path == file) {
                found.push(Source { path: file, kind: Kind::of_key(&entry.keys[0]) });
            }
        }
    }
    found
}

/// An error of the renderer about one of the files `generated`, in terms of the user's `file` and of those that it leads to.
pub(super) fn located(
    error: StageError,
    generated: &[PathBuf],
    file: &Path,
    kind: Kind,
) -> StageError {
    let StageError::Input { kind: class, message, place } = error else { return error };
    let shown = file.to_string_lossy();
    let named = |message: String, file: &PathBuf| message.replace(&*file.to_string_lossy(), &shown);
    let message = generated.iter().fold(message, named);
    let found = place
        .as_ref()
        .and_then(|place| only(&sources(file, kind), |source, entry| is_at(source, entry, place)));
    let message = match found {
        Some(found) => format!("{found}: {message}"),
        None if message.contains(&*shown) => message,
        None => format!("{shown}: {message}"),
    };
    StageError::Input { kind: class, message, place }
}

/// Whether an entry of a file is a key of a scene's table: of the scene itself, of a suite's or variant's changes to
/// it, or of the file of such a table.
fn is_at(source: &Source, entry: &Entry, Place { table, key }: &Place) -> bool {
    let (table, key) = (table.as_str(), key.as_str());
    let kind = Kind::of_key(table);
    let is_table = |section: &str| match kind {
        Kind::Scene => section == table,
        kind => Kind::of_key(section) == kind,
    };
    let keys: Vec<&str> = entry.keys.iter().map(String::as_str).collect();
    match keys[..] {
        [last] if kind == source.kind && kind != Kind::Scene => last == key,
        [last] => table.is_empty() && source.kind == Kind::Scene && last == key,
        ["variant", _, section, last] => is_table(section) && last == key,
        [section, .., last] => is_table(section) && last == key,
        [] => false,
    }
}

/// The one entry of all files that `is_meant` picks, as `file:line`; none if there are more or none.
pub(super) fn only(
    sources: &[Source],
    is_meant: impl Fn(&Source, &Entry) -> bool,
) -> Option<String> {
    let mut places = sources.iter().flat_map(|source| {
        let found = entries(&source.path).into_iter().filter(|entry| is_meant(source, entry));
        found.map(|entry| format!("{}:{}", source.path.display(), entry.line)).collect::<Vec<_>>()
    });
    let first = places.next()?;
    places.all(|other| other == first).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_found_in_their_table() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("suite.toml");
        let text = "name = \"m\"\n[[method]]\nname = \"a\"\nthreads = 1\n[[method]]\nname = \"b\"\n\
                    threads= 0\n[method.set.height]\nsteps = 3\n";
        fs::write(&path, text).unwrap();
        assert_eq!(line_of(&path, None, "name"), Some(1));
        assert_eq!(line_of(&path, Some("b"), "threads"), Some(7));
        assert_eq!(line_of(&path, Some("b"), "inputs"), Some(6));
        assert_eq!(line_of(&path, Some("b"), "steps"), Some(9));
        assert_eq!(line_of(&path, None, "faces"), None);
        assert_eq!(line_at(text, text.find("threads").unwrap()), 4);
    }

    #[test]
    fn a_suite_leads_to_its_scene_and_that_to_its_lights() {
        let root = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(root.path().join(name), text).unwrap();
        write("suite.toml", "scene = \"scene.toml\"\nfaces = [\"gone.toml\"]\n[render]\nwidth = 4");
        write(
            "scene.toml",
            "light = \"light.toml\"\nrelight = [\"light.toml\"]\n[render]\nsample = 3",
        );
        write("light.toml", "name = \"x\"\nclamp = 3");
        let suite = root.path().join("suite.toml");
        let found = sources(&suite, Kind::Suite);
        let names: Vec<_> =
            found.iter().map(|s| s.path.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["suite.toml", "scene.toml", "light.toml"]);
        for (table, key, expected) in [
            ("render", "sample", "scene.toml:4: wrong"),
            ("render", "width", "suite.toml:4: wrong"),
            ("light", "clamp", "light.toml:2: wrong"),
            ("light", "kind", "suite.toml: wrong"),
            ("rig", "clamp", "suite.toml: wrong"),
        ] {
            let place = Some(Place { table: table.to_owned(), key: key.to_owned() });
            let error =
                StageError::Input { kind: String::new(), message: "wrong".to_owned(), place };
            let error =
                located(error, &[PathBuf::from("made.toml")], &suite, Kind::Suite).to_string();
            assert!(error.ends_with(expected), "{error}");
        }
    }
}
