//! Hashes of what stages leave.

use std::fs;
use std::io;
use std::path::Path;

use formats::content_hash::{hash_parts, hash_path};
use serde::{Deserialize, Serialize};

use super::plan::StageKind;
use super::program::given_files;

/// Hashes of a stage's output, and of those parts of a capture that other stages read alone.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputHashes {
    /// All of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub content: String,
    /// The part of a capture that a method is given: neither its truth nor a withheld view.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub given: String,
    /// The true maps of a capture, without its views and lights; empty without a truth.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub truth: String,
}

impl OutputHashes {
    /// Hashes the output of a stage of this kind.
    pub(super) fn of(kind: StageKind, path: &Path) -> io::Result<Self> {
        let content = hash_path(path)?;
        if kind != StageKind::Capture {
            return Ok(Self { content, ..Self::default() });
        }
        let given = hash_files(path, given_files(path)?)?;
        let folder = path.join("truth");
        let listed = if folder.is_dir() { Some(fs::read_dir(&folder)?) } else { None };
        let mut maps = Vec::new();
        for entry in listed.into_iter().flatten() {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".exr") && name != "light.exr" || name.ends_with(".png") {
                maps.push(name);
            }
        }
        maps.sort();
        let truth = if maps.is_empty() { String::new() } else { hash_files(&folder, maps)? };
        Ok(Self { content, given, truth })
    }
}

/// The hash of files below a folder, by their names in it.
fn hash_files(
    folder: &Path,
    names: impl IntoIterator<Item = impl AsRef<str>>,
) -> io::Result<String> {
    let mut parts = Vec::new();
    for name in names {
        parts.push(name.as_ref().to_owned());
        parts.push(hash_path(&folder.join(name.as_ref()))?);
    }
    Ok(hash_parts(&parts.iter().map(String::as_str).collect::<Vec<_>>()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_capture_change_with_their_own_files_alone() {
        let root = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        write(
            "transforms.json",
            r#"{"mesh": "mesh.obj", "train_filenames": ["images/0.exr"],
            "frames": [{"file_path": "images/0.exr"}, {"file_path": "images/1.exr"}]}"#,
        );
        for file in ["mesh.obj", "images/0.exr", "images/1.exr", "truth/diffuse_albedo.exr"] {
            write(file, file);
        }
        let of = || OutputHashes::of(StageKind::Capture, root.path()).unwrap();
        let before = of();
        for (file, given, truth) in [
            ("truth/relit/noon/1.exr", false, false),
            ("truth/scene.toml", false, false),
            ("truth/light.exr", false, false),
            ("images/1.exr", false, false),
            ("images/0.exr", true, false),
            ("mesh.obj", true, false),
            ("truth/diffuse_albedo.exr", false, true),
        ] {
            let old = fs::read_to_string(root.path().join(file)).ok();
            write(file, "changed");
            let now = of();
            assert_ne!(now.content, before.content, "{file}");
            assert_eq!(
                (now.given != before.given, now.truth != before.truth),
                (given, truth),
                "{file}"
            );
            match old {
                Some(old) => write(file, &old),
                None => fs::remove_file(root.path().join(file)).unwrap(),
            }
        }
    }
}
