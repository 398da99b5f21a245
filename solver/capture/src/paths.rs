//! Paths of a capture, as whoever wrote them.

use std::path::{Component, Path, PathBuf};

/// A path with `/` between its parts and no `.` among them, however it was written.
pub(super) fn plain(path: &str) -> String {
    let path = path.replace('\\', "/");
    let parts: Vec<&str> = path.split('/').collect();
    let last = parts.len() - 1;
    let kept = parts.iter().enumerate().filter(|(index, part)| match **part {
        "." => false,
        "" => *index == 0 && *index != last,
        _ => true,
    });
    kept.map(|(_, part)| *part).collect::<Vec<_>>().join("/")
}

/// `path` below `root`, refused if it leads out of it (or into the truth).
pub(super) fn inside(root: &Path, path: &str) -> Result<PathBuf, String> {
    let mut parts = Path::new(path).components().peekable();
    if parts.peek().is_some_and(|first| first.as_os_str() == "truth") {
        return Err(format!("{path} is part of the truth; a solver must not see it"));
    }
    let drive = path.as_bytes().get(1) == Some(&b':');
    if drive || !parts.all(|part| matches!(part, Component::Normal(_))) {
        return Err(format!("{path} leads out of the capture folder; copy the file into it"));
    }
    Ok(root.join(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_the_same_however_they_are_written() {
        for path in ["images/a.exr", "./images/a.exr", "images\\a.exr", ".\\images//./a.exr"] {
            assert_eq!(plain(path), "images/a.exr");
        }
        assert_eq!(plain("/etc/a"), "/etc/a");
        assert_eq!(plain("../a"), "../a");
        assert_eq!(plain(""), "");
        for path in ["/etc/a", "../a", "a/../../b", "C:/a.exr", "truth/a.exr"] {
            assert!(inside(Path::new("root"), path).is_err(), "{path}");
        }
    }
}
