//! Where in a TOML file something stands, for messages.

use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

use crate::synth::StageError;

/// The line, from 1, of a byte of a text.
pub(super) fn line_at(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|byte| *byte == b'\n').count()
}

/// The line of the file that states `key`: as a key or as a table's head; below the line that states
/// `name = "<name>"`, if a name is given, and else that line.
pub(super) fn line_of(path: &Path, name: Option<&str>, key: &str) -> Option<usize> {
    let text = fs::read_to_string(path).ok()?;
    let lines: Vec<&str> = text.lines().collect();
    let Some(name) = name else {
        return lines.iter().position(|line| states(line, key)).map(|line| line + 1);
    };
    let named = format!("{name:?}");
    let head = lines.iter().position(|line| states(line, "name") && line.contains(&named))?;
    let below = lines[head + 1..].iter().take_while(|line| !line.trim().starts_with("[["));
    let found = below.into_iter().position(|line| states(line, key));
    Some(found.map_or(head, |line| head + 1 + line) + 1)
}

/// Whether a line states a key, or heads a table of this name.
fn states(line: &str, key: &str) -> bool {
    let line = line.trim().trim_start_matches('[').trim_end_matches(']');
    let rest = line.strip_prefix(key).map(str::trim_start);
    !key.is_empty() && rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['=', '.']))
}

/// A suite's file and every TOML file that it leads to.
pub(super) fn sources(suite: &Path) -> Vec<PathBuf> {
    let mut found = vec![suite.to_path_buf()];
    let mut next = 0;
    while let Some(path) = found.get(next).cloned() {
        next += 1;
        let table = fs::read_to_string(&path).ok().and_then(|text| text.parse::<Table>().ok());
        let mut names = Vec::new();
        table.into_iter().for_each(|table| toml_names(&Value::Table(table), &mut names));
        for name in names {
            let file = beside(&path, &name);
            if file.is_file() && !found.contains(&file) {
                found.push(file);
            }
        }
    }
    found
}

fn toml_names(value: &Value, names: &mut Vec<String>) {
    match value {
        Value::String(text) if text.ends_with(".toml") => names.push(text.clone()),
        Value::Array(list) => list.iter().for_each(|value| toml_names(value, names)),
        Value::Table(table) => table.values().for_each(|value| toml_names(value, names)),
        _ => {}
    }
}

/// An error of the renderer that speaks of the file `generated`, in terms of the user's `file` and of
/// those that it leads to.
pub(super) fn blamed(error: StageError, generated: &Path, file: &Path) -> StageError {
    let StageError::Input { kind, message } = error else { return error };
    let (generated, shown) = (generated.to_string_lossy(), file.to_string_lossy());
    let message = message.replace(&*generated, &shown);
    // "unknown key 'samples' in [render]; ..." or "width in [render] is ...".
    let quoted = message.split('\'').nth(1).filter(|_| message.starts_with("unknown key"));
    let key = quoted.or_else(|| message.split_whitespace().next()).unwrap_or_default();
    let place = only(&sources(file), |line| states(line, key));
    let message = match place {
        Some(place) => format!("{place}: {message}"),
        None if message.contains(&*shown) => message,
        None => format!("{shown}: {message}"),
    };
    StageError::Input { kind, message }
}

/// The one line of `sources` that `states` picks, as `file:line`; none if there are more or none.
pub(super) fn only(sources: &[PathBuf], states: impl Fn(&str) -> bool) -> Option<String> {
    let mut places = sources.iter().flat_map(|path| {
        let text = fs::read_to_string(path).unwrap_or_default();
        let lines = text.lines().enumerate().filter(|(_, line)| states(line));
        lines.map(|(line, _)| format!("{}:{}", path.display(), line + 1)).collect::<Vec<_>>()
    });
    let first = places.next()?;
    places.next().is_none().then_some(first)
}

/// Stands beside a file that a dictionary was written to, and names the folder that its relative paths start from.
const RELATIVE_TO: &str = ".relative-to";

/// A file that `path` names, which lies beside it.
pub(super) fn beside(path: &Path, name: &str) -> PathBuf {
    let folder = path.parent().unwrap_or(Path::new(""));
    match fs::read_to_string(folder.join(RELATIVE_TO)) {
        Ok(other) => Path::new(&other).join(name),
        Err(_) => folder.join(name),
    }
}

/// The absolute path of the folder that holds a file. The parent of a plain file name is the empty path, which the
/// system refuses as a working directory.
pub(super) fn folder_of(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    absolute.parent().map_or_else(|| PathBuf::from("."), Path::to_path_buf)
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
        assert_eq!(
            only(std::slice::from_ref(&path), |line| line.contains("steps"))
                .unwrap()
                .rsplit(':')
                .next(),
            Some("9")
        );
        assert_eq!(only(&[path], |line| line.contains("threads")), None);
    }

    #[test]
    fn a_suite_leads_to_its_scene_and_that_to_its_lights() {
        let root = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(root.path().join(name), text).unwrap();
        write("suite.toml", "scene = \"scene.toml\"\nfaces = [\"gone.toml\"]");
        write("scene.toml", "light = \"light.toml\"\nrelight = [\"light.toml\"]");
        write("light.toml", "name = \"x\"");
        let found = sources(&root.path().join("suite.toml"));
        let names: Vec<_> =
            found.iter().map(|p| p.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["suite.toml", "scene.toml", "light.toml"]);
    }
}
