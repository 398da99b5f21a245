//! The capture as a program gets it: what it may train on, and where the withheld cameras stand.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Component, Path};

use serde_json::Value;

const CAMERAS: &str = "transforms.json";

/// Files of `capture` that a method is given, below it: the cameras, the mesh, and the pictures, masks and labels of the
/// training views. Nothing of a withheld view but its camera is in them.
pub(in crate::suite) fn given_files(capture: &Path) -> io::Result<BTreeSet<String>> {
    let text = fs::read(capture.join(CAMERAS))?;
    let transforms: Value = serde_json::from_slice(&text)?;
    let mut files = training_files(&transforms);
    // A capture of ours names nothing else; one that does is refused when it is opened.
    let plain = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    files.retain(|file| Path::new(file).components().all(plain));
    files.insert(CAMERAS.to_owned());
    Ok(files)
}

/// Copies what a method is given of `capture` into the folder `to`.
pub(in crate::suite) fn copy_blind(capture: &Path, to: &Path) -> io::Result<()> {
    for file in given_files(capture)? {
        let target = to.join(&file);
        if let Some(folder) = target.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::copy(capture.join(file), target)?;
    }
    Ok(())
}

/// The mesh, and the files of every frame that is not withheld.
fn training_files(transforms: &Value) -> BTreeSet<String> {
    let texts = |key: &str| -> Vec<&str> {
        transforms[key].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
    };
    let train = texts("train_filenames");
    let mut files: BTreeSet<String> =
        transforms["mesh"].as_str().map(str::to_owned).into_iter().collect();
    for frame in transforms["frames"].as_array().into_iter().flatten() {
        if frame["file_path"].as_str().is_some_and(|path| train.contains(&path)) {
            for key in ["file_path", "mask_path", "label_path"] {
                files.extend(frame[key].as_str().map(str::to_owned));
            }
        }
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_a_withheld_view_is_copied_but_its_camera() {
        let root = tempfile::tempdir().unwrap();
        let capture = root.path().join("capture");
        for file in [
            "mesh.obj",
            "images/000.exr",
            "images/001.exr",
            "masks/000.png",
            "masks/001.png",
            "labels/001.png",
            "truth/diffuse_albedo.exr",
            "notes.txt",
        ] {
            let path = capture.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, file).unwrap();
        }
        let text = r#"{"mesh": "mesh.obj", "train_filenames": ["images/000.exr"],
            "test_filenames": ["images/001.exr"], "frames": [
            {"file_path": "images/000.exr", "mask_path": "masks/000.png"},
            {"file_path": "images/001.exr", "mask_path": "masks/001.png",
             "label_path": "labels/001.png"}]}"#;
        fs::write(capture.join("transforms.json"), text).unwrap();
        let blind = root.path().join("blind");
        copy_blind(&capture, &blind).unwrap();
        let mut files = Vec::new();
        let mut folders = vec![blind.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => folders.push(path),
                    false => files.push(path.strip_prefix(&blind).unwrap().to_path_buf()),
                }
            }
        }
        files.sort();
        let expected = ["images/000.exr", "masks/000.png", "mesh.obj", "transforms.json"];
        assert_eq!(files, expected.map(std::path::PathBuf::from));
        assert_eq!(fs::read_to_string(blind.join("transforms.json")).unwrap(), text);
    }
}
