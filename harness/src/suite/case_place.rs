//! Where a suite states each of its cases, for tools that mark a line of a file.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::cases::Case;
use super::file::Suite;
use super::place;

/// File and line, from 1, of each case: of its variant, else of its face, else of the suite's scene or
/// captures.
pub fn case_places(suite: &Suite) -> BTreeMap<String, (String, usize)> {
    let sources = place::sources(&suite.path);
    let place = |case: &Case| {
        let own = |key: &str| place::line_of(&suite.path, None, key);
        let found = match &case.variant {
            Some(variant) => line_with(&suite.path, &|line| names(line, "name", variant)),
            None => None,
        };
        let found = found.map(|line| (suite.path.clone(), line)).or_else(|| face(&sources, case));
        let fallback =
            || (suite.path.clone(), own("scene").or_else(|| own("captures")).unwrap_or(1));
        let (path, line) = found.unwrap_or_else(fallback);
        (case.id.clone(), (plain(&path).display().to_string(), line))
    };
    suite.cases.iter().map(place).collect()
}

/// The face's table in a scene, or its name in a file of its own, which the scene leads to.
fn face(sources: &[PathBuf], case: &Case) -> Option<(PathBuf, usize)> {
    if case.photographed.is_some() {
        return None;
    }
    let name = case.scene.name_of("face");
    let inline = |line: &str| line.trim_start().starts_with("face") && names(line, "name", name);
    let own = |line: &str| names(line, "name", name) && line.trim_start().starts_with("name");
    let first = |states: &dyn Fn(&str) -> bool| {
        sources.iter().rev().find_map(|path| Some((path.clone(), line_with(path, states)?)))
    };
    first(&inline).or_else(|| first(&own))
}

/// Whether a line states `key = "value"`.
fn names(line: &str, key: &str, value: &str) -> bool {
    line.split(key).skip(1).any(|rest| {
        let rest = rest.trim_start().strip_prefix('=').map(str::trim_start);
        rest.is_some_and(|rest| rest.starts_with(&format!("{value:?}")))
    })
}

fn line_with(path: &Path, states: &dyn Fn(&str) -> bool) -> Option<usize> {
    let text = fs::read_to_string(path).ok()?;
    text.lines().position(states).map(|line| line + 1)
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
