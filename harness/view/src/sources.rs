//! The maps of the truth and of the methods, as files have them.

use std::fs;
use std::path::{Path, PathBuf};

use formats::Maps;
use formats::maps::{MapsError, read_deviation};
use formats::picture::{self, GrayImage, Picture};

use crate::error::ViewError;

/// A folder of maps, and its name in the page.
#[derive(Clone, Debug)]
pub struct MethodMaps {
    /// The name that readers see.
    pub title: String,
    /// The maps' folder.
    pub folder: PathBuf,
}

impl MethodMaps {
    /// Maps that are called as their folder is.
    pub fn named_by_folder(folder: PathBuf) -> Self {
        let title = std::path::absolute(&folder)
            .ok()
            .and_then(|path| path.file_name().map(|name| name.to_string_lossy().into_owned()));
        Self { title: title.unwrap_or_else(|| "maps".to_owned()), folder }
    }
}

/// Maps with their standard deviations and the light.
pub(crate) struct Source {
    pub maps: Maps,
    /// By the name of the map.
    pub deviations: Vec<(&'static str, Picture)>,
    pub light: Option<Picture>,
}

/// Maps that may have a standard deviation, with the channels of its file.
const DEVIATIONS: [(&str, &[&str]); 4] = [
    ("diffuse_albedo", &["R", "G", "B"]),
    ("specular_albedo", &["Y"]),
    ("diffuse_normal", &["Y"]),
    ("specular_normal", &["Y"]),
];

impl Source {
    /// Reads the folder of a method or of a truth.
    pub fn read(folder: &Path) -> Result<Self, ViewError> {
        let maps = Maps::read(folder)?;
        if maps.diffuse_albedo.is_none() {
            return Err(ViewError::NoAlbedo(folder.to_path_buf()));
        }
        let mut deviations = Vec::new();
        for (map, channels) in DEVIATIONS {
            if let Some(mut found) = read_deviation(folder, map, channels)? {
                found.blacken_not_finite(|_| true);
                deviations.push((map, found));
            }
        }
        let light = folder.join("light.exr");
        let light = light.is_file().then(|| picture::read_light(&light)).transpose()?;
        Ok(Self { maps, deviations, light })
    }

    /// The truth's coverage, or that of a method; all texels without one.
    pub fn coverage(&self) -> Option<GrayImage> {
        let albedo = self.maps.diffuse_albedo.as_ref()?;
        let whole = || GrayImage {
            width: albedo.width,
            height: albedo.height,
            data: vec![255; albedo.width * albedo.height],
        };
        Some(self.maps.coverage.clone().unwrap_or_else(whole))
    }
}

/// The lights, by name, in which the truth is relit beside its own.
pub(crate) fn other_lights(truth: &Path) -> Result<Vec<(String, Picture)>, ViewError> {
    let folder = truth.join("relit_lights");
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let unreadable = |reason| ViewError::Read { path: folder.clone(), reason };
    let entries = fs::read_dir(&folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut paths: Vec<PathBuf> =
        entries.map_err(unreadable)?.into_iter().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "exr"));
    paths.sort();
    let named = |path: PathBuf| {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Ok((name.unwrap_or_default(), picture::read_light(&path)?))
    };
    paths.into_iter().map(named).collect()
}

/// The label of each texel, where the truth states it.
pub(crate) fn labels(truth: &Path) -> Result<Option<GrayImage>, MapsError> {
    let path = truth.join("labels.png");
    Ok(path.is_file().then(|| picture::read_png_gray(&path)).transpose()?)
}
