//! Parts of the truth that a privileged solve holds fixed, to study which part causes which error.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use formats::picture::{self, Picture};

use crate::error::CaptureError;
use crate::view::View;

/// A part of the truth that a solve can hold fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TruthPart {
    /// The light and its distance.
    Light,
    /// The specular albedo.
    Specular,
    /// The roughness of the specular lobes.
    Roughness,
    /// The specular and diffuse normals.
    Normals,
    /// The specular layer of every training view.
    Highlights,
    /// The diffuse layer of every training view over the true albedo.
    Shading,
}

impl TruthPart {
    const ALL: [(Self, &str); 6] = [
        (Self::Light, "light"),
        (Self::Specular, "specular"),
        (Self::Roughness, "roughness"),
        (Self::Normals, "normals"),
        (Self::Highlights, "highlights"),
        (Self::Shading, "shading"),
    ];
}

impl fmt::Display for TruthPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL.iter().find(|(part, _)| part == self).map_or("", |(_, name)| name);
        f.write_str(name)
    }
}

impl FromStr for TruthPart {
    type Err = String;

    /// Parses `light=truth`.
    fn from_str(text: &str) -> Result<Self, String> {
        let part = text.strip_suffix("=truth");
        let known = part.and_then(|part| Self::ALL.iter().find(|(_, name)| *name == part));
        known.map(|(part, _)| *part).ok_or_else(|| {
            let names: Vec<String> =
                Self::ALL.iter().map(|(_, name)| format!("{name}=truth")).collect();
            format!("cannot give `{text}`; use {}", names.join(", "))
        })
    }
}

/// The parts of the truth that are held fixed; texture-space pictures have the size of the true maps.
#[derive(Clone, Debug, Default)]
pub struct Truth {
    /// The parts, in the order of [`TruthPart`].
    pub parts: Vec<TruthPart>,
    /// The light.
    pub light: Option<TrueLight>,
    /// Reflectance at normal incidence, one channel.
    pub specular: Option<Picture>,
    /// The GGX alpha of the first lobe, one channel.
    pub roughness: Option<Picture>,
    /// Specular and diffuse normals, unit vectors in object space.
    pub normals: Option<[Picture; 2]>,
    /// The specular layer of every training view, radiance.
    pub highlights: Option<Vec<Picture>>,
    /// The diffuse layer of every training view, radiance, and the diffuse albedo by which it is divided.
    pub shading: Option<(Vec<Picture>, Picture)>,
}

/// The true light.
#[derive(Clone, Debug)]
pub struct TrueLight {
    /// Radiance by direction from the head's centre, lat-long with the first and last row on the poles, of every group
    /// of frames, in the frame of reference in which the lights stand still.
    pub pictures: Vec<Picture>,
    /// Mean distance of the lamps from the head's centre, metres; none at infinity.
    pub distance: Option<f32>,
}

impl Truth {
    /// Reads parts from the truth's `folder` of a capture with these training views and `groups` of frames with a light
    /// each.
    pub(crate) fn read(
        folder: &Path,
        train: &[View],
        groups: &[String],
        parts: &[TruthPart],
    ) -> Result<Self, CaptureError> {
        if !parts.is_empty() && !folder.is_dir() {
            let reason = "there is no truth to give; render the capture with `unshade synth`";
            return Err(CaptureError::Truth { path: folder.to_owned(), reason: reason.to_owned() });
        }
        let mut truth = Truth { parts: parts.to_vec(), ..Truth::default() };
        truth.parts.sort_unstable();
        truth.parts.dedup();
        let rgb = ["R", "G", "B"];
        let map = |name: &str, channels: &[&str]| picture::read_exr(&folder.join(name), channels);
        let layers = |layer: &str| -> Result<Vec<Picture>, CaptureError> {
            let channels = rgb.map(|channel| format!("{layer}.{channel}"));
            let channels = channels.each_ref().map(String::as_str);
            let of_view = |view: &View| {
                let file = format!("layers/{}.exr", view.camera.name);
                let layer = map(&file, &channels)?;
                let size = [view.camera.width, view.camera.height];
                if [layer.width, layer.height] != size {
                    let reason =
                        format!("its size is not the {} x {} of its view", size[0], size[1]);
                    return Err(CaptureError::Truth { path: folder.join(file), reason });
                }
                Ok(layer)
            };
            train.iter().map(of_view).collect()
        };
        for part in &truth.parts {
            match part {
                TruthPart::Light => {
                    let file = |group: &String| format!("light/{group}.exr");
                    let files = match groups {
                        [] | [_] => vec!["light.exr".to_owned()],
                        _ => groups.iter().map(file).collect(),
                    };
                    let pictures = files.iter().map(|file| map(file, &rgb));
                    let pictures = pictures.collect::<Result<_, _>>()?;
                    truth.light = Some(TrueLight { pictures, distance: distance(folder)? });
                }
                TruthPart::Specular => truth.specular = Some(map("specular_albedo.exr", &["Y"])?),
                TruthPart::Roughness => truth.roughness = Some(map("roughness.exr", &["alpha1"])?),
                TruthPart::Normals => {
                    let [specular, diffuse] =
                        ["specular_normal.exr", "diffuse_normal.exr"].map(|name| map(name, &rgb));
                    truth.normals = Some([specular?, diffuse?]);
                }
                TruthPart::Highlights => truth.highlights = Some(layers("specular")?),
                TruthPart::Shading => {
                    truth.shading = Some((layers("diffuse")?, map("diffuse_albedo.exr", &rgb)?));
                }
            }
        }
        Ok(truth)
    }
}

/// Distances of the lamps of the kinds of lights that have one, metres; the renderer's studio and flash state none.
const STUDIO: f32 = 1.5;
const FLASH: f32 = 1.3;

/// The distance of the lamps by the `[light]` of `scene.toml`, or the smallest of several lights; none for a light at
/// infinity.
fn distance(folder: &Path) -> Result<Option<f32>, CaptureError> {
    let path = folder.join("scene.toml");
    let fault = |reason: String| CaptureError::Truth { path: path.clone(), reason };
    let text = std::fs::read_to_string(&path).map_err(|error| fault(error.to_string()))?;
    let scene: toml::Table = text.parse().map_err(|error: toml::de::Error| {
        fault(error.to_string().lines().collect::<Vec<_>>().join(" "))
    })?;
    let Some(light) = scene.get("light").and_then(toml::Value::as_table) else {
        return Err(fault("has no [light]; render the capture again with `unshade synth`".into()));
    };
    let several = light.get("lights").and_then(toml::Value::as_array).into_iter().flatten();
    let lights = several.filter_map(toml::Value::as_table).chain([light]);
    Ok(lights.filter_map(distance_of).reduce(f32::min))
}

/// The distance of the lamps of a light's table.
fn distance_of(light: &toml::Table) -> Option<f32> {
    let stated = light.get("distance_metres").and_then(|value| {
        value.as_float().or_else(|| value.as_integer().map(|metres| metres as f64))
    });
    let by_kind = match light.get("kind").and_then(toml::Value::as_str) {
        Some("studio") => Some(STUDIO),
        Some("flash") => Some(FLASH),
        _ => None,
    };
    stated.map(|metres| metres as f32).or(by_kind)
}
