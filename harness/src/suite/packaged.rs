//! Suites, scenes, faces, lights and rigs that come with unshade, by name.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use super::relative_path::beside;

static FOLDER: OnceLock<PathBuf> = OnceLock::new();

/// Says where the scenes of an installed package lie; the first call counts.
pub fn set_folder(folder: PathBuf) {
    FOLDER.get_or_init(|| folder);
}

/// The package's folder, else `scenes` here or above, as in a checkout.
fn folder() -> Option<PathBuf> {
    FOLDER.get().cloned().or_else(|| {
        let here = std::env::current_dir().ok()?;
        here.ancestors().map(|above| above.join("scenes")).find(|f| f.join("suites").is_dir())
    })
}

/// Kinds of files that a name can stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Suite,
    Scene,
    Face,
    Light,
    Rig,
}

/// The files beside the scenes that are none.
const NO_SCENES: [&str; 3] = ["ci-tolerances", "face-sets", "tolerances"];

impl Kind {
    /// The kind of file that a key of a scene or suite file names.
    pub fn of_key(key: &str) -> Self {
        match key {
            "face" | "faces" => Self::Face,
            "light" | "lights" | "relight" => Self::Light,
            "rig" => Self::Rig,
            _ => Self::Scene,
        }
    }

    /// Its folder, and what one of it is called.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Suite => ("suites", "suite"),
            Self::Scene => ("", "scene"),
            Self::Face => ("faces", "face"),
            Self::Light => ("lights", "light"),
            Self::Rig => ("rigs", "rig"),
        }
    }

    /// The names that there are, sorted.
    fn names(self, folder: &Path) -> Vec<String> {
        let listed = fs::read_dir(folder.join(self.words().0)).into_iter().flatten().flatten();
        let mut names: Vec<String> = listed
            .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".toml")?.to_owned()))
            .filter(|name| self != Self::Scene || !NO_SCENES.contains(&name.as_str()))
            .collect();
        names.sort();
        names
    }
}

/// The file that was typed, or, if there is none and it is a plain name, that of the package; the error is
/// the reason alone.
pub(super) fn file(typed: &Path, kind: Kind) -> Result<PathBuf, String> {
    named(typed, typed.as_os_str(), kind)
}

/// The file that the value `name` of `key` in the file `from` stands for: one beside it, or, if there is
/// none and it is a plain name, that of the package; the error is only the reason.
pub(super) fn referenced(from: &Path, key: &str, name: &str) -> Result<PathBuf, String> {
    named(&beside(from, name), OsStr::new(name), Kind::of_key(key))
        .map_err(|reason| format!("{name}: {reason}"))
}

/// `file` if it is there or no plain name stands for it; the error is only the reason.
fn named(file: &Path, name: &OsStr, kind: Kind) -> Result<PathBuf, String> {
    let plain = name.to_str().filter(|name| {
        name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_') && !name.is_empty()
    });
    let (Some(name), false) = (plain, file.is_file()) else { return Ok(file.to_path_buf()) };
    let (below, word) = kind.words();
    let names = match folder() {
        None => Vec::new(),
        Some(folder) => {
            let names = kind.names(&folder);
            if names.iter().any(|known| known == name) {
                return Ok(folder.join(below).join(format!("{name}.toml")));
            }
            names
        }
    };
    let known = match names.is_empty() {
        true => "none are installed; name a file".to_owned(),
        false => format!("there are {}", names.join(", ")),
    };
    Err(format!("no such file, and no {word} of this name comes with unshade; {known}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_wins_over_a_name_and_an_unknown_name_lists_the_known() {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        let root = tempfile::tempdir().unwrap();
        let suite = root.path().join("suite.toml");
        let packaged = referenced(&suite, "faces", "ada").unwrap();
        assert_eq!(
            packaged.canonicalize().unwrap(),
            scenes.join("faces/ada.toml").canonicalize().unwrap()
        );
        fs::write(root.path().join("ada"), "name = \"mine\"").unwrap();
        assert_eq!(referenced(&suite, "faces", "ada").unwrap(), root.path().join("ada"));
        let error = referenced(&suite, "rig", "moon").unwrap_err();
        assert!(
            error.contains("no rig") && error.contains("there are desktop, dome, emily"),
            "{error}"
        );
        // What has a folder or an ending in it is a file's name.
        let missing = root.path().join("faces/ada.toml");
        assert_eq!(referenced(&suite, "faces", "faces/ada.toml").unwrap(), missing);
    }

    #[test]
    fn every_name_of_every_kind_can_be_read() {
        let found = folder().unwrap();
        for kind in [Kind::Suite, Kind::Scene, Kind::Face, Kind::Light, Kind::Rig] {
            let names = kind.names(&found);
            assert!(names.len() >= 4, "{names:?}");
            for name in names {
                let path = file(Path::new(&name), kind).unwrap();
                let table: toml::Table = fs::read_to_string(&path).unwrap().parse().unwrap();
                assert_eq!(table["name"].as_str(), Some(name.as_str()));
            }
        }
    }
}
