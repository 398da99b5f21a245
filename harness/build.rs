//! Hashes the code that results come from: without comments, documentation and tests, and with the versions of what it
//! uses. A finished stage of a run stays valid until the code that made it changes.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::{env, fs};

use syn::visit_mut::{self, VisitMut};

const READERS: &[(&str, &[&str])] = &[("../solver/formats", &["src"])];
const CAPTURE: &[(&str, &[&str])] = &[("../solver/capture", &["src"])];
const SOLVER: &[(&str, &[&str])] = &[("../solver", &["src"])];
const SCORES: &[(&str, &[&str])] = &[("scoring", &["src/check", "src/metrics", "src/score"])];

fn main() {
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let versions = fs::read_to_string(here.join("../Cargo.toml")).unwrap_or_default();
    println!("cargo::rerun-if-changed=../Cargo.toml");
    println!("cargo::rerun-if-changed=build.rs");
    for (name, crates) in [
        ("READER", vec![READERS]),
        ("CAPTURE", vec![READERS, CAPTURE]),
        ("SOLVER", vec![READERS, CAPTURE, SOLVER]),
        ("SCORE", vec![READERS, CAPTURE, SCORES]),
    ] {
        let mut hasher = DefaultHasher::new();
        for (krate, folders) in crates.into_iter().flatten() {
            let manifest = here.join(krate).join("Cargo.toml");
            println!("cargo::rerun-if-changed={}", manifest.display());
            pins(&fs::read_to_string(manifest).unwrap_or_default(), &versions).hash(&mut hasher);
            for folder in folders.iter().map(|folder| here.join(krate).join(folder)) {
                println!("cargo::rerun-if-changed={}", folder.display());
                hash_folder(&folder, &mut hasher);
            }
        }
        println!("cargo::rustc-env=UNSHADE_{name}_SOURCES={:016x}", hasher.finish());
    }
}

/// The workspace's lines on what a crate depends on, without what its tests use.
fn pins<'a>(manifest: &str, workspace: &'a str) -> Vec<&'a str> {
    let lines = manifest.lines().skip_while(|line| *line != "[dependencies]").skip(1);
    let name = |line: &str| line.split(['.', ' ', '=']).next().map(str::to_owned);
    let names: Vec<_> = lines.take_while(|line| !line.starts_with('[')).filter_map(name).collect();
    workspace.lines().filter(|line| name(line).is_some_and(|name| names.contains(&name))).collect()
}

fn hash_folder(folder: &Path, hasher: &mut DefaultHasher) {
    let mut paths: Vec<_> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths.iter().filter(|path| path.file_stem().is_none_or(|stem| stem != "tests")) {
        if path.is_dir() {
            hash_folder(path, hasher);
            continue;
        }
        path.file_name().hash(hasher);
        let bytes = fs::read(path).unwrap_or_default();
        match syn::parse_file(&String::from_utf8_lossy(&bytes)) {
            Ok(mut code) if path.extension().is_some_and(|extension| extension == "rs") => {
                Bare.visit_file_mut(&mut code);
                code.hash(hasher);
            }
            _ => bytes.hash(hasher),
        }
    }
}

/// Takes documentation and tests out of code.
struct Bare;

impl VisitMut for Bare {
    fn visit_attributes_mut(&mut self, attributes: &mut Vec<syn::Attribute>) {
        attributes.retain(|attribute| !attribute.path().is_ident("doc"));
    }

    fn visit_file_mut(&mut self, file: &mut syn::File) {
        file.items.retain(|item| !is_test(item));
        visit_mut::visit_file_mut(self, file);
    }
}

/// Whether an item is a module of tests.
fn is_test(item: &syn::Item) -> bool {
    let syn::Item::Mod(module) = item else { return false };
    module.attrs.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test"))
    })
}
