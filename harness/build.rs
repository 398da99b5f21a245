//! Hashes the sources of the solver, of the scoring, and of what reads files for both and for the
//! renderer: a finished stage of a run stays valid until the code that made it changes.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    for (name, folders) in [
        (
            "UNSHADE_SOLVER_SOURCES",
            vec!["../solver/src", "../solver/capture/src", "../solver/formats/src"],
        ),
        (
            "UNSHADE_SCORE_SOURCES",
            vec![
                "scoring/src/check",
                "scoring/src/metrics",
                "scoring/src/score",
                "../solver/formats/src",
            ],
        ),
        ("UNSHADE_READER_SOURCES", vec!["../solver/formats/src"]),
    ] {
        let mut hasher = DefaultHasher::new();
        for folder in folders {
            let folder = here.join(folder);
            println!("cargo::rerun-if-changed={}", folder.display());
            hash_folder(&folder, &mut hasher);
        }
        println!("cargo::rustc-env={name}={:016x}", hasher.finish());
    }
}

fn hash_folder(folder: &Path, hasher: &mut DefaultHasher) {
    let mut paths: Vec<_> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            hash_folder(&path, hasher);
        } else {
            path.file_name().hash(hasher);
            fs::read(&path).unwrap_or_default().hash(hasher);
        }
    }
}
