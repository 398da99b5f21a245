//! Where a suite states each of its cases, for tools that mark a line of a file.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use super::cases::Case;
use super::file::Suite;
use super::packaged::Kind;
use super::place::{self, Entry};

/// File and line, from 1, of each case: of its variant, else of its face, else of the suite's scene or
/// captures.
pub fn case_places(suite: &Suite) -> BTreeMap<String, (String, usize)> {
    let files: Vec<(PathBuf, Vec<Entry>)> = place::sources(&suite.path, Kind::Suite)
        .into_iter()
        .map(|source| (source.path.clone(), place::entries(&source.path)))
        .collect();
    // The files that the suite leads to come last, and are the more exact.
    let find = |is_meant: &dyn Fn(&Entry) -> bool| {
        let line = |entries: &[Entry]| entries.iter().find(|e| is_meant(e)).map(|e| e.line);
        files.iter().rev().find_map(|(path, entries)| Some((path.clone(), line(entries)?)))
    };
    let place = |case: &Case| {
        let names = |entry: &Entry, name: &str| {
            entry.key() == "name" && entry.text.as_deref() == Some(name)
        };
        let variant = case
            .variant
            .as_ref()
            .and_then(|name| find(&|entry| entry.keys[0] == "variant" && names(entry, name)));
        let face = || {
            let name = case.scene.name_of("face");
            let inline = |entry: &Entry| entry.keys[0] == "face" && names(entry, name);
            let rendered = case.photographed.is_none();
            let own = |entry: &Entry| entry.keys.len() == 1 && names(entry, name);
            rendered.then(|| find(&inline).or_else(|| find(&own))).flatten()
        };
        let fallback = || {
            let line = |key| place::line_of(&suite.path, None, key);
            (suite.path.clone(), line("scene").or_else(|| line("captures")).unwrap_or(1))
        };
        let (path, line) = variant.or_else(face).unwrap_or_else(fallback);
        (case.id.clone(), (plain(&path).display().to_string(), line))
    };
    suite.cases.iter().map(place).collect()
}

/// A path without `..`, as tools match files.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if plain.file_name().is_some() => drop(plain.pop()),
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_case_is_stated_by_its_variant_its_faces_file_or_the_scenes_table() {
        let root = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        let light = "light = { name = \"l\" }\nrig = { name = \"r\" }\nname = \"ada\"\n[render]\n";
        write(
            "s/scene.toml",
            &format!("format = 1\nface = {{ seed = 1, name = \"ada\" }}\n{light}"),
        );
        write("f/mei.toml", "# a face\nname = \"mei\"\n");
        let suite = "format = 1\nname = \"ada\"\nscene = \"../s/scene.toml\"\n";
        let method = "[[method]]\nname = \"oracle\"\n";
        let place = |text: &str, id: &str| {
            write("t/suite.toml", &format!("{suite}{text}{method}"));
            let suite = Suite::open(&root.path().join("t/suite.toml")).unwrap();
            let (file, line) = case_places(&suite)[id].clone();
            let file = Path::new(&file).strip_prefix(root.path()).unwrap().display().to_string();
            (file, line)
        };
        assert_eq!(place("", "ada-l"), ("s/scene.toml".to_owned(), 2));
        assert_eq!(place("faces = [\"../f/mei.toml\"]\n", "mei-l"), ("f/mei.toml".to_owned(), 2));
        let variant = "[[variant]]\nname = \"dark room\"\n";
        assert_eq!(place(variant, "ada-l-dark-room"), ("t/suite.toml".to_owned(), 5));
    }
}
