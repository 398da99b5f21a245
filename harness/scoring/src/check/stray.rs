//! Files that look like maps under names that no program reads.

use std::fs;
use std::path::Path;

use super::finding::Finding;
use super::folder::{
    COVERAGE, DIFFUSE_ALBEDO, DIFFUSE_NORMAL, ROUGHNESS, SPECULAR_ALBEDO, SPECULAR_NORMAL,
};

/// The endings of pictures.
const PICTURES: [&str; 10] =
    ["exr", "png", "jpg", "jpeg", "tif", "tiff", "hdr", "tga", "bmp", "npy"];

/// Words of other names, without their separators, and the map that each most likely is; the first
/// that fits counts. `normal` alone is the one that shines: what most pipelines write.
const NAMES: [(&[&str], &str); 6] = [
    (&["diffusenormal", "diffusenormals", "normaldiffuse", "normalsdiffuse"], DIFFUSE_NORMAL),
    (
        &[
            "specularnormal",
            "specularnormals",
            "normalspecular",
            "normalsspecular",
            "normal",
            "normals",
            "normalmap",
            "nrm",
        ],
        SPECULAR_NORMAL,
    ),
    (
        &[
            "specularalbedo",
            "albedospecular",
            "specular",
            "spec",
            "speculars",
            "specularmap",
            "specularintensity",
            "f0",
        ],
        SPECULAR_ALBEDO,
    ),
    (
        &[
            "diffusealbedo",
            "albedodiffuse",
            "diffuse",
            "albedo",
            "basecolor",
            "basecolour",
            "color",
            "colour",
            "diff",
            "texture",
            "albedomap",
            "diffusemap",
        ],
        DIFFUSE_ALBEDO,
    ),
    (&["roughness", "rough", "alpha", "roughnessmap"], ROUGHNESS),
    (&["coverage", "mask", "valid", "validity", "coveragemask"], COVERAGE),
];

/// One finding for each map that is absent while a file with another name looks like it.
pub(super) fn stray_files(folder: &Path, findings: &mut Vec<Finding>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut files: Vec<String> = entries
        .flatten()
        .filter(|entry| entry.path().is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    files.sort();
    for file in &files {
        let Some(map) = looks_like(file) else { continue };
        // A preview beside its map is harmless.
        if files.iter().any(|other| other == map) {
            continue;
        }
        let message = format!("looks like {map}, under a name that is not read");
        let ending = |name: &str| name.rsplit_once('.').map(|(_, end)| end.to_ascii_lowercase());
        let fix = match (ending(file), ending(map)) {
            (Some(from), Some(to)) if from == to => format!("rename it to {map}"),
            (_, Some(to)) if to == "png" => format!("write it as 8-bit grey PNG named {map}"),
            _ => format!("write it as linear float EXR named {map}"),
        };
        findings.push(Finding::warning("stray-file", file, message, &fix));
    }
}

/// The map that a file is by its name; none if its name is right or says nothing.
fn looks_like(file: &str) -> Option<&'static str> {
    let (stem, ending) = file.rsplit_once('.')?;
    if !PICTURES.contains(&ending.to_ascii_lowercase().as_str()) {
        return None;
    }
    let words: Vec<String> = stem
        .split(|c: char| !c.is_ascii_alphanumeric())
        .map(str::to_ascii_lowercase)
        .filter(|word| !word.is_empty())
        .collect();
    // All of the name, or its last words: scan_01_Diffuse_Albedo.exr.
    let fits = |name: &&&str| (0..words.len()).any(|first| words[first..].concat() == ***name);
    NAMES
        .iter()
        .filter_map(|(names, map)| {
            let longest = names.iter().filter(|name| fits(name)).map(|name| name.len()).max()?;
            Some((longest, *map))
        })
        // The longest name says most: diffuse_normal is a normal, not something diffuse.
        .max_by_key(|(length, _)| *length)
        .map(|(_, map)| map)
        .filter(|map| *map != file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_other_pipelines_are_recognised() {
        for (file, map) in [
            ("albedo.png", Some(DIFFUSE_ALBEDO)),
            ("diffuse.exr", Some(DIFFUSE_ALBEDO)),
            ("Diffuse_Albedo.exr", Some(DIFFUSE_ALBEDO)),
            ("diffuse-albedo.EXR", Some(DIFFUSE_ALBEDO)),
            ("scan01_basecolor.tif", Some(DIFFUSE_ALBEDO)),
            ("normal.png", Some(SPECULAR_NORMAL)),
            ("specular_normals.exr", Some(SPECULAR_NORMAL)),
            ("diffuse_normals.exr", Some(DIFFUSE_NORMAL)),
            ("specular.exr", Some(SPECULAR_ALBEDO)),
            ("Roughness.exr", Some(ROUGHNESS)),
            ("mask.png", Some(COVERAGE)),
            ("diffuse_albedo.exr", None),
            ("confidence.exr", None),
            ("light.exr", None),
            ("timing.json", None),
            ("preview.png", None),
        ] {
            assert_eq!(looks_like(file), map, "{file}");
        }
    }
}
